#include "frame/specular_pass.h"

#include <array>
#include <span>

#include "core/spectrum.h"
#include "frame/passes.h"
#include "frame/table.h"
#include "shaders/frame/specular.comp.h"
#include "shaders/frame/specular_agreement.comp.h"
#include "shaders/frame/specular_cells.comp.h"
#include "shaders/frame/specular_lit.comp.h"
#include "shaders/frame/specular_mixed.comp.h"
#include "shaders/frame/specular_pixels.comp.h"

namespace nephroid {
namespace {

/// Wavelengths that a dispersive path may have: so many that their discs of colour run into one another.
constexpr int kBandCount = 64;
/// ListHead of frame/specular_grid.glsl.
struct ListHead {
  std::uint32_t groups_x = 0, groups_y = 1, groups_z = 1, count = 0;
};

/// Wavelength and weight times the number of bands.
gpu::Buffer makeBandTable(gpu::Device& device, gpu::CommandRecorder& recorder) {
  std::vector<vec4> texels;
  for (const Band& band : makeBands(kBandCount))
    texels.emplace_back(band.wavelength_nm, band.weight * static_cast<float>(kBandCount));
  return makeTexelTable(device, recorder, kFloat4, std::as_bytes(std::span(texels)), "bands");
}

// Constants of frame/specular.comp.glsl and frame/specular_grid.glsl.
constexpr std::uint32_t kTaskConstant = 17, kSpacingConstant = 18;
constexpr std::uint32_t kShow = 0, kFollowMost = 1;
/// Of frame/specular_grid.glsl.
constexpr std::uint32_t kListCount = 6, kPixelListCount = 1;
constexpr std::uint32_t kFollowedPixels = 0, kPoints = 1, kCells = 2, kLitCells = 3, kMixedCells = 5;
constexpr std::array<ListHead, kListCount> kNoLists{};
/// Texels of a point: frame/specular_ends.glsl.
constexpr std::uint32_t kEndTexels = 3, kBendTexels = 2, kChainCount = 2;

/// Of frame/receiver_map.glsl, the layer's sum included.
std::vector<VkDescriptorType> receiverTypes() {
  std::vector<VkDescriptorType> types = ReceiverMap::descriptorTypes();
  types.push_back(kStorage);
  return types;
}

std::vector<gpu::Constant> join(std::vector<gpu::Constant> constants, const std::vector<gpu::Constant>& more) {
  constants.insert(constants.end(), more.begin(), more.end());
  return constants;
}

}  // namespace

/// Pushed by frame/specular_push.glsl.
struct SpecularPass::Push {
  SamplePush sample;
  std::uint32_t max_events;
  TriangleTree::Walk tree;
  std::uint32_t band_count;
  uvec2 shift;
  std::uint32_t stamp, chain;
};

SpecularPass::SpecularPass(gpu::Device& device, gpu::CommandRecorder& recorder, const SceneBuffers& buffers,
                           const Inputs& inputs, const std::vector<gpu::Constant>& lights, const Following& following)
    : buffers_(buffers),
      inputs_(inputs),
      following_(following),
      no_receivers_(device),
      bands_(makeBandTable(device, recorder)),
      no_lists_(device, sizeof(kNoLists), 0, gpu::MemoryIntent::kDevice, "no lists") {
  recorder.upload(no_lists_, std::as_bytes(std::span(kNoLists)));
  const SceneTraits& traits = buffers.traits();
  const gpu::Constant spacing{kSpacingConstant, following.spacing};
  const std::vector<gpu::Constant> of_ends =
      join(lights, (inputs.receivers ? *inputs.receivers : no_receivers_).constants());
  const auto make = [&](gpu::Spirv shader, std::initializer_list<VkDescriptorType> types,
                        const std::vector<gpu::Constant>& constants, const char* name, bool lights_ends = false) {
    std::vector<gpu::Binding> bindings = SceneBuffers::bindings(types);
    if (lights_ends)
      for (const VkDescriptorType type : receiverTypes())
        bindings.push_back({static_cast<std::uint32_t>(bindings.size()), type});
    return gpu::ComputePipeline(
        device,
        {.shader = shader, .bindings = bindings, .push_bytes = sizeof(Push), .constants = join(constants, {spacing})},
        name);
  };
  const auto follow = [&](std::uint32_t task, const char* name) {
    return make(shaders::specular_comp,
                {kTexels, kTexels, kTexels, kTable, kUniforms, kStoredTexels, kTexels, kTexels, kTexture, kStorage,
                 kTexels, kTexels, kStorage, kTable},
                join(join(join(traits.pathConstants(), of_ends), inputs.tree.constants()), {{kTaskConstant, task}}),
                name, true);
  };
  pixels_ = make(shaders::specular_pixels_comp, {kStorage, kTable, kTexture}, traits.constants(), "specular pixels");
  show_ = follow(kShow, "specular");
  if (following.spacing > 1) {
    cells_ = make(shaders::specular_cells_comp, {kStorage, kTable}, traits.constants(), "specular cells");
    mixed_ = make(shaders::specular_mixed_comp, {kStorage, kTable}, traits.constants(), "specular mixed cells");
    follow_most_ = follow(kFollowMost, "specular points");
    agreement_ = make(shaders::specular_agreement_comp, {kStorage, kTable, kTexels, kStoredTexels},
                      traits.pathConstants(), "specular agreement");
    lit_ = make(shaders::specular_lit_comp,
                {kTexels, kTexels, kTexels, kTable, kStorage, kTable, kTexels, kTexels, kTexture, kStorage, kTexels},
                join(traits.constants(), of_ends), "specular lit", true);
  }
  fitPicture(device);
}

bool SpecularPass::hasCells() const {
  // A picture of one row has no cells between its points.
  return following_.spacing > 1 && inputs_.seen.desc().width > 1 && inputs_.seen.desc().height > 1;
}

uvec2 SpecularPass::pointCount() const {
  // As in frame/specular_grid.glsl.
  const uvec2 size(inputs_.seen.desc().width, inputs_.seen.desc().height);
  return (size + 2U * following_.spacing - 2U) / following_.spacing + 1U;
}

void SpecularPass::fitPicture(gpu::Device& device) {
  const gpu::ImageDesc& seen = inputs_.seen.desc();
  const auto make = [&](uvec2 size, const char* name) {
    return gpu::Image(device,
                      {.format = kFloat4,
                       .width = size.x,
                       .height = size.y,
                       .usage = VK_IMAGE_USAGE_STORAGE_BIT | VK_IMAGE_USAGE_SAMPLED_BIT},
                      name);
  };
  sum_ = make({seen.width, seen.height}, "specular");
  // Something has to be bound, here and below.
  caustic_sum_ = make(inputs_.receivers ? uvec2(seen.width, seen.height) : uvec2(1), "caustics in specular");
  const uvec2 points = pointCount();
  const std::uint64_t chains = hasCells() ? std::uint64_t{kChainCount} * points.x * points.y : 1;
  ends_ = makeWrittenTable(device, chains * kEndTexels, "specular ends");
  bends_ = makeWrittenTable(device, chains * kBendTexels, "how specular ends bend");
  stamp_ = 0;
  const VkDeviceSize words = VkDeviceSize{seen.width} * seen.height * kPixelListCount +
                             VkDeviceSize{points.x} * points.y * (kListCount - kPixelListCount);
  lists_ = gpu::Buffer(device, sizeof(kNoLists) + words * sizeof(std::uint32_t),
                       VK_BUFFER_USAGE_STORAGE_BUFFER_BIT | VK_BUFFER_USAGE_INDIRECT_BUFFER_BIT,
                       gpu::MemoryIntent::kDevice, "specular lists");
}

SpecularPass::Push SpecularPass::pushOf(const SamplePush& sample) const {
  // From frame to frame the grid moves on, through all places in as many frames as there are.
  const std::uint32_t side = following_.spacing, place = sample.frame % (side * side);
  return {.sample = sample,
          .max_events = following_.max_events,
          .tree = inputs_.tree.walk(),
          .band_count = static_cast<std::uint32_t>(kBandCount),
          .shift = uvec2(place % side, place / side),
          .stamp = stamp_,
          .chain = 0};
}

void SpecularPass::appendReceivers(std::uint32_t first, std::vector<Bound>& bound, std::vector<Use>& uses) const {
  const ReceiverMap& receivers = inputs_.receivers ? *inputs_.receivers : no_receivers_;
  receivers.appendBound(first, bound);
  bound.emplace_back(first + ReceiverMap::kBindings, caustic_sum_);
  receivers.appendUses(uses);
  uses.emplace_back(caustic_sum_, Access::kComputeWrite);
}

void SpecularPass::recordPixels(gpu::CommandRecorder& recorder, const Push& push) {
  const std::vector<Use> uses = buffers_.uses(
      Access::kComputeRead, {Use(inputs_.seen, Access::kStorageRead), Use(inputs_.tint, Access::kComputeRead),
                             Use(lists_, Access::kComputeWrite)});
  recorder.pass("specular pixels", uses, [&](PassCommands& commands) {
    const gpu::Sampler& nearest = buffers_.sampler();
    commands.bind(pixels_);
    commands.bindResources(buffers_.bound({Bound(7, inputs_.seen), Bound(8, lists_), Bound(9, inputs_.tint, nearest)}));
    commands.pushConstants(push);
    commands.dispatch(gpu::groupsOf(sum_.desc().width, 8), gpu::groupsOf(sum_.desc().height, 8));
  });
}

void SpecularPass::recordCells(gpu::CommandRecorder& recorder, const Push& push) {
  const std::vector<Use> uses = buffers_.uses(
      Access::kComputeRead, {Use(inputs_.seen, Access::kStorageRead), Use(lists_, Access::kDispatchWrite)});
  recorder.pass("specular cells", uses, [&](PassCommands& commands) {
    commands.bind(cells_);
    commands.bindResources(buffers_.bound({Bound(7, inputs_.seen), Bound(8, lists_)}));
    commands.pushConstants(push);
    commands.dispatch(gpu::groupsOf(pointCount().x, 8), gpu::groupsOf(pointCount().y, 8));
  });
  const std::vector<Use> mixed_uses = buffers_.uses(
      Access::kComputeRead, {Use(inputs_.seen, Access::kStorageRead), Use(lists_, Access::kDispatchWrite)});
  recorder.pass("specular mixed cells", mixed_uses, [&](PassCommands& commands) {
    commands.bind(mixed_);
    commands.bindResources(buffers_.bound({Bound(7, inputs_.seen), Bound(8, lists_)}));
    commands.pushConstants(push);
    commands.dispatchIndirect(lists_, kMixedCells * sizeof(ListHead));
  });
}

void SpecularPass::recordAgreement(gpu::CommandRecorder& recorder, const Push& push) {
  const std::vector<Use> uses =
      buffers_.uses(Access::kComputeRead, {Use(inputs_.seen, Access::kStorageRead), Use(lists_, Access::kDispatchWrite),
                                           Use(ends_, Access::kComputeRead), Use(bends_, Access::kComputeWrite)});
  recorder.pass("specular agreement", uses, [&](PassCommands& commands) {
    commands.bind(agreement_);
    commands.bindResources(
        buffers_.bound({Bound(7, inputs_.seen), Bound(8, lists_), Bound(9, ends_), Bound(10, bends_)}));
    commands.pushConstants(push);
    commands.dispatchIndirect(lists_, kCells * sizeof(ListHead));
  });
}

void SpecularPass::recordLit(gpu::CommandRecorder& recorder, Push push) {
  const LightGrids& grids = inputs_.grids;
  std::vector<Use> uses = buffers_.uses(
      Access::kComputeRead,
      {Use(inputs_.seen, Access::kStorageRead), Use(lists_, Access::kDispatchRead), Use(ends_, Access::kComputeRead),
       Use(bends_, Access::kComputeRead), Use(inputs_.lamps, Access::kComputeRead),
       Use(inputs_.environment, Access::kComputeRead), Use(sum_, Access::kComputeWrite)});
  const std::vector<Use> of_lights = grids.uses();
  uses.insert(uses.end(), of_lights.begin(), of_lights.end());
  std::vector<Bound> bound =
      buffers_.bound({Bound(11, inputs_.seen), Bound(12, lists_), Bound(13, ends_), Bound(14, inputs_.lamps),
                      Bound(15, inputs_.environment, inputs_.environment_sampler), Bound(16, sum_), Bound(17, bends_)});
  appendReceivers(18, bound, uses);
  const std::vector<Bound> of_grids = grids.bound(SceneBuffers::kBindings);
  bound.insert(bound.end(), of_grids.begin(), of_grids.end());
  // One after the other: both add to the same pixels.
  const std::uint32_t chains = buffers_.traits().specular.transmits ? kChainCount : 1;
  for (push.chain = 0; push.chain < chains; ++push.chain)
    recorder.pass("specular lit", uses, [&](PassCommands& commands) {
      commands.bind(lit_);
      commands.bindResources(bound);
      commands.pushConstants(push);
      commands.dispatchIndirect(lists_, (kLitCells + push.chain) * sizeof(ListHead));
    });
}

void SpecularPass::recordFollowing(gpu::CommandRecorder& recorder, const gpu::ComputePipeline& pipeline,
                                   const char* name, std::uint32_t list, const Push& push) {
  const LightGrids& grids = inputs_.grids;
  std::vector<Use> uses = buffers_.uses(
      Access::kComputeRead,
      {Use(inputs_.camera_view, Access::kComputeRead), Use(inputs_.seen, Access::kStorageRead),
       Use(bands_, Access::kComputeRead), Use(inputs_.lamps, Access::kComputeRead),
       Use(inputs_.environment, Access::kComputeRead), Use(lists_, Access::kDispatchRead),
       Use(ends_, Access::kComputeWrite), Use(sum_, Access::kComputeWrite),
       Use(inputs_.tree.nodes(), Access::kComputeRead), Use(inputs_.tree.triangles(), Access::kComputeRead)});
  const std::vector<Use> of_lights = grids.uses();
  uses.insert(uses.end(), of_lights.begin(), of_lights.end());
  std::vector<Bound> bound = buffers_.bound(
      {Bound(11, inputs_.camera_view), Bound(12, ends_), Bound(13, bands_), Bound(14, inputs_.lamps),
       Bound(15, inputs_.environment, inputs_.environment_sampler), Bound(16, sum_), Bound(17, inputs_.tree.nodes()),
       Bound(18, inputs_.tree.triangles()), Bound(19, inputs_.seen), Bound(20, lists_)});
  appendReceivers(21, bound, uses);
  const std::vector<Bound> of_grids = grids.bound(SceneBuffers::kBindings);
  bound.insert(bound.end(), of_grids.begin(), of_grids.end());
  recorder.pass(name, uses, [&](PassCommands& commands) {
    commands.bind(pipeline);
    commands.bindResources(bound);
    commands.pushConstants(push);
    commands.dispatchIndirect(lists_, list * sizeof(ListHead));
  });
}

void SpecularPass::record(gpu::CommandRecorder& recorder, const SamplePush& sample) {
  // The memory may be that of an earlier pass, whose ends bear the stamps to come.
  if (stamp_ == 0)
    recorder.pass("clear ends", {Use(ends_, Access::kTransferWrite)},
                  [&](PassCommands& commands) { commands.fill(ends_, 0); });
  ++stamp_;
  const Push push = pushOf(sample);
  recorder.pass("clear lists", {Use(no_lists_, Access::kTransferRead), Use(lists_, Access::kTransferWrite)},
                [&](PassCommands& commands) { commands.copy(no_lists_, lists_, sizeof(kNoLists)); });
  if (hasCells()) {
    recordCells(recorder, push);
    recordFollowing(recorder, follow_most_, "specular points", kPoints, push);
    recordAgreement(recorder, push);
    recordLit(recorder, push);
  } else {
    recordPixels(recorder, push);
  }
  recordFollowing(recorder, show_, "specular", kFollowedPixels, push);
}

}  // namespace nephroid
