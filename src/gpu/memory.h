// Memory of a device, by intent, cut from large blocks.
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <mutex>
#include <string_view>
#include <vector>

#include "gpu/api.h"

namespace nephroid::gpu {

/// Who writes and who reads.
enum class MemoryIntent : std::uint8_t {
  kDevice,    ///< only the device
  kUpload,    ///< the host writes, in order
  kReadback,  ///< the device writes, the host reads
};

class MemoryAllocator;

/// A piece of a block; gives itself back. Move-only.
class Allocation {
 public:
  Allocation() = default;
  Allocation(Allocation&& other) noexcept { swap(other); }
  Allocation& operator=(Allocation&& other) noexcept {
    swap(other);
    return *this;
  }
  ~Allocation();

  VkDeviceMemory memory() const { return memory_; }
  VkDeviceSize offset() const { return offset_; }
  /// Where the host sees it; null for kDevice.
  std::byte* mapped() const { return mapped_; }

 private:
  friend class MemoryAllocator;
  void swap(Allocation& other) noexcept;

  MemoryAllocator* allocator_ = nullptr;
  std::size_t block_ = 0;
  VkDeviceMemory memory_ = VK_NULL_HANDLE;
  VkDeviceSize offset_ = 0, size_ = 0;
  std::byte* mapped_ = nullptr;
};

/// Thread-safe. Outlives its allocations.
class MemoryAllocator {
 public:
  /// Size of a block; what is larger gets one of its own.
  static constexpr VkDeviceSize kBlockBytes = VkDeviceSize{64} << 20;

  MemoryAllocator(const InstanceApi& instance, VkPhysicalDevice physical, const DeviceApi& api, VkDevice device);
  ~MemoryAllocator();
  MemoryAllocator(const MemoryAllocator&) = delete;
  MemoryAllocator& operator=(const MemoryAllocator&) = delete;

  /// @param linear  buffers and linear images; others live in blocks of their own kind (bufferImageGranularity)
  /// @param what    for the message
  /// @throws ResourceError
  Allocation allocate(const VkMemoryRequirements& requirements, MemoryIntent intent, bool linear,
                      std::string_view what);

  VkDeviceSize usedBytes() const;
  VkDeviceSize peakBytes() const;

 private:
  friend class Allocation;
  struct Range {
    VkDeviceSize begin, end;
  };
  struct Block {
    VkDeviceMemory memory = VK_NULL_HANDLE;
    VkDeviceSize size = 0;
    std::uint32_t type = 0;
    MemoryIntent intent = MemoryIntent::kDevice;  ///< on some devices all share a type, but not all are mapped
    bool linear = true;
    std::byte* mapped = nullptr;
    std::vector<Range> free;  ///< ascending, apart
  };
  std::uint32_t findType(std::uint32_t allowed, MemoryIntent intent) const;
  std::size_t addBlock(VkDeviceSize size, std::uint32_t type, MemoryIntent intent, bool linear, std::string_view what);
  bool carve(Block& block, const VkMemoryRequirements& requirements, VkDeviceSize& offset);
  void release(std::size_t block, VkDeviceSize offset, VkDeviceSize size);

  const DeviceApi& api_;
  VkDevice device_;
  VkPhysicalDeviceMemoryProperties properties_{};
  mutable std::mutex guard_;
  std::vector<Block> blocks_;
  VkDeviceSize used_ = 0, peak_ = 0;
};

}  // namespace nephroid::gpu
