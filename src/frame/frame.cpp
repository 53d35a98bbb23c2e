#include "frame/frame.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>

#include "core/sampling/sampler.h"
#include "frame/view.h"
#include "nephroid/error.h"
#include "shaders/frame/direct.comp.h"
#include "shaders/frame/emission.comp.h"
#include "shaders/frame/geometry_layer.comp.h"
#include "shaders/frame/light_grid.comp.h"
#include "shaders/frame/surface.comp.h"
#include "shaders/frame/visibility.frag.h"
#include "shaders/frame/visibility.vert.h"

namespace nephroid {
namespace {

using gpu::Access;
using gpu::Bound;
using gpu::PassCommands;
using gpu::Use;

constexpr VkFormat kSeenFormat = VK_FORMAT_R32G32_UINT;
constexpr VkFormat kDepthFormat = VK_FORMAT_D32_SFLOAT;
constexpr VkFormat kFloat4 = VK_FORMAT_R32G32B32A32_SFLOAT;
/// Threads of a group along each side, in every pass over pixels.
constexpr std::uint32_t kGroup = 8;
/// Stream of the sampler that places samples in pixels; the same place in all pixels of a frame.
constexpr std::uint32_t kFilmStream = 0x0F110000U;

/// Bindings of the scene's tables and, behind them, of `types`, numbered from 5.
std::vector<gpu::Binding> withScene(std::initializer_list<VkDescriptorType> types) {
  std::vector<gpu::Binding> bindings = sceneBindings();
  for (const VkDescriptorType type : types) bindings.push_back({static_cast<std::uint32_t>(bindings.size()), type});
  return bindings;
}

constexpr VkDescriptorType kTable = VK_DESCRIPTOR_TYPE_STORAGE_BUFFER;
constexpr VkDescriptorType kTexture = VK_DESCRIPTOR_TYPE_COMBINED_IMAGE_SAMPLER;
constexpr VkDescriptorType kStorage = VK_DESCRIPTOR_TYPE_STORAGE_IMAGE;

gpu::GraphicsPipeline makeVisibility(gpu::Device& device) {
  return gpu::GraphicsPipeline(device,
                               {.vertex = shaders::visibility_vert,
                                .fragment = shaders::visibility_frag,
                                .bindings = {{0, kTable}, {1, kTable}},
                                .vertex_buffers = {{0, sizeof(vec3), VK_VERTEX_INPUT_RATE_VERTEX}},
                                .attributes = {{0, 0, VK_FORMAT_R32G32B32_SFLOAT, 0}},
                                .colors = {{kSeenFormat}},
                                .depth = kDepthFormat},
                               "visibility");
}

gpu::Image makePixels(gpu::Device& device, const FrameSettings& settings, VkFormat format, VkImageUsageFlags usage,
                      const char* name) {
  return gpu::Image(device,
                    {.format = format,
                     .width = static_cast<std::uint32_t>(settings.width),
                     .height = static_cast<std::uint32_t>(settings.height),
                     .usage = usage},
                    name);
}

/// Pushed by surface.comp.
struct FilmPush {
  vec2 film_offset;
};

/// Pushed by light_grid.comp.
struct GridPush {
  std::uint32_t instance, triangle_count, view_mask, node_capacity;
};

/// Pushed by emission.comp.
struct EmissionPush {
  vec2 film_offset;
  float environment_scale, cos_rotation, sin_rotation;
};

}  // namespace

/// What is compiled.
struct RealtimeFrame::Passes {
  explicit Passes(gpu::Device& device)
      : visibility(makeVisibility(device)),
        surface(device,
                {.shader = shaders::surface_comp,
                 .bindings = withScene({kTable, kTexture, kStorage, kStorage}),
                 .push_bytes = sizeof(FilmPush)},
                "surface"),
        light_grid(device,
                   {.shader = shaders::light_grid_comp,
                    .bindings = withScene({kTable, kTable, kTable, kTable, kTable}),
                    .push_bytes = sizeof(GridPush)},
                   "light grid"),
        emission(device,
                 {.shader = shaders::emission_comp,
                  .bindings = withScene({kTable, kTexture, kStorage, kStorage, kStorage}),
                  .push_bytes = sizeof(EmissionPush)},
                 "emission"),
        geometry_layer(device,
                       {.shader = shaders::geometry_layer_comp,
                        .bindings = withScene({kTable, kStorage, kStorage, kStorage}),
                        .push_bytes = sizeof(std::uint32_t)},
                       "geometry layer"),
        nearest(device, {.filter = VK_FILTER_NEAREST}, "nearest") {}

