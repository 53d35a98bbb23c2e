#include "frame/specular_pass.h"

#include <algorithm>
#include <bit>

#include "core/spectrum.h"
#include "frame/passes.h"
#include "frame/table.h"
#include "shaders/frame/specular.comp.h"
#include "shaders/frame/specular_pixels.comp.h"

namespace nephroid {
namespace {

/// Wavelengths that a dispersive path may have: so many that their discs of colour run into one another.
constexpr int kBandCount = 64;
/// Groups of threads that go through the list of pixels: enough for every device, few enough to be all at work. A power
/// of two, as frame/specular.comp.glsl wants their number.
constexpr std::uint32_t kMaxGroups = 2048;

/// Pushed by frame/specular_push.glsl.
struct SpecularPush {
  SamplePush sample;
  std::uint32_t max_events, tree_nodes, tree_orders, band_count;
};

/// Wavelength and weight times the number of bands.
gpu::Image makeBandTable(gpu::Device& device, gpu::CommandRecorder& recorder) {
  std::vector<vec4> texels;
  for (const Band& band : makeBands(kBandCount))
    texels.emplace_back(band.wavelength_nm, band.weight * static_cast<float>(kBandCount));
  return makeTexelTable(device, recorder, kFloat4, std::as_bytes(std::span(texels)), "bands");
}

std::vector<gpu::Constant> constantsOf(const SceneTraits& traits, const std::vector<gpu::Constant>& lights) {
  std::vector<gpu::Constant> constants = traits.pathConstants();
  constants.insert(constants.end(), lights.begin(), lights.end());
  return constants;
}

}  // namespace

SpecularPass::SpecularPass(gpu::Device& device, gpu::CommandRecorder& recorder, const SceneBuffers& buffers,
                           const Inputs& inputs, const std::vector<gpu::Constant>& lights, std::uint32_t max_events)
    : buffers_(buffers),
      inputs_(inputs),
      max_events_(max_events),
      list_(device,
            {.shader = shaders::specular_pixels_comp,
             .bindings = SceneBuffers::bindings({kTexture, kTexture, kTable}),
             .constants = buffers.traits().constants()},
            "list of specular pixels"),
      follow_(device,
              {.shader = shaders::specular_comp,
               .bindings = SceneBuffers::bindings({kTexture, kTexture, kTexture, kTable, kTable, kTexture, kTexture,
                                                   kTexture, kTexture, kTable, kStorage, kTexture, kTexture}),
               .push_bytes = sizeof(SpecularPush),
               .constants = constantsOf(buffers.traits(), lights)},
              "specular"),
      bands_(makeBandTable(device, recorder)) {
  fitPicture(device);
}

void SpecularPass::fitPicture(gpu::Device& device) {
  const gpu::ImageDesc& seen = inputs_.seen.desc();
  sum_ = gpu::Image(device,
                    {.format = kFloat4,
                     .width = seen.width,
                     .height = seen.height,
                     .usage = VK_IMAGE_USAGE_STORAGE_BIT | VK_IMAGE_USAGE_SAMPLED_BIT},
                    "specular");
  const VkDeviceSize words = VkDeviceSize{seen.width} * seen.height + 1;
  pixels_ = gpu::Buffer(device, words * sizeof(std::uint32_t), VK_BUFFER_USAGE_STORAGE_BUFFER_BIT,
                        gpu::MemoryIntent::kDevice, "specular pixels");
}

void SpecularPass::recordList(gpu::CommandRecorder& recorder) {
  recorder.pass("clear list", {Use(pixels_, Access::kTransferWrite)},
                [&](PassCommands& commands) { commands.fill(pixels_, 0, 0, sizeof(std::uint32_t)); });
  const std::vector<Use> uses = buffers_.uses(
      Access::kComputeRead, {Use(inputs_.seen, Access::kComputeRead), Use(inputs_.tint, Access::kComputeRead),
                             Use(pixels_, Access::kComputeWrite)});
  recorder.pass("specular pixels", uses, [&](PassCommands& commands) {
    const gpu::Sampler& nearest = buffers_.sampler();
    commands.bind(list_);
    commands.bindResources(
        buffers_.bound({Bound(7, inputs_.seen, nearest), Bound(8, inputs_.tint, nearest), Bound(9, pixels_)}));
    commands.dispatch(gpu::groupsOf(sum_.desc().width, 8), gpu::groupsOf(sum_.desc().height, 8));
  });
}

void SpecularPass::record(gpu::CommandRecorder& recorder, const SamplePush& sample) {
  recordList(recorder);
  const LightGrids& grids = inputs_.grids;
  const SpecularPush push{sample, max_events_, inputs_.tree.nodeCount(), inputs_.tree.orderCount(),
                          static_cast<std::uint32_t>(kBandCount)};
  std::vector<Use> uses = buffers_.uses(
      Access::kComputeRead, {Use(inputs_.camera_view, Access::kComputeRead), Use(inputs_.seen, Access::kComputeRead),
                             Use(bands_, Access::kComputeRead), Use(inputs_.lamps, Access::kComputeRead),
                             Use(inputs_.environment, Access::kComputeRead), Use(pixels_, Access::kComputeRead),
                             Use(sum_, Access::kComputeWrite), Use(inputs_.tree.nodes(), Access::kComputeRead),
                             Use(inputs_.tree.triangles(), Access::kComputeRead)});
  const std::vector<Use> of_lights = grids.uses();
  uses.insert(uses.end(), of_lights.begin(), of_lights.end());
  recorder.pass("specular", uses, [&](PassCommands& commands) {
    const gpu::Sampler& nearest = buffers_.sampler();
    commands.bind(follow_);
    std::vector<Bound> bound =
        buffers_.bound({Bound(11, inputs_.camera_view), Bound(12, inputs_.seen, nearest), Bound(13, bands_, nearest),
                        Bound(14, inputs_.lamps, nearest), Bound(15, inputs_.environment, inputs_.environment_sampler),
                        Bound(16, pixels_), Bound(17, sum_), Bound(18, inputs_.tree.nodes(), nearest),
                        Bound(19, inputs_.tree.triangles(), nearest)});
    const std::vector<Bound> of_grids = grids.bound(SceneBuffers::kBindings);
    bound.insert(bound.end(), of_grids.begin(), of_grids.end());
    commands.bindResources(bound);
    commands.pushConstants(push);
    const std::uint32_t pixels = sum_.desc().width * sum_.desc().height;
    commands.dispatch(std::min(std::bit_ceil(gpu::groupsOf(pixels, 64)), kMaxGroups));
  });
}

}  // namespace nephroid
