#include "frame/surface_layers.h"

#include "core/assert.h"
#include "frame/passes.h"
#include "frame/table.h"
#include "frame/view.h"
#include "shaders/frame/facing.frag.h"
#include "shaders/frame/layer.vert.h"
#include "shaders/frame/peel.frag.h"
#include "shaders/frame/surface_layers.comp.h"
#include "shaders/frame/visibility.frag.h"

namespace nephroid {
namespace {

constexpr VkFormat kSeenFormat = VK_FORMAT_R32G32_UINT;
constexpr VkFormat kDepthFormat = VK_FORMAT_D32_SFLOAT;

/// Of facing.frag.glsl: whether it leaves out what was seen before.
constexpr std::uint32_t kPeelsConstant = 8;

gpu::GraphicsPipeline makeDraw(gpu::Device& device, SurfaceLayers::Sides sides, bool peels, const SceneBuffers& buffers,
                               const char* name) {
  const bool facing = sides == SurfaceLayers::Sides::kFacing;
  std::vector<gpu::Constant> constants = buffers.traits().constants();
  if (facing) constants.push_back({kPeelsConstant, peels});
  gpu::Spirv fragment = shaders::visibility_frag;
  if (peels) fragment = shaders::peel_frag;
  if (facing) fragment = shaders::facing_frag;
  return {device,
          {.vertex = shaders::layer_vert,
           .fragment = fragment,
           .bindings = facing || peels ? SceneBuffers::bindings({kTable, kTexture}) : SceneBuffers::bindings({kTable}),
           .push_bytes = sizeof(std::uint32_t),
           .constants = constants,
           .vertex_buffers = {{0, sizeof(vec3), VK_VERTEX_INPUT_RATE_VERTEX}},
           .attributes = {{0, 0, VK_FORMAT_R32G32B32_SFLOAT, 0}},
           .colors = {{.format = kSeenFormat}},
           .depth = kDepthFormat},
          name};
}

gpu::Image makeLayers(gpu::Device& device, VkFormat format, std::uint32_t size, std::uint32_t layers,
                      VkImageUsageFlags usage, const char* name) {
  return {device,
          {.format = format, .width = size, .height = size, .layers = layers, .usage = usage, .is_array = true},
          name};
}

}  // namespace

SurfaceLayers::SurfaceLayers(gpu::Device& device, const SceneBuffers& buffers, std::uint32_t size, std::uint32_t views,
                             std::uint32_t layers, Sides sides)
    : buffers_(buffers),
      sides_(sides),
      first_(makeDraw(device, sides, false, buffers, "first layer")),
      next_(makeDraw(device, sides, true, buffers, "next layer")),
      places_(device,
              {.shader = shaders::surface_layers_comp,
               .bindings = SceneBuffers::bindings({kUniforms, kStorage, kStorage, kStorage}),
               .push_bytes = sizeof(std::uint32_t),
               .constants = buffers.traits().constants()},
              "places of layers"),
      layer_count_(layers),
      views_(makeUniforms<ViewRecord>(device, kMostViews, "views of layers")),
      seen_(makeLayers(device, kSeenFormat, size, views * layers,
                       VK_IMAGE_USAGE_COLOR_ATTACHMENT_BIT | VK_IMAGE_USAGE_STORAGE_BIT | VK_IMAGE_USAGE_SAMPLED_BIT,
                       "seen in layers")),
      surfaces_(makeLayers(device, kFloat4, size, views * layers,
                           VK_IMAGE_USAGE_STORAGE_BIT | VK_IMAGE_USAGE_SAMPLED_BIT, "surfaces in layers")),
      depths_(makeLayers(device, kFloat4, size, views * gpu::groupsOf(layers, 4),
                         VK_IMAGE_USAGE_STORAGE_BIT | VK_IMAGE_USAGE_SAMPLED_BIT, "depths in layers")) {
  for (gpu::Image& depth : drawn_depths_)
    depth = gpu::Image(device,
                       {.format = kDepthFormat,
                        .width = size,
                        .height = size,
                        .usage = VK_IMAGE_USAGE_DEPTH_STENCIL_ATTACHMENT_BIT | VK_IMAGE_USAGE_SAMPLED_BIT},
                       "depth of a layer");
}

void SurfaceLayers::record(gpu::CommandRecorder& recorder, std::span<const ViewRecord> views,
                           std::span<const std::size_t> draws) {
  view_count_ = static_cast<std::uint32_t>(views.size());
  NEPHROID_ASSERT_LE(view_count_, kMostViews);
  NEPHROID_ASSERT_LE(view_count_ * layer_count_, seen_.desc().layers);
  recorder.upload(views_, std::as_bytes(views));
  for (std::uint32_t v = 0; v < view_count_; ++v)
    for (std::uint32_t layer = 0; layer < layer_count_; ++layer) recordLayer(recorder, views[v], draws, v, layer);
  const std::vector<Use> uses = buffers_.uses(
      Access::kComputeRead, {Use(views_, Access::kComputeRead), Use(seen_, Access::kStorageRead),
                             Use(surfaces_, Access::kComputeWrite, true), Use(depths_, Access::kComputeWrite, true)});
  recorder.pass("places of layers", uses, [&](PassCommands& commands) {
    commands.bind(places_);
    commands.bindResources(
        buffers_.bound({Bound(7, views_), Bound(8, seen_), Bound(9, surfaces_), Bound(10, depths_)}));
    commands.pushConstants(layer_count_);
    const std::uint32_t groups = gpu::groupsOf(size(), kPixelGroup);
    commands.dispatch(groups, groups, view_count_);
  });
}

void SurfaceLayers::recordLayer(gpu::CommandRecorder& recorder, const ViewRecord& view,
                                std::span<const std::size_t> draws, std::uint32_t view_index, std::uint32_t layer) {
  const gpu::Image &depth = drawn_depths_[layer % 2], &before = drawn_depths_[1 - layer % 2];
  const bool peels = layer > 0;
  // The layers before stay, so only the first use of the array may discard what was in it.
  std::vector<Use> uses = buffers_.uses(
      Access::kGraphicsRead,
      {Use(views_, Access::kGraphicsRead), Use(buffers_.positions(), Access::kVertexFetch),
       Use(buffers_.indices(), Access::kVertexFetch), Use(seen_, Access::kColorTarget, view_index == 0 && layer == 0),
       Use(depth, Access::kDepthTarget, true)});
  // Shaders that peel or not have it bound either way.
  const bool binds_before = peels || sides_ == Sides::kFacing;
  if (binds_before) uses.emplace_back(before, Access::kGraphicsRead);
  recorder.pass("layer", uses, [&](PassCommands& commands) {
    commands.beginRendering(
        {.colors = {{.image = seen_}}, .depth = &depth, .color_layer = view_index * layer_count_ + layer});
    commands.bind(peels ? next_ : first_);
    std::vector<Bound> bound = buffers_.bound({Bound(7, views_)});
    if (binds_before) bound.emplace_back(8, before, buffers_.sampler());
    commands.bindResources(bound);
    commands.pushConstants(view_index);
    commands.bindVertexBuffer(buffers_.positions());
    commands.bindIndexBuffer(buffers_.indices());
    for (const std::size_t i : draws) {
      const SceneBuffers::Draw& draw = buffers_.draws()[i];
      if (!mayShow(view, draw.bounds)) continue;
      commands.drawIndexed(draw.index_count, draw.first_index, draw.vertex_offset, 1, draw.instance);
    }
    commands.endRendering();
  });
}

}  // namespace nephroid