  gpu::GraphicsPipeline visibility;
  /// Once the scene is known.
  void compileDirect(gpu::Device& device, const SceneBuffers::Receivers& receivers) {
    direct = gpu::ComputePipeline(
        device,
        {.shader = shaders::direct_comp,
         .bindings = withScene({kTable, kTable, kTable, kTable, kTable, kStorage, kStorage, kStorage}),
         .push_bytes = sizeof(float),
         .constants = {{0, receivers.metal}, {1, receivers.gloss}, {2, receivers.conductors}}},
        "direct");
  }

  gpu::ComputePipeline surface, direct, light_grid, emission, geometry_layer;
  gpu::Sampler nearest;
};

/// The triangles before a light, by cell of what it sees.
struct RealtimeFrame::LightGrid {
  gpu::Buffer light, views, heads, nodes, counter;
  std::uint32_t node_capacity = 0;
  bool built = false;  ///< and still true
  bool shines = false;
};

RealtimeFrame::RealtimeFrame(gpu::Device& device, const SceneData& scene, const Camera& camera,
                             const FrameSettings& settings)
    : device_(device),
      scene_(scene),
      camera_(camera),
      settings_(settings),
      bounds_(scene.bounds()),
      recorder_(device),
      light_views_(scene, settings.shadow_size, settings.seed),
      passes_(std::make_unique<Passes>(device)),
      camera_view_(device, sizeof(ViewRecord), VK_BUFFER_USAGE_STORAGE_BUFFER_BIT, gpu::MemoryIntent::kDevice,
                   "camera"),
      seen_(makePixels(device, settings, kSeenFormat, VK_IMAGE_USAGE_COLOR_ATTACHMENT_BIT | VK_IMAGE_USAGE_SAMPLED_BIT,
                       "seen")),
      depth_(makePixels(device, settings, kDepthFormat, VK_IMAGE_USAGE_DEPTH_STENCIL_ATTACHMENT_BIT, "depth")),
      position_(makePixels(device, settings, kFloat4, VK_IMAGE_USAGE_STORAGE_BIT, "position")),
      surface_(makePixels(device, settings, VK_FORMAT_R32G32B32A32_UINT, VK_IMAGE_USAGE_STORAGE_BIT, "surface")),
      direct_(makePixels(device, settings, kFloat4, VK_IMAGE_USAGE_STORAGE_BIT, "direct")),
      emission_(makePixels(device, settings, kFloat4, VK_IMAGE_USAGE_STORAGE_BIT, "emission")),
      environment_sampler_(device, {.address_u = VK_SAMPLER_ADDRESS_MODE_REPEAT}, "environment") {
  light_grids_.resize(light_views_.count());
  recorder_.begin();
  buffers_ = std::make_unique<SceneBuffers>(device, recorder_, scene);
  uploadEnvironment();
  recorder_.submit();
  passes_->compileDirect(device, buffers_->inspectReceivers(settings.specular_alpha));
  reset();
}

RealtimeFrame::~RealtimeFrame() = default;

void RealtimeFrame::submitAndWait() {
  recorder_.submit();
  recorder_.wait();
  times_.insert(times_.end(), recorder_.passTimes().begin(), recorder_.passTimes().end());
}

void RealtimeFrame::uploadEnvironment() {
  const bool present = scene_.environment && scene_.environment->radiance;
  const Image* radiance = present ? scene_.environment->radiance.get() : nullptr;
  const gpu::ImageDesc desc{.format = kFloat4,
                            .width = static_cast<std::uint32_t>(present ? radiance->width : 1),
                            .height = static_cast<std::uint32_t>(present ? radiance->height : 1),
                            .usage = VK_IMAGE_USAGE_SAMPLED_BIT};
  environment_ = gpu::Image(device_, desc, "environment");
  std::vector<vec4> texels(static_cast<std::size_t>(desc.width) * desc.height, vec4(0.0F));
  for (std::uint32_t y = 0; present && y < desc.height; ++y)
    for (std::uint32_t x = 0; x < desc.width; ++x)
      texels[static_cast<std::size_t>(y) * desc.width + x] =
          vec4(radiance->rgb(static_cast<int>(x), static_cast<int>(y)), 1.0F);
  recorder_.upload(environment_, std::as_bytes(std::span(texels)));
}

void RealtimeFrame::reset() {
  recorder_.begin();
  recorder_.pass("clear", {Use(direct_, Access::kTransferWrite, true), Use(emission_, Access::kTransferWrite, true)},
                 [&](PassCommands& commands) {
                   commands.clear(direct_, {});
                   commands.clear(emission_, {});
                 });
  recorder_.submit();
  samples_ = 0;
}

void RealtimeFrame::render(std::uint32_t sample) {
  Sampler sampler(settings_.seed, kFilmStream, sample);
  // The first frame looks at the pixels' centres, as a single picture should.
  const vec2 film_offset = sample == 0 ? vec2(0.5F) : sampler.next2D();
  times_.clear();
  for (std::size_t i = 0; i < light_grids_.size(); ++i) prepareLight(i, sample);
  recorder_.begin();
  recordCamera(film_offset);
  for (const LightGrid& grid : light_grids_)
    if (grid.shines) recordLight(grid);
  recordEmission(film_offset);
  submitAndWait();
  ++samples_;
}

void RealtimeFrame::drawVisibility(const ViewRecord& view) {
  recorder_.pass("visibility",
                 {Use(buffers_->instances(), Access::kGraphicsRead), Use(camera_view_, Access::kGraphicsRead),
                  Use(buffers_->positions(), Access::kVertexFetch), Use(buffers_->indices(), Access::kVertexFetch),
                  Use(seen_, Access::kColorTarget, true), Use(depth_, Access::kDepthTarget, true)},
                 [&](PassCommands& commands) {
                   commands.beginRendering({.colors = {{.image = seen_}}, .depth = &depth_});
                   commands.bind(passes_->visibility);
                   commands.bindResources({Bound(0, buffers_->instances()), Bound(1, camera_view_)});
                   commands.bindVertexBuffer(buffers_->positions());
                   commands.bindIndexBuffer(buffers_->indices());
                   for (const SceneBuffers::Draw& draw : buffers_->draws())
                     if (mayShow(view, draw.bounds))
                       commands.drawIndexed(draw.index_count, draw.first_index, draw.vertex_offset, 1, draw.instance);
                   commands.endRendering();
                 });
}

void RealtimeFrame::recordCamera(vec2 film_offset) {
  const ViewRecord view = makeCameraView(camera_, settings_.width, settings_.height, bounds_, film_offset);
  recorder_.upload(camera_view_, std::as_bytes(std::span(&view, 1)));
  drawVisibility(view);

  std::vector<Use> uses = buffers_->uses(Access::kComputeRead);
  uses.insert(uses.end(), {Use(camera_view_, Access::kComputeRead), Use(seen_, Access::kComputeRead),
                           Use(position_, Access::kComputeWrite, true), Use(surface_, Access::kComputeWrite, true)});
  recorder_.pass("surface", uses, [&](PassCommands& commands) {
    commands.bind(passes_->surface);
    std::vector<Bound> bound = buffers_->bound();
    bound.insert(bound.end(),
                 {Bound(5, camera_view_), Bound(6, seen_, passes_->nearest), Bound(7, position_), Bound(8, surface_)});
    commands.bindResources(bound);
    commands.pushConstants(FilmPush{film_offset});
    commands.dispatch(gpu::groupsOf(seen_.desc().width, kGroup), gpu::groupsOf(seen_.desc().height, kGroup));
  });
}

void RealtimeFrame::prepareLight(std::size_t index, std::uint32_t sample) {
  LightGrid& grid = light_grids_[index];
  if (grid.built) return;
  const std::optional<LightView> view = light_views_.make(index, sample);
  grid.shines = view.has_value();
  if (!view) return;
  constexpr VkBufferUsageFlags kUsage = VK_BUFFER_USAGE_STORAGE_BUFFER_BIT;
  constexpr gpu::MemoryIntent kDevice = gpu::MemoryIntent::kDevice;
  if (!grid.light.valid()) {
    const VkDeviceSize count = view->light.view_count;
    const VkDeviceSize cells = count * settings_.shadow_size * settings_.shadow_size;
    grid.light = gpu::Buffer(device_, sizeof(LightRecord), kUsage, kDevice, "light");
    grid.views = gpu::Buffer(device_, count * sizeof(ViewRecord), kUsage, kDevice, "views of a light");
    grid.heads = gpu::Buffer(device_, (cells + 1) * sizeof(std::uint32_t), kUsage, kDevice, "heads of a light's grid");
    grid.counter = gpu::Buffer(device_, sizeof(std::uint32_t), kUsage, kDevice, "counter of a light's grid");
    // Small triangles lie in one cell or two of one view; if there are more, the first build tells.
    std::uint32_t triangles = 0;
    for (const SceneBuffers::Draw& draw : buffers_->draws()) triangles += draw.index_count / 3;
    const std::uint32_t most = device_.limits().maxStorageBufferRange / sizeof(GridNode);
    grid.node_capacity = std::min(3 * triangles + 1024, most);
  }
  for (;;) {
    if (!grid.nodes.valid())
      grid.nodes = gpu::Buffer(device_, grid.node_capacity * sizeof(GridNode), kUsage, kDevice, "a light's grid");
    buildGrid(grid, *view);
    const std::uint32_t nodes = gpu::readBackAs<std::uint32_t>(device_, grid.counter)[0];
    if (nodes <= grid.node_capacity) break;
    // As many again will do if the light stays, and nearly so many if it moves.
    const std::uint32_t most = device_.limits().maxStorageBufferRange / sizeof(GridNode);
    grid.node_capacity = std::max(nodes, std::min(nodes + nodes / 4, most));
    grid.nodes = gpu::Buffer();
  }
  grid.built = !view->varies;
}

void RealtimeFrame::buildGrid(LightGrid& grid, const LightView& view) {
  recorder_.begin();
  recorder_.upload(grid.light, std::as_bytes(std::span(&view.light, 1)));
  recorder_.upload(grid.views, std::as_bytes(std::span(view.views)));
  recorder_.pass("clear grid", {Use(grid.heads, Access::kTransferWrite), Use(grid.counter, Access::kTransferWrite)},
                 [&](PassCommands& commands) {
                   commands.fill(grid.heads, kNoNode);
                   commands.fill(grid.counter, 0);
                 });
  std::vector<Use> uses = buffers_->uses(Access::kComputeRead);
  uses.insert(uses.end(), {Use(grid.views, Access::kComputeRead), Use(grid.light, Access::kComputeRead),
                           Use(grid.heads, Access::kComputeWrite), Use(grid.nodes, Access::kComputeWrite),
                           Use(grid.counter, Access::kComputeWrite)});
  recorder_.pass("light grid", uses, [&](PassCommands& commands) {
    commands.bind(passes_->light_grid);
    std::vector<Bound> bound = buffers_->bound();
    bound.insert(bound.end(), {Bound(5, grid.views), Bound(6, grid.light), Bound(7, grid.heads), Bound(8, grid.nodes),
                               Bound(9, grid.counter)});
    commands.bindResources(bound);
    for (const SceneBuffers::Draw& draw : buffers_->draws()) {
      std::uint32_t view_mask = 0;
      for (std::size_t v = 0; v < view.views.size(); ++v)
        if (mayShow(view.views[v], draw.bounds)) view_mask |= 1U << v;
      if (view_mask == 0) continue;
      const std::uint32_t triangles = draw.index_count / 3;
      commands.pushConstants(GridPush{draw.instance, triangles, view_mask, grid.node_capacity});
      commands.dispatch(gpu::groupsOf(triangles, 64));
    }
  });
  submitAndWait();
}

void RealtimeFrame::recordLight(const LightGrid& grid) {
  std::vector<Use> uses = buffers_->uses(Access::kComputeRead);
  uses.insert(uses.end(), {Use(camera_view_, Access::kComputeRead), Use(grid.views, Access::kComputeRead),
                           Use(grid.light, Access::kComputeRead), Use(grid.heads, Access::kComputeRead),
                           Use(grid.nodes, Access::kComputeRead), Use(position_, Access::kComputeWrite),
                           Use(surface_, Access::kComputeWrite), Use(direct_, Access::kComputeWrite)});
  recorder_.pass("direct", uses, [&](PassCommands& commands) {
    commands.bind(passes_->direct);
    std::vector<Bound> bound = buffers_->bound();
    bound.insert(bound.end(), {Bound(5, camera_view_), Bound(6, grid.views), Bound(7, grid.light), Bound(8, grid.heads),
                               Bound(9, grid.nodes), Bound(10, position_), Bound(11, surface_), Bound(12, direct_)});
    commands.bindResources(bound);
    commands.pushConstants(settings_.specular_alpha);
    commands.dispatch(gpu::groupsOf(seen_.desc().width, kGroup), gpu::groupsOf(seen_.desc().height, kGroup));
  });
}

void RealtimeFrame::recordEmission(vec2 film_offset) {
  const bool present = scene_.environment && scene_.environment->radiance;
  const float rotation = present ? radians(scene_.environment->rotation_deg) : 0.0F;
  const EmissionPush push{film_offset, present ? scene_.environment->scale : 0.0F, std::cos(rotation),
                          std::sin(rotation)};
  std::vector<Use> uses = buffers_->uses(Access::kComputeRead);
  uses.insert(uses.end(), {Use(camera_view_, Access::kComputeRead), Use(environment_, Access::kComputeRead),
                           Use(position_, Access::kComputeWrite), Use(surface_, Access::kComputeWrite),
                           Use(emission_, Access::kComputeWrite)});
  recorder_.pass("emission", uses, [&](PassCommands& commands) {
    commands.bind(passes_->emission);
    std::vector<Bound> bound = buffers_->bound();
    bound.insert(bound.end(), {Bound(5, camera_view_), Bound(6, environment_, environment_sampler_),
                               Bound(7, position_), Bound(8, surface_), Bound(9, emission_)});
    commands.bindResources(bound);
    commands.pushConstants(push);
    commands.dispatch(gpu::groupsOf(seen_.desc().width, kGroup), gpu::groupsOf(seen_.desc().height, kGroup));
  });
}

namespace {

/// Some channels of four, times `scale`.
Image takeChannels(gpu::Device& device, const gpu::Image& source, int channels, float scale) {
  const std::vector<std::byte> bytes = gpu::readBack(device, source);
  std::vector<vec4> texels(bytes.size() / sizeof(vec4));
  std::memcpy(static_cast<void*>(texels.data()), bytes.data(), bytes.size());
  const int width = static_cast<int>(source.desc().width), height = static_cast<int>(source.desc().height);
  Image image(width, height, channels);
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x)
      for (int c = 0; c < channels; ++c) image.at(x, y)[c] = scale * texels[static_cast<std::size_t>(y) * width + x][c];
  return image;
}

}  // namespace

