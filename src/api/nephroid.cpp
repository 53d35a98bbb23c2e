#include "nephroid/nephroid.h"

#include <fmt/format.h>

#include <optional>

#include "api/display.h"
#include "api/scene_access.h"
#include "core/image/image_io.h"
#include "scene/builtin/builtin.h"
#include "scene/edit.h"
#include "scene/load.h"
#include "scene/report.h"
#include "techniques/layers.h"
#include "techniques/technique.h"

namespace nephroid {

void Scene::Impl::complete() {
  if (completed) return;
  const FloorMode mode = floor == Floor::kOn    ? FloorMode::kOn
                         : floor == Floor::kOff ? FloorMode::kOff
                                                : FloorMode::kAuto;
  completeScene(data, mode);
  completed = true;
}

struct Picture::Impl {
  RenderResult result;
};

Picture SceneAccess::makePicture(RenderResult result) {
  return Picture(std::make_unique<Picture::Impl>(Picture::Impl{std::move(result)}));
}

namespace {

constexpr int kMaxSide = 16384;

/// Hands progress to the caller and his wish to stop to the work.
class CallbackSink : public ProgressSink {
 public:
  CallbackSink(const RenderRequest& request, StopToken& stop) : request_(request), stop_(stop) {}
  void update(double fraction, const std::string& status) override {
    if (request_.on_progress && !request_.on_progress(fraction, status)) stop_.request();
  }

 private:
  const RenderRequest& request_;
  StopToken& stop_;
};

std::string joinNames(const std::vector<std::string>& names) { return fmt::format("{}", fmt::join(names, ",")); }

/// Everything but the technique's parameters.
RenderSettings makeSettings(const RenderRequest& request) {
  if (request.width < 1 || request.height < 1 || request.width > kMaxSide || request.height > kMaxSide)
    throw UsageError(
        fmt::format("size {}x{} is out of range; each side is 1 to {} px", request.width, request.height, kMaxSide));
  RenderSettings settings;
  settings.width = request.width;
  settings.height = request.height;
  settings.layers = parseLayerList(joinNames(request.layers));
  settings.photons = request.photons;
  settings.samples = request.samples;
  settings.seconds = request.seconds;
  settings.target_error = request.target_error;
  settings.checkpoint = {request.checkpoint, request.checkpoint_interval_s};
  settings.seed = request.seed;
  settings.threads = request.threads;
  settings.device = request.device;
  if (!(request.target_error >= 0.0)) throw UsageError("target_error is below 0; 0 is none");
  return settings;
}

}  // namespace

std::string_view version() { return NEPHROID_VERSION; }

std::vector<std::string> builtinSceneNames() {
  std::vector<std::string> names;
  for (const BuiltinScene& scene : builtinScenes()) names.push_back(scene.name);
  return names;
}

std::vector<std::string> techniqueNames() {
  std::vector<std::string> names;
  for (const Technique& technique : techniques()) names.push_back(technique.name);
  return names;
}

std::vector<std::string> layerNames() {
  std::vector<std::string> names;
  for (const LayerInfo& layer : layerInfos()) names.emplace_back(layer.name);
  return names;
}

Scene::Scene(std::unique_ptr<Impl> impl) : impl_(std::move(impl)) {}
Scene::Scene(Scene&&) noexcept = default;
Scene& Scene::operator=(Scene&&) noexcept = default;
Scene::~Scene() = default;

Scene Scene::load(std::string_view source, const LoadSettings& settings) {
  auto impl = std::make_unique<Impl>();
  impl->data = loadScene(source, {.time = settings.time});
  impl->floor = settings.floor;
  return Scene(std::move(impl));
}

void Scene::editMaterial(std::string_view edit) { applyMaterialEdit(impl_->data, edit); }
void Scene::editObject(std::string_view edit) { applyObjectEdit(impl_->data, edit); }
void Scene::editLight(std::string_view edit) { applyLightEdit(impl_->data, edit); }
void Scene::setCamera(std::string_view choice) { impl_->camera_choice = choice; }

void Scene::setEnvironment(std::string_view source, float rotation_deg, float scale) {
  impl_->data.environment = loadEnvironment(source, rotation_deg, scale);
}

std::vector<std::string> Scene::warnings() const { return impl_->data.warnings; }
std::string Scene::describe() const { return formatReport(impl_->data, inspectScene(impl_->data)); }

Picture::Picture(std::unique_ptr<Impl> impl) : impl_(std::move(impl)) {}
Picture::Picture(Picture&&) noexcept = default;
Picture& Picture::operator=(Picture&&) noexcept = default;
Picture::~Picture() = default;

std::vector<std::string> Picture::layerNames() const {
  std::vector<std::string> names;
  for (const Layer& layer : impl_->result.image.layers) names.push_back(layer.name);
  return names;
}

LayerView Picture::layer(std::string_view name) const {
  const Image* image = impl_->result.image.find(name);
  if (image == nullptr)
    throw UsageError(fmt::format("the picture has no layer '{}'; it has {}", name, joinNames(layerNames())));
  return {image->pixels, image->width, image->height, image->channels};
}

std::string Picture::metadata(std::string_view key) const {
  const auto found = impl_->result.image.metadata.find(std::string(key));
  return found == impl_->result.image.metadata.end() ? "" : found->second;
}

std::vector<std::string> Picture::notes() const { return impl_->result.notes; }
std::string Picture::ledger() const {
  return impl_->result.ledgers.empty() ? "" : formatLedgers(impl_->result.ledgers);
}
bool Picture::interrupted() const { return impl_->result.interrupted; }

void Picture::writeExr(const std::string& path, bool half) const {
  nephroid::writeExr(path, impl_->result.image, half);
}

void Picture::writePng(const std::string& path, std::string_view layer, const PngSettings& settings) const {
  DisplayOptions display;
  display.tone_map = settings.filmic ? ToneMap::kFilmic : ToneMap::kClamp;
  if (!settings.auto_exposure) display.exposure_ev = settings.exposure_ev;
  nephroid::writePng(path, displayLayer(impl_->result.image, layer, display), impl_->result.image.metadata);
}

Picture render(Scene& scene, const RenderRequest& request) {
  auto& impl = SceneAccess::get(scene);
  RenderSettings settings = makeSettings(request);
  const Technique& technique = chooseTechnique(request.technique, settings);
  checkProgressive(technique, settings);
  settings.params = ParamSet(technique.params);
  for (const auto& [key, value] : request.parameters) settings.params.set(key, value);
  impl.complete();
  const Camera camera = selectCamera(impl.data, impl.camera_choice);
  StopToken stop;
  CallbackSink sink(request, stop);
  RenderResult result = technique.render(impl.data, camera, settings, &sink, &stop);
  if (!result.checkpoint_failure.empty()) result.notes.push_back(result.checkpoint_failure);
  result.image.metadata.emplace("scene", impl.data.name);
  result.image.metadata.emplace("version", version());
  return SceneAccess::makePicture(std::move(result));
}

}  // namespace nephroid
