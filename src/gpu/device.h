// A Vulkan device with one queue for everything: ours, or the caller's own.
#pragma once

#include <cstdint>
#include <deque>
#include <filesystem>
#include <functional>
#include <memory>
#include <string_view>

#include "gpu/device_list.h"
#include "gpu/instance.h"
#include "gpu/memory.h"

namespace nephroid::gpu {

/// A device that somebody else made and destroys after us. It must have the features and extensions of
/// gpu/requirements.h, and its queue must be left alone while we submit.
struct ForeignDevice {
  PFN_vkGetInstanceProcAddr get_instance_proc_addr = nullptr;
  VkInstance instance = VK_NULL_HANDLE;
  VkPhysicalDevice physical = VK_NULL_HANDLE;
  VkDevice device = VK_NULL_HANDLE;
  VkQueue queue = VK_NULL_HANDLE;
  std::uint32_t queue_family = 0;
  bool int64_atomics = false;  ///< whether it was made with them
};

/// Outlives everything made with it. One thread at a time, but for `memory()`.
class Device {
 public:
  /// @throws DeviceError, ResourceError
  Device(const Instance& instance, const DeviceInfo& info);
  explicit Device(const ForeignDevice& foreign);
  ~Device();
  Device(const Device&) = delete;
  Device& operator=(const Device&) = delete;

  const DeviceApi& api() const { return api_; }
  VkDevice handle() const { return handle_; }
  VkQueue queue() const { return queue_; }
  std::uint32_t queueFamily() const { return queue_family_; }
  MemoryAllocator& memory() { return *memory_; }
  VkPipelineCache pipelineCache() const { return pipeline_cache_; }
  const VkPhysicalDeviceLimits& limits() const { return properties_.limits; }
  std::string_view name() const { return properties_.deviceName; }
  /// ms of one tick of a timestamp; 0: there are none.
  double timestampTickMs() const { return timestamp_tick_ms_; }
  /// A software driver: vertices run on one core, compute on all.
  bool isCpu() const { return properties_.deviceType == VK_PHYSICAL_DEVICE_TYPE_CPU; }
  /// What images of that format, tiled as the driver likes, can be used for.
  VkFormatFeatureFlags featuresOf(VkFormat format) const;
  bool hasFloatAtomics() const { return float_atomics_; }
  bool hasInt64Atomics() const { return int64_atomics_; }

  /// Names an object for captures and messages; nothing where nobody listens.
  void setName(VkObjectType type, std::uint64_t handle, std::string_view name) const;
  void beginLabel(VkCommandBuffer commands, const char* name) const;
  void endLabel(VkCommandBuffer commands) const;

  /// Submits; what `retire` is given from now on waits for it. @return its number, for `wait`
  std::uint64_t submit(VkCommandBuffer commands);
  /// Until submission `number` is done. @throws DeviceError if the device is lost
  void wait(std::uint64_t number);
  /// Runs `destroy` once everything that was submitted so far is done.
  void retire(std::function<void()> destroy);

  /// Pipelines compiled before are found again in later runs, if the cache is read before they are made.
  void readPipelineCache(const std::filesystem::path& file);
  /// Failing to write is no error: the cache only saves time.
  void writePipelineCache(const std::filesystem::path& file) const;

 private:
  void finishCreation(const InstanceApi& instance, VkPhysicalDevice physical);
  void create(const DeviceInfo& info);
  void collect();
  void makePipelineCache(const void* data, std::size_t size);
  void destroy();

  InstanceApi instance_api_;
  DeviceApi api_;
  VkPhysicalDevice physical_ = VK_NULL_HANDLE;
  VkDevice handle_ = VK_NULL_HANDLE;
  bool owned_ = true;
  VkQueue queue_ = VK_NULL_HANDLE;
  std::uint32_t queue_family_ = 0;
  VkPhysicalDeviceProperties properties_{};
  double timestamp_tick_ms_ = 0;
  bool float_atomics_ = false, int64_atomics_ = false;
  VkPipelineCache pipeline_cache_ = VK_NULL_HANDLE;
  VkSemaphore timeline_ = VK_NULL_HANDLE;
  std::uint64_t submitted_ = 0;
  std::unique_ptr<MemoryAllocator> memory_;
  struct Retired {
    std::uint64_t after;
    std::function<void()> destroy;
  };
  std::deque<Retired> retired_;
};

}  // namespace nephroid::gpu