Image RealtimeFrame::readSummed(const std::string& layer) {
  const gpu::Image& sum = layer == "direct" ? direct_ : emission_;
  return takeChannels(device_, sum, 3, 1.0F / static_cast<float>(std::max(samples_, 1U)));
}

Image RealtimeFrame::readGeometry(const std::string& layer) {
  static constexpr std::array<const char*, 5> kNames{"albedo", "normal", "position", "depth", "id"};
  std::uint32_t kind = 0;
  while (kind < kNames.size() && layer != kNames[kind]) ++kind;
  if (kind == kNames.size()) throw InternalError(fmt::format("'{}' is no layer of the geometry", layer));
  const gpu::Image target = makePixels(device_, settings_, kFloat4, VK_IMAGE_USAGE_STORAGE_BIT, "layer");
  recorder_.begin();
  recordCamera(vec2(0.5F));
  std::vector<Use> uses = buffers_->uses(Access::kComputeRead);
  uses.insert(uses.end(), {Use(camera_view_, Access::kComputeRead), Use(position_, Access::kComputeWrite),
                           Use(surface_, Access::kComputeWrite), Use(target, Access::kComputeWrite, true)});
  recorder_.pass("geometry layer", uses, [&](PassCommands& commands) {
    commands.bind(passes_->geometry_layer);
    std::vector<Bound> bound = buffers_->bound();
    bound.insert(bound.end(), {Bound(5, camera_view_), Bound(6, position_), Bound(7, surface_), Bound(8, target)});
    commands.bindResources(bound);
    commands.pushConstants(kind);
    commands.dispatch(gpu::groupsOf(seen_.desc().width, kGroup), gpu::groupsOf(seen_.desc().height, kGroup));
  });
  recorder_.submit();
  return takeChannels(device_, target, kind >= 3 ? 1 : 3, 1.0F);
}

