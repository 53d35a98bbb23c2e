#include "frame/irradiance_images.h"

#include "frame/passes.h"

namespace nephroid {

IrradianceImages makeIrradianceImages(gpu::Device& device, std::uint32_t width, std::uint32_t height) {
  const gpu::ImageDesc desc{.format = kFloat4,
                            .width = width,
                            .height = height,
                            .usage = VK_IMAGE_USAGE_STORAGE_BIT | VK_IMAGE_USAGE_SAMPLED_BIT};
  return {gpu::Image(device, desc, "irradiance"), gpu::Image(device, desc, "direction of irradiance")};
}

void clearIrradiance(gpu::CommandRecorder& recorder, const IrradianceImages& images) {
  recorder.pass(
      "clear irradiance",
      {Use(images.irradiance, Access::kTransferWrite, true), Use(images.direction, Access::kTransferWrite, true)},
      [&](gpu::PassCommands& commands) {
        commands.clear(images.irradiance, {});
        commands.clear(images.direction, {});
      });
}

}  // namespace nephroid
