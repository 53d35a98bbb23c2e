#include "frame/frame.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>

#include "core/optics/surface.shared.h"
#include "core/sampling/sampler.h"
#include "frame/lamps.h"
#include "frame/passes.h"
#include "frame/table.h"
#include "frame/view.h"
#include "nephroid/error.h"
#include "shaders/frame/geometry_layer.comp.h"
#include "shaders/frame/passable_seen.frag.h"
#include "shaders/frame/tint.frag.h"
#include "shaders/frame/visibility.frag.h"
#include "shaders/frame/visibility.vert.h"

namespace nephroid {
namespace {

constexpr VkFormat kSeenFormat = VK_FORMAT_R32G32_UINT;
constexpr VkFormat kDepthFormat = VK_FORMAT_D32_SFLOAT;
/// Stream of the sampler that places samples in pixels; the same place in all pixels of a frame.
constexpr std::uint32_t kFilmStream = 0x0F110000U;

gpu::Image makePixels(gpu::Device& device, const FrameSettings& settings, VkFormat format, VkImageUsageFlags usage,
                      const char* name) {
  return gpu::Image(device,
                    {.format = format,
                     .width = static_cast<std::uint32_t>(settings.width),
                     .height = static_cast<std::uint32_t>(settings.height),
                     .usage = usage},
                    name);
}

std::vector<gpu::Constant> join(std::vector<gpu::Constant> first, const std::vector<gpu::Constant>& second) {
  first.insert(first.end(), second.begin(), second.end());
  return first;
}

}  // namespace

/// Pushed by passable_seen.frag and tint.frag.
struct RealtimeFrame::PassablePush {
  vec2 film_offset, size;
  std::uint32_t frame, geometry_only;
};

/// What is compiled, once the scene is known.
struct RealtimeFrame::Passes {
  Passes(gpu::Device& device, const SceneTraits& traits)
      : visibility(draw(device, traits, shaders::visibility_frag, {.format = kSeenFormat}, true, "visibility")),
        geometry_layer(device,
                       {.shader = shaders::geometry_layer_comp,
                        .bindings = SceneBuffers::bindings({kUniforms, kStorage, kStorage}),
                        .push_bytes = sizeof(std::uint32_t),
                        .constants = traits.constants()},
                       "geometry layer") {
    if (!traits.passable) return;
    passable = draw(device, traits, shaders::passable_seen_frag, {.format = kSeenFormat}, true, "passable surfaces");
    tint = draw(device, traits, shaders::tint_frag, {.format = kFloat4, .blend = gpu::Blend::kMultiply}, false, "tint");
  }

  static gpu::GraphicsPipeline draw(gpu::Device& device, const SceneTraits& traits, gpu::Spirv fragment,
                                    gpu::ColorTarget target, bool write_depth, const char* name) {
    return {device,
            {.vertex = shaders::visibility_vert,
             .fragment = fragment,
             .bindings = SceneBuffers::bindings({kTable}),
             .push_bytes = sizeof(PassablePush),
             .constants = traits.constants(),
             .vertex_buffers = {{0, sizeof(vec3), VK_VERTEX_INPUT_RATE_VERTEX}},
             .attributes = {{0, 0, VK_FORMAT_R32G32B32_SFLOAT, 0}},
             .colors = {target},
             .depth = kDepthFormat,
             .depth_write = write_depth},
            name};
  }

