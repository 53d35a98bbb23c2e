#include "frame/table.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstring>
#include <vector>

#include "nephroid/error.h"

namespace nephroid {
namespace {

gpu::ImageDesc describeTable(gpu::Device& device, VkFormat format, std::uint64_t texels, VkImageUsageFlags usage,
                             std::string_view name) {
  constexpr std::uint64_t kRow = 1U << kTableShift;
  const std::uint64_t width = std::clamp<std::uint64_t>(texels, 1, kRow);
  const std::uint64_t height = std::max<std::uint64_t>((texels + kRow - 1) / kRow, 1);
  if (height > device.limits().maxImageDimension2D)
    throw ResourceError(fmt::format("the {} need a table of {} rows, and {} allows {}: use a smaller scene", name,
                                    height, device.name(), device.limits().maxImageDimension2D));
  return {.format = format,
          .width = static_cast<std::uint32_t>(width),
          .height = static_cast<std::uint32_t>(height),
          .usage = usage | VK_IMAGE_USAGE_SAMPLED_BIT};
}

}  // namespace

gpu::Image makeTexelTable(gpu::Device& device, gpu::CommandRecorder& recorder, VkFormat format,
                          std::span<const std::byte> texels, std::string_view name) {
  const std::size_t texel_bytes = gpu::texelBytes(format);
  const gpu::ImageDesc desc = describeTable(device, format, texels.size() / texel_bytes, 0, name);
  gpu::Image table(device, desc, name);
  std::vector<std::byte> rows(texel_bytes * desc.width * desc.height);
  if (!texels.empty()) std::memcpy(rows.data(), texels.data(), texels.size());
  recorder.upload(table, rows);
  return table;
}

gpu::Image makeWrittenTable(gpu::Device& device, std::uint64_t texels, std::string_view name) {
  return {device, describeTable(device, VK_FORMAT_R32G32B32A32_UINT, texels, VK_IMAGE_USAGE_STORAGE_BIT, name), name};
}

}  // namespace nephroid
