#include "frame/direct_irradiance.h"

#include "frame/passes.h"
#include "shaders/frame/direct_irradiance.comp.h"

namespace nephroid {
namespace {

constexpr std::uint32_t kPixelBindings = SceneBuffers::kBindings + LightGrids::kBindings;
constexpr std::uint32_t kTargetBindings = kPixelBindings + PixelSurfaces::kBindings;

struct DirectPush {
  std::uint32_t light_count;
  float weight;
};

std::vector<gpu::Binding> describeBindings() {
  std::vector<gpu::Binding> bindings = SceneBuffers::bindings({kTexels, kTexels, kTexels, kTable});
  std::vector<VkDescriptorType> types = PixelSurfaces::descriptorTypes();
  types.insert(types.end(), {kStorage, kStorage});
  for (const VkDescriptorType type : types) bindings.push_back({static_cast<std::uint32_t>(bindings.size()), type});
  return bindings;
}

std::vector<gpu::Constant> describeConstants(const SceneBuffers& buffers, bool foreign) {
  std::vector<gpu::Constant> constants = buffers.traits().constants();
  constants.push_back(PixelSurfaces::constant(foreign));
  return constants;
}

}  // namespace

DirectIrradiance::DirectIrradiance(gpu::Device& device, const SceneBuffers& buffers, const LightGrids& lights,
                                   bool foreign)
    : buffers_(buffers),
      lights_(lights),
      pipeline_(device,
                {.shader = shaders::direct_irradiance_comp,
                 .bindings = describeBindings(),
                 .push_bytes = sizeof(DirectPush),
                 .constants = describeConstants(buffers, foreign)},
                "direct irradiance") {}

void DirectIrradiance::record(gpu::CommandRecorder& recorder, const RealtimeSample& sample) {
  const gpu::Image &irradiance = sample.target.irradiance, &direction = sample.target.direction;
  std::vector<Use> uses = buffers_.uses(
      Access::kComputeRead, {Use(irradiance, Access::kComputeWrite), Use(direction, Access::kComputeWrite)});
  const std::vector<Use> grids = lights_.uses();
  uses.insert(uses.end(), grids.begin(), grids.end());
  sample.surfaces.appendUses(uses);
  recorder.pass("direct irradiance", uses, [&](PassCommands& commands) {
    commands.bind(pipeline_);
    std::vector<Bound> bound =
        buffers_.bound({Bound(kTargetBindings, irradiance), Bound(kTargetBindings + 1, direction)});
    const std::vector<Bound> of_lights = lights_.bound(SceneBuffers::kBindings);
    bound.insert(bound.end(), of_lights.begin(), of_lights.end());
    sample.surfaces.appendBound(kPixelBindings, bound);
    commands.bindResources(bound);
    commands.pushConstants(DirectPush{lights_.lightCount(), sample.weight});
    commands.dispatch(gpu::groupsOf(irradiance.desc().width, kPixelGroup),
                      gpu::groupsOf(irradiance.desc().height, kPixelGroup));
  });
}

}  // namespace nephroid
