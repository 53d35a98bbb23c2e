#include "frame/low_pass.h"

#include <cmath>

#include "core/assert.h"
#include "frame/low_pass.shared.h"
#include "frame/passes.h"
#include "shaders/frame/low_pass.comp.h"

namespace nephroid {
namespace {

/// Deviations at which the Gaussian ends: 0.3 % of it lies beyond.
constexpr float kReach = 3.0F;

}  // namespace

LowPass::LowPass(gpu::Device& device, std::uint32_t views, bool directions)
    : device_(device),
      views_(views),
      pipeline_(device,
                {.shader = shaders::low_pass_comp,
                 .bindings = {{0, kUniforms}, {1, kStorage}, {2, kStorage}, {3, kStorage}, {4, kStorage}},
                 .push_bytes = sizeof(LowPassPush),
                 .constants = {{0, views}, {1, directions ? 2 * kFluxChannels : kFluxChannels}}},
                "low-pass") {}

void LowPass::record(gpu::CommandRecorder& recorder, const DepositSurfaces& surfaces, float deviation,
                     const FluxMap& map) {
  NEPHROID_ASSERT_GT(deviation, 0.0F);
  const gpu::ImageDesc& desc = map.flux().desc();
  if (!between_.valid() || between_.desc().width != desc.width || between_.desc().height != desc.height)
    between_ = gpu::Image(device_, desc, "flux after half of a low-pass");
  const auto pass = [&](std::uint32_t axis, const gpu::Image& from, const gpu::Image& to) {
    recorder.pass("low-pass", {Use(to, Access::kTransferWrite, true)},
                  [&](PassCommands& commands) { commands.clear(to, {}); });
    const std::vector<Use> uses{Use(surfaces.views, Access::kComputeRead), Use(surfaces.surfaces, Access::kStorageRead),
                                Use(from, Access::kComputeWrite), Use(to, Access::kComputeWrite),
                                Use(map.tiles(), Access::kComputeWrite)};
    recorder.pass("low-pass", uses, [&](PassCommands& commands) {
      commands.bind(pipeline_);
      commands.bindResources(
          {Bound(0, surfaces.views), Bound(1, surfaces.surfaces), Bound(2, from), Bound(3, to), Bound(4, map.tiles())});
      commands.pushConstants(LowPassPush{.width = map.width(),
                                         .height = map.height(),
                                         .layer_count = surfaces.layer_count,
                                         .axis = axis,
                                         .deviation = deviation,
                                         .reach = static_cast<std::int32_t>(std::ceil(kReach * deviation))});
      commands.dispatch(gpu::groupsOf(map.width(), kPixelGroup), gpu::groupsOf(map.height(), kPixelGroup), views_);
    });
  };
  pass(0, map.flux(), between_);
  pass(1, between_, map.flux());
}

}  // namespace nephroid