  gpu::GraphicsPipeline visibility, passable, tint;
  gpu::ComputePipeline geometry_layer;
};

RealtimeFrame::RealtimeFrame(gpu::Device& device, const SceneData& scene, const Camera& camera,
                             const FrameSettings& settings, const MakeRealtimeTechnique& make_technique)
    : device_(device),
      scene_(scene),
      camera_(camera),
      settings_(settings),
      bounds_(scene.bounds()),
      recorder_(device),
      camera_view_(makeUniforms<ViewRecord>(device, kMostViews, "camera")),
      nothing_(device, {.format = kFloat4, .usage = VK_IMAGE_USAGE_SAMPLED_BIT}, "nothing"),
      environment_sampler_(device, {.address_u = VK_SAMPLER_ADDRESS_MODE_REPEAT}, "environment") {
  recorder_.begin();
  buffers_ = std::make_unique<SceneBuffers>(device, recorder_, scene, settings.specular_alpha);
  uploadEnvironment();
  uploadLamps();
  makeTargets();
  recorder_.submit();
  light_grids_ = std::make_unique<LightGrids>(device, scene, *buffers_, settings.shadow_size, settings.seed);
  makePasses();
  if (make_technique) makeTechnique(make_technique);
  if (settings.specular) makeSpecular();
  makeCaustic();
  reset();
}

RealtimeFrame::~RealtimeFrame() = default;

void RealtimeFrame::makeTargets() {
  constexpr VkImageUsageFlags kDrawn = VK_IMAGE_USAGE_COLOR_ATTACHMENT_BIT | VK_IMAGE_USAGE_SAMPLED_BIT;
  seen_ = makePixels(device_, settings_, kSeenFormat, kDrawn | VK_IMAGE_USAGE_STORAGE_BIT, "seen");
  depth_ = makePixels(device_, settings_, kDepthFormat,
                      VK_IMAGE_USAGE_DEPTH_STENCIL_ATTACHMENT_BIT | VK_IMAGE_USAGE_SAMPLED_BIT, "depth");
  raster_.reset();
  if (chooseRasteriser(settings_.rasteriser, device_, *buffers_, settings_.width, settings_.height) !=
      Rasteriser::kHardware)
    raster_ = std::make_unique<ComputeRaster>(device_, recorder_, *buffers_, settings_.width, settings_.height);
  if (buffers_->traits().passable) {
    tint_ = makePixels(device_, settings_, kFloat4, kDrawn, "tint");
  } else if (!tint_.valid()) {
    // Something has to be bound.
    tint_ = gpu::Image(device_, {.format = kFloat4, .usage = VK_IMAGE_USAGE_SAMPLED_BIT}, "no tint");
    const vec4 white(1.0F);
    recorder_.upload(tint_, std::as_bytes(std::span(&white, 1)));
  }
}

std::vector<gpu::Constant> RealtimeFrame::lightConstants() const {
  const bool has_environment = scene_.environment && scene_.environment->radiance;
  const bool emits = std::ranges::any_of(scene_.materials, [](const Material& m) { return m.emits(); });
  return join({{5, has_environment}, {6, lamps_compiled_}, {7, emits}}, lights_compiled_.constants());
}

ShadingInputs RealtimeFrame::shadingInputs() const {
  return {camera_view_, seen_, tint_, lamps_, environment_, environment_sampler_, *light_grids_};
}

void RealtimeFrame::makeTechnique(const MakeRealtimeTechnique& make) {
  RealtimeInputs inputs{device_, scene_, *buffers_, *light_grids_, settings_.specular_alpha, settings_.seed, {}};
  if (settings_.box_tree_builder) inputs.tree = [this]() -> const TriangleTree& { return triangleTree(); };
  technique_ = make(inputs);
}

const TriangleTree& RealtimeFrame::triangleTree() {
  if (tree_) return *tree_;
  recorder_.begin();
  tree_ = std::make_unique<TriangleTree>(device_, recorder_, scene_, settings_.box_tree_builder);
  recorder_.submit();
  return *tree_;
}

void RealtimeFrame::makeSpecular() {
  specular_.reset();
  if (!settings_.box_tree_builder || !buffers_->traits().specular.present) return;
  const SpecularPass::Inputs inputs{shadingInputs(), triangleTree(),
                                    technique_ ? technique_->lightReceivers() : nullptr};
  recorder_.begin();
  specular_ = std::make_unique<SpecularPass>(
      device_, recorder_, *buffers_, inputs, lightConstants(),
      SpecularPass::Following{.max_events = settings_.max_events, .spacing = specularSpacing()});
  recorder_.submit();
}

std::uint32_t RealtimeFrame::specularSpacing() const {
  // What chance decides in each pixel, and small bright lamps, do not lie between the pixels beside.
  const SceneTraits& traits = buffers_->traits();
  const bool varies = traits.passable || traits.specular.rough || traits.specular.disperses || lamps_compiled_;
  return varies ? 1 : settings_.specular_spacing;
}

void RealtimeFrame::makeCaustic() {
  if (!technique_) return;
  const CausticPass::Inputs inputs{camera_view_, seen_, tint_};
  caustic_ = std::make_unique<CausticPass>(device_, *buffers_, inputs, settings_.specular_alpha);
}

void RealtimeFrame::makePasses() {
  lamps_compiled_ = lamp_count_ > 0;
  lights_compiled_ = light_grids_->traits();
  if (!passes_) passes_ = std::make_unique<Passes>(device_, buffers_->traits());
  shade_ = std::make_unique<ShadePass>(device_, *buffers_, shadingInputs(), lightConstants(), settings_.shading);
}

bool RealtimeFrame::lightsAreCompiled() const {
  return (lamps_compiled_ || lamp_count_ == 0) && lights_compiled_.cover(light_grids_->traits());
}

void RealtimeFrame::uploadLamps() {
  const std::vector<LampRecord> lamps = makeLamps(scene_);
  lamp_count_ = static_cast<std::uint32_t>(lamps.size());
  lamps_ = makeTable<LampRecord>(device_, recorder_, lamps, "lamps");
}

void RealtimeFrame::addSpecular() {
  if (settings_.specular) return;
  settings_.specular = true;
  makeSpecular();
  reset();
}

void RealtimeFrame::setCamera(const Camera& camera) {
  camera_ = camera;
  reset();
}

void RealtimeFrame::resize(int width, int height) {
  settings_.width = width, settings_.height = height;
  recorder_.begin();
  makeTargets();
  recorder_.submit();
  // What is compiled stays.
  shade_->fitPicture(device_);
  if (specular_) specular_->fitPicture(device_);
  if (caustic_) caustic_->fitPicture(device_);
  if (display_) display_->resize(device_, seen_.desc().width, seen_.desc().height);
  reset();
}

void RealtimeFrame::lightChanged(std::size_t index) {
  light_grids_->lightChanged(index);
  if (technique_) technique_->lightChanged(index);
  recorder_.begin();
  uploadLamps();
  recorder_.submit();
  if (!lightsAreCompiled()) {
    makePasses();
    if (specular_) makeSpecular();
  }
  reset();
}

void RealtimeFrame::objectsMoved() {
  bounds_ = scene_.bounds();
  recorder_.begin();
  buffers_->updateInstances(device_, recorder_, scene_);
  recorder_.submit();
  light_grids_->geometryChanged();
  const bool makes_specular = specular_ != nullptr;
  specular_.reset();
  tree_.reset();
  if (technique_) technique_->objectsMoved();
  if (!lightsAreCompiled()) makePasses();
  if (makes_specular) makeSpecular();
  reset();
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
  std::vector<Use> uses;
  for (const gpu::Image* sum : sums()) uses.emplace_back(*sum, Access::kTransferWrite, true);
  recorder_.pass("clear", uses, [&](PassCommands& commands) {
    for (const gpu::Image* sum : sums()) commands.clear(*sum, {});
  });
  recorder_.submit();
  samples_ = 0;
}

void RealtimeFrame::render(std::uint32_t sample) {
  Sampler sampler(settings_.seed, kFilmStream, sample);
  // The first frame looks at the pixels' centres, as a single picture should.
  const vec2 film_offset = sample == 0 ? vec2(0.5F) : sampler.next2D();
  times_.clear();
  light_grids_->update(recorder_, sample, times_);
  recorder_.begin();
  recordVisibility(film_offset, sample, false);
  if (buffers_->traits().passable) recordTint(film_offset, sample);
  const SamplePush push = samplePush(film_offset, sample);
  shade_->record(recorder_, push);
  // First: mirrors and glass show it.
  if (technique_) recordCaustic(sample);
  if (specular_) specular_->record(recorder_, push);
  recorder_.submit();
  recorder_.wait();
  times_.insert(times_.end(), recorder_.passTimes().begin(), recorder_.passTimes().end());
  ++samples_;
}

void RealtimeFrame::drawScene(PassCommands& commands, const std::vector<std::size_t>& draws) {
  commands.bindResources(buffers_->bound({Bound(7, camera_view_)}));
  commands.bindVertexBuffer(buffers_->positions());
  commands.bindIndexBuffer(buffers_->indices());
  for (const std::size_t i : draws) {
    const SceneBuffers::Draw& draw = buffers_->draws()[i];
    commands.drawIndexed(draw.index_count, draw.first_index, draw.vertex_offset, 1, draw.instance);
  }
}

std::vector<Use> RealtimeFrame::drawUses(std::initializer_list<Use> targets) const {
  std::vector<Use> uses = buffers_->uses(Access::kGraphicsRead, {Use(camera_view_, Access::kGraphicsRead),
                                                                 Use(buffers_->positions(), Access::kVertexFetch),
                                                                 Use(buffers_->indices(), Access::kVertexFetch)});
  uses.insert(uses.end(), targets);
  return uses;
}

void RealtimeFrame::recordVisibility(vec2 film_offset, std::uint32_t frame, bool geometry_only) {
  view_ = makeCameraView(camera_, settings_.width, settings_.height, bounds_, film_offset);
  recorder_.upload(camera_view_, std::as_bytes(std::span(&view_, 1)));
  split_ = splitDraws(view_, buffers_->draws(), seen_.desc().width * seen_.desc().height,
                      raster_ ? settings_.rasteriser : Rasteriser::kHardware);
  recorder_.pass("visibility",
                 drawUses({Use(seen_, Access::kColorTarget, true), Use(depth_, Access::kDepthTarget, true)}),
                 [&](PassCommands& commands) {
                   commands.beginRendering({.colors = {{.image = seen_}}, .depth = &depth_});
                   commands.bind(passes_->visibility);
                   drawScene(commands, split_.hardware);
                   if (buffers_->traits().passable) {
                     commands.bind(passes_->passable);
                     commands.pushConstants(passablePush(film_offset, frame, geometry_only));
                     drawScene(commands, split_.passable);
                   }
                   commands.endRendering();
                 });
  if (!split_.compute.empty()) raster_->record(recorder_, view_, split_.compute, seen_, depth_);
}

RealtimeFrame::PassablePush RealtimeFrame::passablePush(vec2 film_offset, std::uint32_t frame,
                                                        bool geometry_only) const {
  return {film_offset, vec2(static_cast<float>(settings_.width), static_cast<float>(settings_.height)), frame,
          geometry_only ? 1U : 0U};
}

void RealtimeFrame::recordTint(vec2 film_offset, std::uint32_t frame) {
  recorder_.pass(
      "tint", drawUses({Use(tint_, Access::kColorTarget, true), Use(depth_, Access::kDepthTarget)}),
      [&](PassCommands& commands) {
        commands.beginRendering(
            {.colors = {{.image = tint_, .value = {.float32 = {1, 1, 1, 1}}}}, .depth = &depth_, .clear_depth = false});
        commands.bind(passes_->tint);
        commands.pushConstants(passablePush(film_offset, frame, false));
        drawScene(commands, split_.passable);
        commands.endRendering();
      });
}

SamplePush RealtimeFrame::samplePush(vec2 film_offset, std::uint32_t frame) const {
  const bool present = scene_.environment && scene_.environment->radiance;
  const float rotation = present ? radians(scene_.environment->rotation_deg) : 0.0F;
  return {.film_offset = film_offset,
          .frame = frame,
          .light_count = light_grids_->lightCount(),
          .lamp_count = lamp_count_,
          .specular_alpha = settings_.specular_alpha,
          .environment_scale = present ? scene_.environment->scale : 0.0F,
          .cos_rotation = std::cos(rotation),
          .sin_rotation = std::sin(rotation)};
}

void RealtimeFrame::recordCaustic(std::uint32_t frame) {
  clearIrradiance(recorder_, caustic_->target());
  const PixelSurfaces surfaces = PixelSurfaces::ofFrame(camera_view_, seen_, nothing_, buffers_->sampler());
  technique_->record(recorder_, {surfaces, caustic_->target(), frame, 1.0F});
  caustic_->record(recorder_, frame);
}

const gpu::Image* RealtimeFrame::sumOf(const std::string& layer) const {
  if (layer == "direct") return &shade_->direct();
  if (layer == "emission") return &shade_->emission();
  if (layer == "specular") return specular_ ? &specular_->sum() : nullptr;
  if (layer == "specular_caustic") return specular_ ? specular_->causticSum() : nullptr;
  if (layer == "caustic") return caustic_ ? &caustic_->radianceSum() : nullptr;
  if (layer == "irradiance_caustic") return caustic_ ? &caustic_->irradianceSum() : nullptr;
  throw InternalError(fmt::format("'{}' is no layer that the frame sums", layer));
}

std::vector<const gpu::Image*> RealtimeFrame::sums() const {
  std::vector<const gpu::Image*> images;
  for (const char* layer : {"direct", "emission", "specular", "specular_caustic", "caustic", "irradiance_caustic"})
    if (const gpu::Image* sum = sumOf(layer)) images.push_back(sum);
  return images;
}

const gpu::Image& RealtimeFrame::compose(std::span<const std::string> layers,
                                         const std::optional<FrameDisplay>& display) {
  if (!display_) display_ = std::make_unique<DisplayPass>(device_, seen_.desc().width, seen_.desc().height);
  std::vector<const gpu::Image*> images;
  for (const std::string& layer : layers)
    if (const gpu::Image* sum = sumOf(layer)) images.push_back(sum);
  // Of layers that are not made, the sum is black.
  const float weight = images.empty() ? 0.0F : 1.0F / static_cast<float>(std::max(samples_, 1U));
  if (images.empty()) images.push_back(&shade_->direct());
  recorder_.begin();
  display_->record(recorder_, images, weight, display);
  recorder_.submit();
  return display_->picture();
}

void RealtimeFrame::lightForeign(const ForeignPicture& picture, const IrradianceImages& target,
                                 const ForeignLight& light, std::uint32_t sample, float weight) {
  if (!foreign_) foreign_ = std::make_unique<ForeignLighting>(device_, *buffers_, *light_grids_);
  // Refused before anything is recorded.
  const ForeignViewRecord view = makeForeignView(picture.view, picture.depth.desc().format);
  times_.clear();
  light_grids_->update(recorder_, sample, times_);
  recorder_.begin();
  foreign_->record(recorder_, picture, view, target, light, light.caustic ? technique_.get() : nullptr, sample, weight);
  recorder_.submit();
  recorder_.wait();
  times_.insert(times_.end(), recorder_.passTimes().begin(), recorder_.passTimes().end());
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
  const gpu::Image* sum = sumOf(layer);
  if (!sum) return {settings_.width, settings_.height, 3};
  return takeChannels(device_, *sum, 3, 1.0F / static_cast<float>(std::max(samples_, 1U)));
}

Image RealtimeFrame::readGeometry(const std::string& layer) {
  static constexpr std::array<const char*, 5> kNames{"albedo", "normal", "position", "depth", "id"};
  std::uint32_t kind = 0;
  while (kind < kNames.size() && layer != kNames[kind]) ++kind;
  if (kind == kNames.size()) throw InternalError(fmt::format("'{}' is no layer of the geometry", layer));
  const gpu::Image target = makePixels(device_, settings_, kFloat4, VK_IMAGE_USAGE_STORAGE_BIT, "layer");
  recorder_.begin();
  recordVisibility(vec2(0.5F), 0, true);
  const std::vector<Use> uses =
      buffers_->uses(Access::kComputeRead, {Use(camera_view_, Access::kComputeRead), Use(seen_, Access::kStorageRead),
                                            Use(target, Access::kComputeWrite, true)});
  recorder_.pass("geometry layer", uses, [&](PassCommands& commands) {
    commands.bind(passes_->geometry_layer);
    commands.bindResources(buffers_->bound({Bound(7, camera_view_), Bound(8, seen_), Bound(9, target)}));
    commands.pushConstants(kind);
    commands.dispatch(gpu::groupsOf(seen_.desc().width, kPixelGroup), gpu::groupsOf(seen_.desc().height, kPixelGroup));
  });
  recorder_.submit();
  return takeChannels(device_, target, kind >= 3 ? 1 : 3, 1.0F);
}

std::vector<std::string> describeFrameLimits(const SceneData& scene, const FrameSettings& settings,
                                             bool lights_receivers) {
  bool rough_panes = false, panes = false, spheres = false, rough = false, solids = false, specular = false;
  for (const Material& m : scene.materials) {
    specular = specular || isSpecular(m, settings.specular_alpha);
    const bool pane = m.transmits() && !m.isSolidDielectric();
    panes = panes || pane || m.alpha_mode == AlphaMode::kBlend;
    solids = solids || m.isSolidDielectric();
    rough = rough || (m.isSolidDielectric() && m.roughness * m.roughness >= settings.specular_alpha);
    rough_panes = rough_panes || (pane && m.roughness * m.roughness >= kDeltaAlpha);
  }
  for (const Light& light : scene.lights) spheres = spheres || (light.kind != LightKind::kSun && light.radius > 0.0F);
  std::vector<std::string> limits;
  if (rough_panes) limits.emplace_back("rough panes are opaque: no light and no sight passes through them");
  if (panes && spheres)
    limits.emplace_back("a lamp before a pane has the tint of what is seen through the pane behind it");
  if (settings.specular && specular && !settings.box_tree_builder)
    limits.emplace_back("specular is black: there is no builder of the tree in which it finds what rays meet");
  if (solids)
    limits.emplace_back(fmt::format("specular has no {}indirect light on what is seen, and no medium around the camera",
                                    lights_receivers ? "" : "caustics and no "));
  if (rough) limits.emplace_back("glass of specular-alpha and above shows nothing of what is behind it");
  return limits;
}

}  // namespace nephroid