std::vector<std::string> describeFrameLimits(const SceneData& scene) {
  bool textures = false, colors = false, panes = false, cutouts = false;
  for (const Material& m : scene.materials) {
    for (const TextureRef* reference :
         {&m.base_color_texture, &m.metallic_roughness_texture, &m.normal_texture, &m.emission_texture,
          &m.transmission_texture, &m.specular_texture, &m.specular_color_texture})
      textures = textures || reference->valid();
    panes = panes || (m.transmits() && !m.isSolidDielectric());
    cutouts = cutouts || m.alpha_mode != AlphaMode::kOpaque;
  }
  for (const Mesh& mesh : scene.meshes) colors = colors || !mesh.colors.empty();
  std::vector<std::string> limits;
  if (textures) limits.emplace_back("textures are not sampled: materials have their factors alone");
  if (colors) limits.emplace_back("vertex colours are left out");
  if (panes) limits.emplace_back("panes are opaque: no light and no sight passes through them");
  if (cutouts) limits.emplace_back("masks and blending by alpha are left out: such surfaces are solid");
  for (const Light& light : scene.lights)
    if (light.radius > 0.0F || light.angle_deg > 0.0F) {
      limits.emplace_back("lamps and suns with a size light what they shine on, but are not seen themselves");
      break;
    }
  return limits;
}

}  // namespace nephroid
