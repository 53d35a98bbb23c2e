#include "frame/flux_map.h"

#include <algorithm>

#include "frame/passes.h"

namespace nephroid {
namespace {

/// Whole numbers that all of the flux may make, with room for what rounding adds.
constexpr float kMostSteps = 1073741824.0F;

gpu::Image makeImage(gpu::Device& device, VkFormat format, std::uint32_t width, std::uint32_t height,
                     std::uint32_t layers, const char* name) {
  return {device,
          {.format = format,
           .width = width,
           .height = height,
           .layers = layers,
           .usage = VK_IMAGE_USAGE_STORAGE_BIT | VK_IMAGE_USAGE_SAMPLED_BIT,
           .is_array = true},
          name};
}

}  // namespace

FluxMap::FluxMap(gpu::Device& device, std::uint32_t width, std::uint32_t height, std::uint32_t views, bool directions)
    : channels_(directions ? 2 * kFluxChannels : kFluxChannels),
      flux_(makeImage(device, VK_FORMAT_R32_SINT, width, height, views * channels_, "flux")),
      tiles_(makeImage(device, VK_FORMAT_R32_UINT, gpu::groupsOf(width, kDepositTile),
                       gpu::groupsOf(height, kDepositTile), views, "tiles with flux")),
      lost_(device, kFluxChannels * sizeof(std::int32_t), VK_BUFFER_USAGE_STORAGE_BUFFER_BIT,
            gpu::MemoryIntent::kDevice, "flux that is not deposited"),
      levels_(device, width, height, views, channels_) {}

void FluxMap::clear(gpu::CommandRecorder& recorder, float most) {
  quantum_ = std::max(most, 1e-37F) / kMostSteps;
  recorder.pass("clear flux",
                {Use(flux_, Access::kTransferWrite, true), Use(tiles_, Access::kTransferWrite, true),
                 Use(lost_, Access::kTransferWrite)},
                [&](PassCommands& commands) {
                  commands.clear(flux_, {});
                  commands.clear(tiles_, {});
                  commands.fill(lost_, 0);
                });
  levels_.clear(recorder);
}

}  // namespace nephroid
