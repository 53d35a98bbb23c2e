#include "frame/pixel_deposit.h"

#include "core/assert.h"
#include "frame/passes.h"
#include "shaders/frame/pixel_irradiance.comp.h"
#include "shaders/frame/pixel_places.comp.h"

namespace nephroid {
namespace {

constexpr std::uint32_t kPixelBindings = SceneBuffers::kBindings;

std::vector<gpu::Binding> describePlaces() {
  std::vector<gpu::Binding> bindings = SceneBuffers::bindings({});
  std::vector<VkDescriptorType> types = PixelSurfaces::descriptorTypes();
  types.push_back(kStorage);
  for (const VkDescriptorType type : types) bindings.push_back({static_cast<std::uint32_t>(bindings.size()), type});
  return bindings;
}

std::vector<gpu::Constant> placesConstants(const SceneBuffers& buffers) {
  std::vector<gpu::Constant> constants = buffers.traits().constants();
  constants.push_back(PixelSurfaces::constant(false));
  return constants;
}

}  // namespace

PixelDeposit::PixelDeposit(gpu::Device& device, const SceneBuffers& buffers, bool directions)
    : device_(device),
      buffers_(buffers),
      directions_(directions),
      places_pipeline_(
          device,
          {.shader = shaders::pixel_places_comp, .bindings = describePlaces(), .constants = placesConstants(buffers)},
          "places of pixels"),
      irradiance_pipeline_(
          device,
          {.shader = shaders::pixel_irradiance_comp,
           .bindings = {{0, kUniforms}, {1, kStorage}, {2, kStorage}, {3, kStorage}, {4, kStorage}, {5, kStorage}},
           .push_bytes = sizeof(float),
           .constants = {{0, directions}}},
          "irradiance of pixels") {}

void PixelDeposit::begin(gpu::CommandRecorder& recorder, const RealtimeSample& sample, float most) {
  NEPHROID_ASSERT_EQ(sample.surfaces.isForeign(), false);
  const std::uint32_t width = sample.surfaces.width(), height = sample.surfaces.height();
  if (!map_.valid() || map_.width() != width || map_.height() != height) {
    map_ = FluxMap(device_, width, height, 1, directions_);
    places_ = gpu::Image(device_,
                         {.format = kFloat4,
                          .width = width,
                          .height = height,
                          .usage = VK_IMAGE_USAGE_STORAGE_BIT | VK_IMAGE_USAGE_SAMPLED_BIT,
                          .is_array = true},
                         "places of pixels");
  }
  map_.clear(recorder, most);
  std::vector<Use> uses = buffers_.uses(Access::kComputeRead, {Use(places_, Access::kComputeWrite, true)});
  sample.surfaces.appendUses(uses);
  recorder.pass("places of pixels", uses, [&](PassCommands& commands) {
    commands.bind(places_pipeline_);
    std::vector<Bound> bound = buffers_.bound({Bound(kPixelBindings + PixelSurfaces::kBindings, places_)});
    sample.surfaces.appendBound(kPixelBindings, bound);
    commands.bindResources(bound);
    commands.dispatch(gpu::groupsOf(width, kPixelGroup), gpu::groupsOf(height, kPixelGroup));
  });
}

void PixelDeposit::finish(gpu::CommandRecorder& recorder, const RealtimeSample& sample) {
  const gpu::Image &irradiance = sample.target.irradiance, &direction = sample.target.direction;
  const gpu::Buffer& view = sample.surfaces.view();
  const std::vector<Use> uses{Use(view, Access::kComputeRead),        Use(places_, Access::kStorageRead),
                              Use(map_.flux(), Access::kStorageRead), Use(map_.tiles(), Access::kStorageRead),
                              Use(irradiance, Access::kComputeWrite), Use(direction, Access::kComputeWrite)};
  recorder.pass("irradiance of pixels", uses, [&](PassCommands& commands) {
    commands.bind(irradiance_pipeline_);
    commands.bindResources({Bound(0, view), Bound(1, places_), Bound(2, map_.flux()), Bound(3, map_.tiles()),
                            Bound(4, irradiance), Bound(5, direction)});
    commands.pushConstants(map_.quantum());
    commands.dispatch(gpu::groupsOf(map_.width(), kPixelGroup), gpu::groupsOf(map_.height(), kPixelGroup));
  });
}

}  // namespace nephroid
