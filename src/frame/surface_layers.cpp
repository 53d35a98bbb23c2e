#include "frame/surface_layers.h"

#include "frame/passes.h"
#include "shaders/frame/peel.frag.h"
#include "shaders/frame/surface_layers.comp.h"
#include "shaders/frame/visibility.frag.h"
#include "shaders/frame/visibility.vert.h"

namespace nephroid {
namespace {

constexpr VkFormat kSeenFormat = VK_FORMAT_R32G32_UINT;
constexpr VkFormat kDepthFormat = VK_FORMAT_D32_SFLOAT;
/// Threads of a group along each side.
constexpr std::uint32_t kGroup = 8;

gpu::GraphicsPipeline makeDraw(gpu::Device& device, gpu::Spirv fragment, std::vector<gpu::Binding> bindings,
                               const SceneBuffers& buffers, const char* name) {
  return {device,
          {.vertex = shaders::visibility_vert,
           .fragment = fragment,
           .bindings = std::move(bindings),
           .constants = buffers.traits().constants(),
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

SurfaceLayers::SurfaceLayers(gpu::Device& device, const SceneBuffers& buffers, std::uint32_t size, std::uint32_t layers)
    : buffers_(buffers),
      first_(makeDraw(device, shaders::visibility_frag, SceneBuffers::bindings({kTable}), buffers, "first layer")),
      next_(makeDraw(device, shaders::peel_frag, SceneBuffers::bindings({kTable, kTexture}), buffers, "next layer")),
      places_(device,
              {.shader = shaders::surface_layers_comp,
               .bindings = SceneBuffers::bindings({kTable, kTexture, kStorage}),
               .constants = buffers.traits().constants()},
              "places of layers"),
      view_(device, sizeof(ViewRecord), VK_BUFFER_USAGE_STORAGE_BUFFER_BIT, gpu::MemoryIntent::kDevice,
            "view of layers"),
      seen_(makeLayers(device, kSeenFormat, size, layers,
                       VK_IMAGE_USAGE_COLOR_ATTACHMENT_BIT | VK_IMAGE_USAGE_SAMPLED_BIT, "seen in layers")),
      surfaces_(makeLayers(device, kFloat4, size, layers, VK_IMAGE_USAGE_STORAGE_BIT | VK_IMAGE_USAGE_SAMPLED_BIT,
                           "surfaces in layers")) {
  for (gpu::Image& depth : depths_)
    depth = gpu::Image(device,
                       {.format = kDepthFormat,
                        .width = size,
                        .height = size,
                        .usage = VK_IMAGE_USAGE_DEPTH_STENCIL_ATTACHMENT_BIT | VK_IMAGE_USAGE_SAMPLED_BIT},
                       "depth of a layer");
}

void SurfaceLayers::record(gpu::CommandRecorder& recorder, const ViewRecord& view, std::span<const std::size_t> draws) {
  recorder.upload(view_, std::as_bytes(std::span(&view, 1)));
  for (std::uint32_t layer = 0; layer < count(); ++layer) recordLayer(recorder, draws, layer);
  const std::vector<Use> uses =
      buffers_.uses(Access::kComputeRead, {Use(view_, Access::kComputeRead), Use(seen_, Access::kComputeRead),
                                           Use(surfaces_, Access::kComputeWrite, true)});
  recorder.pass("places of layers", uses, [&](PassCommands& commands) {
    commands.bind(places_);
    commands.bindResources(buffers_.bound({Bound(7, view_), Bound(8, seen_, buffers_.sampler()), Bound(9, surfaces_)}));
    const std::uint32_t groups = gpu::groupsOf(size(), kGroup);
    commands.dispatch(groups, groups, count());
  });
}

void SurfaceLayers::recordLayer(gpu::CommandRecorder& recorder, std::span<const std::size_t> draws,
                                std::uint32_t layer) {
  const gpu::Image &depth = depths_[layer % 2], &before = depths_[1 - layer % 2];
  const bool peels = layer > 0;
  // The layers before stay, so only the first use of the array may discard what was in it.
  std::vector<Use> uses = buffers_.uses(
      Access::kGraphicsRead, {Use(view_, Access::kGraphicsRead), Use(buffers_.positions(), Access::kVertexFetch),
                              Use(buffers_.indices(), Access::kVertexFetch),
                              Use(seen_, Access::kColorTarget, layer == 0), Use(depth, Access::kDepthTarget, true)});
  if (peels) uses.emplace_back(before, Access::kGraphicsRead);
  recorder.pass("layer", uses, [&](PassCommands& commands) {
    commands.beginRendering({.colors = {{.image = seen_}}, .depth = &depth, .color_layer = layer});
    commands.bind(peels ? next_ : first_);
    std::vector<Bound> bound = buffers_.bound({Bound(7, view_)});
    if (peels) bound.emplace_back(8, before, buffers_.sampler());
    commands.bindResources(bound);
    commands.bindVertexBuffer(buffers_.positions());
    commands.bindIndexBuffer(buffers_.indices());
    for (const std::size_t i : draws) {
      const SceneBuffers::Draw& draw = buffers_.draws()[i];
      commands.drawIndexed(draw.index_count, draw.first_index, draw.vertex_offset, 1, draw.instance);
    }
    commands.endRendering();
  });
}

}  // namespace nephroid
