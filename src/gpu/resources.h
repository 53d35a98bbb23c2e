// Buffers, images and samplers: memory included, named, destroyed when no frame uses them any more.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "gpu/device.h"

namespace nephroid::gpu {

/// What was last done to a resource: what the next barrier waits for. Kept with the resource, because there is one
/// queue and commands are recorded in the order in which they run.
struct ResourceState {
  VkPipelineStageFlags2 write_stages = 0;
  VkAccessFlags2 write_access = 0;
  VkPipelineStageFlags2 read_stages = 0;  ///< since the last write
  VkAccessFlags2 read_access = 0;
  VkImageLayout layout = VK_IMAGE_LAYOUT_UNDEFINED;
};

/// Move-only.
class Buffer {
 public:
  Buffer() = default;
  /// @param size   bytes, > 0
  /// @param usage   VK_BUFFER_USAGE_…; transfers both ways are always allowed. Shaders fetch uniform texel buffers
  ///                texel by texel, which some devices do many times as fast as word by word
  /// @param name    for messages and captures
  /// @param texels  of texel buffers
  /// @throws ResourceError
  Buffer(Device& device, VkDeviceSize size, VkBufferUsageFlags usage, MemoryIntent intent, std::string_view name,
         VkFormat texels = VK_FORMAT_R32G32B32A32_UINT);
  Buffer(Buffer&& other) noexcept { swap(other); }
  Buffer& operator=(Buffer&& other) noexcept {
    swap(other);
    return *this;
  }
  ~Buffer();

  bool valid() const { return handle_ != VK_NULL_HANDLE; }
  VkBuffer handle() const { return handle_; }
  VkDeviceSize size() const { return size_; }
  /// Of all of it as texels; null unless its usage says so.
  const VkBufferView& texelView() const { return texel_view_; }
  /// What the host sees; empty for MemoryIntent::kDevice.
  std::span<std::byte> mapped() const {
    return {allocation_.mapped(), allocation_.mapped() ? static_cast<std::size_t>(size_) : 0};
  }
  ResourceState& state() const { return state_; }

 private:
  void swap(Buffer& other) noexcept;
  void makeTexelView(VkFormat format, std::string_view name);

  Device* device_ = nullptr;
  VkBuffer handle_ = VK_NULL_HANDLE;
  VkBufferView texel_view_ = VK_NULL_HANDLE;
  VkDeviceSize size_ = 0;
  Allocation allocation_;
  mutable ResourceState state_;
};

struct ImageDesc {
  VkFormat format = VK_FORMAT_UNDEFINED;
  std::uint32_t width = 1, height = 1;
  std::uint32_t layers = 1, mips = 1;
  VkImageUsageFlags usage = 0;  ///< transfers both ways are always allowed
  bool is_cube = false;         ///< `layers` is 6; sampled as a cube
  bool is_array = false;        ///< sampled as an array even with one layer
};

/// Two-dimensional, with one view of all of it. Move-only.
class Image {
 public:
  Image() = default;
  /// @throws ResourceError
  Image(Device& device, const ImageDesc& desc, std::string_view name);
  /// Somebody else's image, which he destroys when the device is done with it; views of it are ours.
  /// @param desc    as it was created; of several layers and mips the first of each
  /// @param layout  that it is in when the next commands run
  /// @throws ResourceError
  Image(Device& device, VkImage foreign, const ImageDesc& desc, VkImageLayout layout);
  Image(Image&& other) noexcept { swap(other); }
  Image& operator=(Image&& other) noexcept {
    swap(other);
    return *this;
  }
  ~Image();

  bool valid() const { return handle_ != VK_NULL_HANDLE; }
  VkImage handle() const { return handle_; }
  const ImageDesc& desc() const { return desc_; }
  VkExtent2D extent() const { return {desc_.width, desc_.height}; }
  /// What is read and written of it: colour, or depth.
  VkImageAspectFlags aspect() const { return aspect_; }
  /// What changes its layout together.
  VkImageAspectFlags allAspects() const;
  /// Of all layers and mips; for sampling.
  VkImageView view() const { return view_; }
  /// Of the first mip, as an array of all layers; for storage.
  VkImageView targetView() const { return target_view_; }
  /// Of one layer of the first mip; for rendering to.
  VkImageView layerView(std::uint32_t layer) const { return layer_views_.empty() ? target_view_ : layer_views_[layer]; }
  ResourceState& state() const { return state_; }

 private:
  void swap(Image& other) noexcept;
  VkImageView makeView(VkImageViewType type, std::uint32_t mips, std::uint32_t first_layer, std::uint32_t layers) const;
  void makeViews();
  void destroyNow();

  Device* device_ = nullptr;
  VkImage handle_ = VK_NULL_HANDLE;
  bool owned_ = true;
  VkImageView view_ = VK_NULL_HANDLE, target_view_ = VK_NULL_HANDLE;
  std::vector<VkImageView> layer_views_;  ///< where there are several layers
  VkImageAspectFlags aspect_ = 0;
  ImageDesc desc_;
  Allocation allocation_;
  mutable ResourceState state_;
};

struct SamplerDesc {
  VkFilter filter = VK_FILTER_LINEAR;
  VkSamplerAddressMode address_u = VK_SAMPLER_ADDRESS_MODE_CLAMP_TO_EDGE;
  VkSamplerAddressMode address_v = VK_SAMPLER_ADDRESS_MODE_CLAMP_TO_EDGE;
  bool operator==(const SamplerDesc&) const = default;
};

/// Move-only.
class Sampler {
 public:
  Sampler() = default;
  Sampler(Device& device, const SamplerDesc& desc, std::string_view name);
  Sampler(Sampler&& other) noexcept { swap(other); }
  Sampler& operator=(Sampler&& other) noexcept {
    swap(other);
    return *this;
  }
  ~Sampler();
  VkSampler handle() const { return handle_; }

 private:
  void swap(Sampler& other) noexcept;
  Device* device_ = nullptr;
  VkSampler handle_ = VK_NULL_HANDLE;
};

/// Bytes of one texel of an uncompressed format that we use. @throws InternalError for others
std::uint32_t texelBytes(VkFormat format);

}  // namespace nephroid::gpu
