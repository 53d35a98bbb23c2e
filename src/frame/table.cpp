#include "frame/table.h"

#include <algorithm>
#include <array>

namespace nephroid {
namespace {

/// Bytes of the largest texel: what is bound has a size.
constexpr std::array<std::byte, 16> kNothing{};

}  // namespace

gpu::Buffer makeTexelTable(gpu::Device& device, gpu::CommandRecorder& recorder, VkFormat format,
                           std::span<const std::byte> texels, std::string_view name) {
  if (texels.empty()) texels = std::span(kNothing).first(gpu::texelBytes(format));
  gpu::Buffer table(device, texels.size(), VK_BUFFER_USAGE_UNIFORM_TEXEL_BUFFER_BIT, gpu::MemoryIntent::kDevice, name,
                    format);
  recorder.upload(table, texels);
  return table;
}

gpu::Buffer makeWrittenTable(gpu::Device& device, std::uint64_t texels, std::string_view name) {
  return {device, std::max<std::uint64_t>(texels, 1) * kNothing.size(),
          VK_BUFFER_USAGE_UNIFORM_TEXEL_BUFFER_BIT | VK_BUFFER_USAGE_STORAGE_TEXEL_BUFFER_BIT,
          gpu::MemoryIntent::kDevice, name};
}

}  // namespace nephroid
