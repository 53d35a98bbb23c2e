#include "frame/flux_levels.h"

#include <algorithm>
#include <bit>

#include "frame/passes.h"

namespace nephroid {
namespace {

/// Texels that the longer side of the last level has at least: cells that fill the picture span so many.
constexpr std::uint32_t kLeastTexels = 8;

std::uint32_t countLevels(std::uint32_t width, std::uint32_t height) {
  const std::uint32_t longer = std::max(width, height) / kLeastTexels;
  return longer == 0 ? 0 : std::min(kMostLevels, static_cast<std::uint32_t>(std::bit_width(longer)) - 1);
}

}  // namespace

FluxLevels::FluxLevels(gpu::Device& device, std::uint32_t width, std::uint32_t height, std::uint32_t pictures,
                       std::uint32_t channels)
    : count_(countLevels(width, height)),
      state_(device, sizeof(FluxLevelsState), VK_BUFFER_USAGE_STORAGE_BUFFER_BIT | VK_BUFFER_USAGE_INDIRECT_BUFFER_BIT,
             gpu::MemoryIntent::kDevice, "state of levels of flux") {
  const std::uint32_t last = (1U << count_) - 1;
  const std::uint32_t padded_width = (width + last) & ~last, padded_height = (height + last) & ~last;
  const auto make = [&](VkFormat format, std::uint32_t layers, const char* name) {
    // Something has to be bound where there are none.
    return gpu::Image(device,
                      {.format = format,
                       .width = count_ > 0 ? padded_width / 2 + padded_width / 4 : 1,
                       .height = count_ > 0 ? padded_height / 2 : 1,
                       .layers = layers,
                       .usage = VK_IMAGE_USAGE_STORAGE_BIT | VK_IMAGE_USAGE_SAMPLED_BIT,
                       .is_array = true},
                      name);
  };
  flux_ = make(VK_FORMAT_R32_SINT, pictures * channels, "levels of flux");
  surfaces_ = make(kFloat4, pictures, "surfaces of levels");
  kinds_ = make(VK_FORMAT_R32_UINT, pictures, "kinds of levels");
  links_ = make(VK_FORMAT_R32_UINT, pictures, "links of levels");
}

void FluxLevels::clear(gpu::CommandRecorder& recorder) const {
  recorder.pass("clear levels", {Use(flux_, Access::kTransferWrite, true), Use(state_, Access::kTransferWrite)},
                [&](PassCommands& commands) {
                  commands.clear(flux_, {});
                  commands.fill(state_, 0);
                });
}

}  // namespace nephroid
