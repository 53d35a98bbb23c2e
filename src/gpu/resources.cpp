#include "gpu/resources.h"

#include <fmt/format.h>

#include <memory>
#include <utility>

#include "nephroid/error.h"

namespace nephroid::gpu {
namespace {

bool hasStencil(VkFormat format) {
  return format == VK_FORMAT_D16_UNORM_S8_UINT || format == VK_FORMAT_D24_UNORM_S8_UINT ||
         format == VK_FORMAT_D32_SFLOAT_S8_UINT;
}

bool isDepth(VkFormat format) {
  return format == VK_FORMAT_D32_SFLOAT || format == VK_FORMAT_D16_UNORM || format == VK_FORMAT_X8_D24_UNORM_PACK32 ||
         hasStencil(format);
}

/// For a handle of any kind; on 64-bit systems they are pointers.
template <class Handle>
std::uint64_t bitsOf(Handle handle) {
  return reinterpret_cast<std::uint64_t>(handle);
}

/// std::function wants copyable captures.
std::shared_ptr<Allocation> share(Allocation&& allocation) {
  return std::make_shared<Allocation>(std::move(allocation));
}

}  // namespace

std::uint32_t texelBytes(VkFormat format) {
  switch (format) {
    case VK_FORMAT_R8_UNORM:
      return 1;
    case VK_FORMAT_R8G8_UNORM:
    case VK_FORMAT_R16_SFLOAT:
      return 2;
    case VK_FORMAT_R8G8B8A8_UNORM:
    case VK_FORMAT_R8G8B8A8_SRGB:
    case VK_FORMAT_R32_SFLOAT:
    case VK_FORMAT_R32_UINT:
    case VK_FORMAT_R32_SINT:
    case VK_FORMAT_D32_SFLOAT:
      return 4;
    case VK_FORMAT_R16G16B16A16_UNORM:
    case VK_FORMAT_R16G16B16A16_SFLOAT:
    case VK_FORMAT_R32G32_SFLOAT:
    case VK_FORMAT_R32G32_UINT:
      return 8;
    case VK_FORMAT_R32G32B32A32_SFLOAT:
    case VK_FORMAT_R32G32B32A32_UINT:
      return 16;
    default:
      throw InternalError(
          fmt::format("the size of a texel of Vulkan format {} is not listed", static_cast<int>(format)));
  }
}

namespace {

constexpr VkBufferUsageFlags kTexelUsages =
    VK_BUFFER_USAGE_UNIFORM_TEXEL_BUFFER_BIT | VK_BUFFER_USAGE_STORAGE_TEXEL_BUFFER_BIT;

}  // namespace

Buffer::Buffer(Device& device, VkDeviceSize size, VkBufferUsageFlags usage, MemoryIntent intent, std::string_view name,
               VkFormat texels)
    : device_(&device), size_(size) {
  // What shaders see of a buffer is bounded, by 128 MiB on some devices.
  if ((usage & VK_BUFFER_USAGE_STORAGE_BUFFER_BIT) != 0 && size > device.limits().maxStorageBufferRange)
    throw ResourceError(
        fmt::format("'{}' needs {:.1f} MiB and {} lets a buffer have {:.1f} MiB; use a smaller scene or "
                    "another device",
                    name, static_cast<double>(size) / (1 << 20), device.name(),
                    static_cast<double>(device.limits().maxStorageBufferRange) / (1 << 20)));
  const VkBufferCreateInfo info{.sType = VK_STRUCTURE_TYPE_BUFFER_CREATE_INFO,
                                .size = size,
                                .usage = usage | VK_BUFFER_USAGE_TRANSFER_SRC_BIT | VK_BUFFER_USAGE_TRANSFER_DST_BIT,
                                .sharingMode = VK_SHARING_MODE_EXCLUSIVE};
  const DeviceApi& api = device.api();
  check(api.CreateBuffer(device.handle(), &info, nullptr, &handle_), fmt::format("creating the buffer '{}'", name));
  try {
    VkMemoryRequirements requirements;
    api.GetBufferMemoryRequirements(device.handle(), handle_, &requirements);
    allocation_ = device.memory().allocate(requirements, intent, true, name);
    check(api.BindBufferMemory(device.handle(), handle_, allocation_.memory(), allocation_.offset()),
          fmt::format("binding the buffer '{}'", name));
    device.setName(VK_OBJECT_TYPE_BUFFER, bitsOf(handle_), name);
    if ((usage & kTexelUsages) != 0) makeTexelView(texels, name);
  } catch (...) {
    api.DestroyBuffer(device.handle(), handle_, nullptr);
    throw;
  }
}

void Buffer::makeTexelView(VkFormat format, std::string_view name) {
  const VkDeviceSize texels = size_ / texelBytes(format);
  if (texels > device_->limits().maxTexelBufferElements)
    throw ResourceError(
        fmt::format("'{}' needs {} texels and {} lets a buffer have {}; use a smaller scene or another device", name,
                    texels, device_->name(), device_->limits().maxTexelBufferElements));
  const VkBufferViewCreateInfo info{
      .sType = VK_STRUCTURE_TYPE_BUFFER_VIEW_CREATE_INFO, .buffer = handle_, .format = format, .range = VK_WHOLE_SIZE};
  check(device_->api().CreateBufferView(device_->handle(), &info, nullptr, &texel_view_),
        fmt::format("creating a view of the buffer '{}'", name));
}

Buffer::~Buffer() {
  if (!handle_) return;
  device_->retire([device = device_, handle = handle_, view = texel_view_, memory = share(std::move(allocation_))] {
    if (view) device->api().DestroyBufferView(device->handle(), view, nullptr);
    device->api().DestroyBuffer(device->handle(), handle, nullptr);
  });
}

void Buffer::swap(Buffer& other) noexcept {
  std::swap(device_, other.device_);
  std::swap(handle_, other.handle_);
  std::swap(texel_view_, other.texel_view_);
  std::swap(size_, other.size_);
  std::swap(allocation_, other.allocation_);
  std::swap(state_, other.state_);
}

Image::Image(Device& device, const ImageDesc& desc, std::string_view name)
    : device_(&device),
      aspect_(isDepth(desc.format) ? VK_IMAGE_ASPECT_DEPTH_BIT : VK_IMAGE_ASPECT_COLOR_BIT),
      desc_(desc) {
  const VkImageCreateInfo info{
      .sType = VK_STRUCTURE_TYPE_IMAGE_CREATE_INFO,
      .flags = static_cast<VkImageCreateFlags>(desc.is_cube ? VK_IMAGE_CREATE_CUBE_COMPATIBLE_BIT : 0),
      .imageType = VK_IMAGE_TYPE_2D,
      .format = desc.format,
      .extent = {desc.width, desc.height, 1},
      .mipLevels = desc.mips,
      .arrayLayers = desc.layers,
      .samples = VK_SAMPLE_COUNT_1_BIT,
      .tiling = VK_IMAGE_TILING_OPTIMAL,
      .usage = desc.usage | VK_IMAGE_USAGE_TRANSFER_SRC_BIT | VK_IMAGE_USAGE_TRANSFER_DST_BIT,
      .sharingMode = VK_SHARING_MODE_EXCLUSIVE,
      .initialLayout = VK_IMAGE_LAYOUT_UNDEFINED};
  const DeviceApi& api = device.api();
  check(api.CreateImage(device.handle(), &info, nullptr, &handle_), fmt::format("creating the image '{}'", name));
  try {
    VkMemoryRequirements requirements;
    api.GetImageMemoryRequirements(device.handle(), handle_, &requirements);
    allocation_ = device.memory().allocate(requirements, MemoryIntent::kDevice, false, name);
    check(api.BindImageMemory(device.handle(), handle_, allocation_.memory(), allocation_.offset()),
          fmt::format("binding the image '{}'", name));
    makeViews();
    device.setName(VK_OBJECT_TYPE_IMAGE, bitsOf(handle_), name);
  } catch (...) {
    destroyNow();
    throw;
  }
}

Image::Image(Device& device, VkImage foreign, const ImageDesc& desc, VkImageLayout layout)
    : device_(&device),
      handle_(foreign),
      owned_(false),
      aspect_(isDepth(desc.format) ? VK_IMAGE_ASPECT_DEPTH_BIT : VK_IMAGE_ASPECT_COLOR_BIT),
      desc_(desc) {
  // What was done to it is not known: everything.
  state_ = {.write_stages = VK_PIPELINE_STAGE_2_ALL_COMMANDS_BIT,
            .write_access = VK_ACCESS_2_MEMORY_WRITE_BIT,
            .layout = layout};
  try {
    makeViews();
  } catch (...) {
    destroyNow();
    throw;
  }
}

VkImageAspectFlags Image::allAspects() const {
  return hasStencil(desc_.format) ? aspect_ | VK_IMAGE_ASPECT_STENCIL_BIT : aspect_;
}

void Image::makeViews() {
  // An image that is only copied to may have no views.
  constexpr VkImageUsageFlags kViewed = VK_IMAGE_USAGE_SAMPLED_BIT | VK_IMAGE_USAGE_STORAGE_BIT |
                                        VK_IMAGE_USAGE_COLOR_ATTACHMENT_BIT |
                                        VK_IMAGE_USAGE_DEPTH_STENCIL_ATTACHMENT_BIT;
  if ((desc_.usage & kViewed) == 0) return;
  const bool array = desc_.is_array || desc_.layers > 1;
  const VkImageViewType whole = array ? VK_IMAGE_VIEW_TYPE_2D_ARRAY : VK_IMAGE_VIEW_TYPE_2D;
  view_ = makeView(desc_.is_cube ? VK_IMAGE_VIEW_TYPE_CUBE : whole, desc_.mips, 0, desc_.layers);
  target_view_ = makeView(whole, 1, 0, desc_.layers);
  for (std::uint32_t layer = 0; desc_.layers > 1 && layer < desc_.layers; ++layer)
    layer_views_.push_back(makeView(VK_IMAGE_VIEW_TYPE_2D, 1, layer, 1));
}

VkImageView Image::makeView(VkImageViewType type, std::uint32_t mips, std::uint32_t first_layer,
                            std::uint32_t layers) const {
  const VkImageViewCreateInfo info{.sType = VK_STRUCTURE_TYPE_IMAGE_VIEW_CREATE_INFO,
                                   .image = handle_,
                                   .viewType = type,
                                   .format = desc_.format,
                                   .subresourceRange = {aspect_, 0, mips, first_layer, layers}};
  VkImageView view = VK_NULL_HANDLE;
  check(device_->api().CreateImageView(device_->handle(), &info, nullptr, &view), "creating a view of an image");
  return view;
}

namespace {

/// @param handle  null: only the views
void destroyImage(const Device& device, VkImage handle, std::span<const VkImageView> views) {
  for (const VkImageView view : views)
    if (view) device.api().DestroyImageView(device.handle(), view, nullptr);
  if (handle) device.api().DestroyImage(device.handle(), handle, nullptr);
}

}  // namespace

void Image::destroyNow() {
  layer_views_.insert(layer_views_.end(), {view_, target_view_});
  destroyImage(*device_, owned_ ? handle_ : VK_NULL_HANDLE, layer_views_);
}

Image::~Image() {
  if (!handle_) return;
  std::vector<VkImageView> views = layer_views_;
  views.insert(views.end(), {view_, target_view_});
  const VkImage handle = owned_ ? handle_ : VK_NULL_HANDLE;
  device_->retire([device = device_, handle, views, memory = share(std::move(allocation_))] {
    destroyImage(*device, handle, views);
  });
}

void Image::swap(Image& other) noexcept {
  std::swap(device_, other.device_);
  std::swap(handle_, other.handle_);
  std::swap(owned_, other.owned_);
  std::swap(view_, other.view_);
  std::swap(target_view_, other.target_view_);
  std::swap(layer_views_, other.layer_views_);
  std::swap(aspect_, other.aspect_);
  std::swap(desc_, other.desc_);
  std::swap(allocation_, other.allocation_);
  std::swap(state_, other.state_);
}

Sampler::Sampler(Device& device, const SamplerDesc& desc, std::string_view name) : device_(&device) {
  const VkSamplerCreateInfo info{
      .sType = VK_STRUCTURE_TYPE_SAMPLER_CREATE_INFO,
      .magFilter = desc.filter,
      .minFilter = desc.filter,
      .mipmapMode = desc.filter == VK_FILTER_LINEAR ? VK_SAMPLER_MIPMAP_MODE_LINEAR : VK_SAMPLER_MIPMAP_MODE_NEAREST,
      .addressModeU = desc.address_u,
      .addressModeV = desc.address_v,
      .addressModeW = VK_SAMPLER_ADDRESS_MODE_CLAMP_TO_EDGE,
      .maxLod = VK_LOD_CLAMP_NONE};
  check(device.api().CreateSampler(device.handle(), &info, nullptr, &handle_), fmt::format("creating '{}'", name));
  device.setName(VK_OBJECT_TYPE_SAMPLER, bitsOf(handle_), name);
}

Sampler::~Sampler() {
  if (!handle_) return;
  device_->retire(
      [device = device_, handle = handle_] { device->api().DestroySampler(device->handle(), handle, nullptr); });
}

void Sampler::swap(Sampler& other) noexcept {
  std::swap(device_, other.device_);
  std::swap(handle_, other.handle_);
}

}  // namespace nephroid::gpu
