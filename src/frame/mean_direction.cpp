#include "frame/mean_direction.h"

#include "frame/passes.h"
#include "shaders/frame/mean_direction.comp.h"

namespace nephroid {

MeanDirection::MeanDirection(gpu::Device& device)
    : pipeline_(device, {.shader = shaders::mean_direction_comp, .bindings = {{0, VK_DESCRIPTOR_TYPE_STORAGE_IMAGE}}},
                "mean direction") {}

void MeanDirection::record(gpu::CommandRecorder& recorder, const gpu::Image& direction) {
  recorder.pass("mean direction", {gpu::Use(direction, gpu::Access::kComputeWrite)}, [&](gpu::PassCommands& commands) {
    commands.bind(pipeline_);
    commands.bindResources({gpu::Bound(0, direction)});
    commands.dispatch(gpu::groupsOf(direction.desc().width, kPixelGroup),
                      gpu::groupsOf(direction.desc().height, kPixelGroup));
  });
}

}  // namespace nephroid
