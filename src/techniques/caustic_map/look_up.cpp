#include "techniques/caustic_map/look_up.h"

#include "frame/passes.h"
#include "shaders/techniques/look_up.comp.h"

namespace nephroid {
namespace {

constexpr std::uint32_t kPixelBindings = SceneBuffers::kBindings;
constexpr std::uint32_t kMapBindings = kPixelBindings + PixelSurfaces::kBindings;

struct LookUpPush {
  std::uint32_t size, layer_count;
  float watts;
};

std::vector<gpu::Binding> describeBindings() {
  std::vector<gpu::Binding> bindings = SceneBuffers::bindings({});
  std::vector<VkDescriptorType> types = PixelSurfaces::descriptorTypes();
  types.insert(types.end(), {kUniforms, kStorage, kStorage, kStorage, kStorage, kStorage});
  for (const VkDescriptorType type : types) bindings.push_back({static_cast<std::uint32_t>(bindings.size()), type});
  return bindings;
}

std::vector<gpu::Constant> describeConstants(const SceneBuffers& buffers, bool foreign, std::uint32_t views,
                                             bool directions) {
  std::vector<gpu::Constant> constants = buffers.traits().constants();
  constants.push_back(PixelSurfaces::constant(foreign));
  constants.push_back({20, directions});
  constants.push_back({21, views});
  return constants;
}

}  // namespace

LookUp::LookUp(gpu::Device& device, const SceneBuffers& buffers, bool foreign, std::uint32_t views, bool directions)
    : buffers_(buffers),
      pipeline_(device,
                {.shader = shaders::look_up_comp,
                 .bindings = describeBindings(),
                 .push_bytes = sizeof(LookUpPush),
                 .constants = describeConstants(buffers, foreign, views, directions)},
                "look-up") {}

void LookUp::record(gpu::CommandRecorder& recorder, const RealtimeSample& sample, float weight,
                    const DepositSurfaces& surfaces, const FluxMap& map) {
  const gpu::Image &irradiance = sample.target.irradiance, &direction = sample.target.direction;
  std::vector<Use> uses = buffers_.uses(
      Access::kComputeRead, {Use(surfaces.views, Access::kComputeRead), Use(surfaces.surfaces, Access::kStorageRead),
                             Use(map.flux(), Access::kStorageRead), Use(map.tiles(), Access::kStorageRead),
                             Use(irradiance, Access::kComputeWrite), Use(direction, Access::kComputeWrite)});
  sample.surfaces.appendUses(uses);
  recorder.pass("look-up", uses, [&](PassCommands& commands) {
    commands.bind(pipeline_);
    std::vector<Bound> bound =
        buffers_.bound({Bound(kMapBindings, surfaces.views), Bound(kMapBindings + 1, surfaces.surfaces),
                        Bound(kMapBindings + 2, map.flux()), Bound(kMapBindings + 3, map.tiles()),
                        Bound(kMapBindings + 4, irradiance), Bound(kMapBindings + 5, direction)});
    sample.surfaces.appendBound(kPixelBindings, bound);
    commands.bindResources(bound);
    commands.pushConstants(LookUpPush{map.width(), surfaces.layer_count, weight * map.quantum()});
    commands.dispatch(gpu::groupsOf(irradiance.desc().width, kPixelGroup),
                      gpu::groupsOf(irradiance.desc().height, kPixelGroup));
  });
}

}  // namespace nephroid
