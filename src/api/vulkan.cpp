#ifndef VK_NO_PROTOTYPES
#define VK_NO_PROTOTYPES
#endif
#include "nephroid/vulkan.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <set>

#include "api/scene_access.h"
#include "frame/frame.h"
#include "frame/mean_direction.h"
#include "gpu/device.h"
#include "gpu/device_list.h"
#include "gpu/requirements.h"
#include "scene/edit.h"
#include "techniques/layers.h"
#include "techniques/realtime/realtime_render.h"
#include "techniques/settings.h"
#include "techniques/technique.h"

namespace nephroid::vulkan {

// ------------------------------------------------------------------------------------------------ Requirements

struct Requirements::Impl {
  gpu::Features features;
};

Requirements::Requirements() : impl_(std::make_unique<Impl>()) { impl_->features.requireNeeded(); }
Requirements::~Requirements() = default;

VkPhysicalDeviceFeatures2* Requirements::features() { return impl_->features.chainWithoutExtensions(); }
std::vector<const char*> Requirements::extensions() const { return gpu::neededExtensions(); }

std::vector<std::string> Requirements::missing(PFN_vkGetInstanceProcAddr get, VkInstance instance,
                                               VkPhysicalDevice physical) const {
  return gpu::describeDevice(gpu::InstanceApi::load(get, instance), physical).missing;
}

// ------------------------------------------------------------------------------------------------ Renderer

namespace {

using gpu::Access;
using gpu::Use;

bool codesSrgb(VkFormat format) {
  switch (format) {
    case VK_FORMAT_R8G8B8A8_SRGB:
    case VK_FORMAT_B8G8R8A8_SRGB:
    case VK_FORMAT_A8B8G8R8_SRGB_PACK32:
    case VK_FORMAT_R8G8B8_SRGB:
    case VK_FORMAT_B8G8R8_SRGB:
      return true;
    default:
      return false;
  }
}

gpu::ForeignDevice checkDevice(const Device& d) {
  if (!d.get_instance_proc_addr || !d.instance || !d.physical || !d.device || !d.queue)
    throw UsageError("a Vulkan device needs vkGetInstanceProcAddr, instance, physical device, device and queue");
  const auto missing = Requirements().missing(d.get_instance_proc_addr, d.instance, d.physical);
  if (!missing.empty()) throw DeviceError(fmt::format("the Vulkan device lacks {}", fmt::join(missing, ", ")));
  return {d.get_instance_proc_addr, d.instance, d.physical, d.device, d.queue, d.queue_family, d.int64_atomics};
}

const Technique& checkTechnique(const std::string& name) {
  const Technique& technique = findTechnique(name);
  if (!technique.on_vulkan)
    throw UsageError(fmt::format("technique {} does not draw on a Vulkan device; use nephroid::render", name));
  return technique;
}

ParamSet makeParams(const Technique& technique, const RendererSettings& settings) {
  ParamSet params(technique.params);
  for (const auto& [key, value] : settings.parameters) params.set(key, value);
  return params;
}

vec3 toVec3(const std::array<float, 3>& v) { return {v[0], v[1], v[2]}; }

Camera makeCamera(const View& view) {
  const vec3 forward = toVec3(view.target) - toVec3(view.eye);
  const vec3 right = cross(forward, toVec3(view.up));
  const bool has_angle = view.vertical_fov_deg > 0.0F && view.vertical_fov_deg < 180.0F;
  if (!isFinite(forward) || !(dot(forward, forward) > 0.0F)) throw UsageError("a view's target is not its eye");
  if (!isFinite(right) || !(dot(right, right) > 0.0F)) throw UsageError("a view's up lies along its direction");
  if (!(view.orthographic_height >= 0.0F) || (view.orthographic_height == 0.0F && !has_angle))
    throw UsageError("a view has an angle between 0 and 180 degrees, or a height in metres");
  Camera camera;
  camera.name = "view";
  camera.eye = toVec3(view.eye);
  camera.forward = normalize(forward);
  camera.up = normalize(cross(right, forward));
  camera.fov_y = radians(view.vertical_fov_deg);
  camera.ortho_height = view.orthographic_height;
  return camera;
}

/// "beauty" and names → those that the frame sums.
std::vector<std::string> chooseLayers(const std::vector<std::string>& names) {
  std::set<std::string> chosen;
  for (const std::string& name : parseLayerList(fmt::format("{}", fmt::join(names, ",")))) {
    if (name != "beauty" && !findLayerInfo(name).summed)
      throw UsageError(fmt::format("'{}' is no part of beauty; a picture on a Vulkan device is a sum of such", name));
    if (name != "indirect") chosen.insert(name);
  }
  if (chosen.erase("beauty") > 0) return {"direct", "caustic", "specular", "emission"};
  return {chosen.begin(), chosen.end()};
}

/// Wraps an image of the caller.
gpu::Image wrap(gpu::Device& device, const Image& image, VkImageUsageFlags usage, const char* what) {
  if (!image.handle || image.width == 0 || image.height == 0 || image.format == VK_FORMAT_UNDEFINED)
    throw UsageError(fmt::format("{} needs an image, its format and its size", what));
  return {device,
          image.handle,
          {.format = image.format, .width = image.width, .height = image.height, .usage = usage},
          image.layout};
}

void checkTarget(const gpu::Device& device, const Image& target, const char* what) {
  if ((device.featuresOf(target.format) & VK_FORMAT_FEATURE_BLIT_DST_BIT) == 0)
    throw UsageError(
        fmt::format("{}: the device cannot blit to images of Vulkan format {}", what, static_cast<int>(target.format)));
  if (target.layout == VK_IMAGE_LAYOUT_UNDEFINED || target.layout == VK_IMAGE_LAYOUT_PREINITIALIZED)
    throw UsageError(fmt::format("{}: no image can be left in the layout UNDEFINED or PREINITIALIZED", what));
}

mat4 toMatrix(const std::array<float, 16>& columns) {
  mat4 m;
  std::memcpy(&m[0][0], columns.data(), sizeof(m));
  return m;
}

}  // namespace

struct Renderer::Impl {
  Impl(const Device& foreign, Scene& with, const RendererSettings& settings)
      : device(checkDevice(foreign)),
        technique(checkTechnique(settings.technique)),
        params(makeParams(technique, settings)),
        seed(foldSeed(settings.seed)),
        scene(SceneAccess::get(with)),
        recorder(device) {
    makeFrame();
  }

  void makeFrame() {
    scene.complete();
    if (!view) camera = selectCamera(scene.data, scene.camera_choice);
    FrameSettings settings = makeFrameSettings(params);
    settings.width = width, settings.height = height;
    settings.seed = seed;
    // Of the pictures that are asked for; irradiance does without.
    settings.specular = specular;
    frame = std::make_unique<RealtimeFrame>(device, scene.data, camera, settings, factoryOf(technique, params));
    light_count = scene.data.lights.size();
  }

  /// Copies to the caller's image, and gives it back.
  void deliver(const gpu::Image& from, const Image& to, const gpu::Image& target) {
    recorder.pass("deliver", {Use(from, Access::kTransferRead), Use(target, Access::kTransferWrite, true)},
                  [&](gpu::PassCommands& commands) { commands.blit(from, target); });
    recorder.handOver(target, to.layout);
  }

  void keepTimes() {
    times.clear();
    for (const gpu::PassTime& time : frame->passTimes()) times.push_back({time.name, time.ms});
  }

  gpu::Device device;
  const Technique& technique;
  ParamSet params;
  std::uint32_t seed;
  SceneAccess::SceneImpl& scene;
  gpu::CommandRecorder recorder;
  bool view = false;      ///< given by the caller
  bool specular = false;  ///< some picture showed it
  Camera camera;
  int width = 1, height = 1;
  std::unique_ptr<RealtimeFrame> frame;
  std::size_t light_count = 0;
  std::optional<IrradianceImages> irradiance;  ///< of the last size that was asked for
  std::optional<MeanDirection> mean_direction;
  std::uint32_t irradiance_sample = 0;
  std::vector<PassTime> times;
};

Renderer::Renderer(const Device& device, Scene& scene, const RendererSettings& settings)
    : impl_(std::make_unique<Impl>(device, scene, settings)) {}
Renderer::Renderer(Renderer&&) noexcept = default;
Renderer& Renderer::operator=(Renderer&&) noexcept = default;
Renderer::~Renderer() = default;

void Renderer::setView(const View& view) {
  impl_->camera = makeCamera(view);
  impl_->view = true;
  impl_->frame->setCamera(impl_->camera);
}

void Renderer::sceneChanged(Edit edit) {
  const std::size_t lights = impl_->scene.data.lights.size();
  if (edit == Edit::kAnything || lights != impl_->light_count) {
    impl_->makeFrame();
  } else if (edit == Edit::kObjects) {
    impl_->frame->objectsMoved();
  } else {
    for (std::size_t i = 0; i < lights; ++i) impl_->frame->lightChanged(i);
  }
}

void Renderer::drawPicture(const Image& target, const PictureSettings& settings) {
  Impl& i = *impl_;
  const std::vector<std::string> layers = chooseLayers(settings.layers);
  checkTarget(i.device, target, "the picture");
  const gpu::Image wrapped = wrap(i.device, target, VK_IMAGE_USAGE_TRANSFER_DST_BIT, "the picture");
  if (static_cast<int>(target.width) != i.width || static_cast<int>(target.height) != i.height) {
    i.width = static_cast<int>(target.width), i.height = static_cast<int>(target.height);
    i.frame->resize(i.width, i.height);
  }
  if (!i.specular && std::ranges::find(layers, "specular") != layers.end()) {
    i.specular = true;
    i.frame->addSpecular();
  }
  for (std::uint32_t s = 0; s < settings.samples; ++s) i.frame->render(i.frame->samples());
  i.keepTimes();
  std::optional<FrameDisplay> display;
  if (settings.for_screen)
    display = {.exposure_ev = settings.exposure_ev,
               .tone_map = settings.filmic ? ToneMap::kFilmic : ToneMap::kClamp,
               .coded = !codesSrgb(target.format)};
  const gpu::Image& picture = i.frame->compose(layers, display);
  i.recorder.begin();
  i.deliver(picture, target, wrapped);
  i.recorder.submit();
}

void Renderer::drawIrradiance(const Surfaces& surfaces, const Image& irradiance, const Image* mean_direction,
                              const IrradianceSettings& settings) {
  Impl& i = *impl_;
  const gpu::Image depth = wrap(i.device, surfaces.depth, VK_IMAGE_USAGE_SAMPLED_BIT, "the depth of surfaces");
  const gpu::Image normal = wrap(i.device, surfaces.normal, VK_IMAGE_USAGE_SAMPLED_BIT, "the normal of surfaces");
  std::vector<const Image*> targets{&irradiance};
  if (mean_direction) targets.push_back(mean_direction);
  targets.push_back(&surfaces.normal);
  for (const Image* image : targets)
    if (image->width != surfaces.depth.width || image->height != surfaces.depth.height)
      throw UsageError(fmt::format("images of {}x{} and {}x{}: irradiance is drawn on surfaces of the same size",
                                   image->width, image->height, surfaces.depth.width, surfaces.depth.height));
  targets.pop_back();
  for (const Image* target : targets) checkTarget(i.device, *target, "irradiance");
  if (settings.samples == 0) throw UsageError("irradiance takes at least one sample");
  // Everything that may be refused is, before anything is recorded.
  const gpu::Image to_irradiance = wrap(i.device, irradiance, VK_IMAGE_USAGE_TRANSFER_DST_BIT, "irradiance");
  std::optional<gpu::Image> to_direction;
  if (mean_direction)
    to_direction = wrap(i.device, *mean_direction, VK_IMAGE_USAGE_TRANSFER_DST_BIT, "the mean direction");
  const ForeignPicture picture{{toMatrix(surfaces.clip_from_world), surfaces.normals_are_coded}, depth, normal};
  static_cast<void>(makeForeignView(picture.view, surfaces.depth.format));
  if (!i.irradiance || i.irradiance->irradiance.desc().width != irradiance.width ||
      i.irradiance->irradiance.desc().height != irradiance.height)
    i.irradiance = makeIrradianceImages(i.device, irradiance.width, irradiance.height);

  i.recorder.begin();
  clearIrradiance(i.recorder, *i.irradiance);
  i.recorder.submit();
  const ForeignLight light{settings.direct, settings.caustic};
  const float weight = 1.0F / static_cast<float>(settings.samples);
  for (std::uint32_t s = 0; s < settings.samples; ++s)
    i.frame->lightForeign(picture, *i.irradiance, light, i.irradiance_sample++, weight);
  i.keepTimes();

  i.recorder.begin();
  i.deliver(i.irradiance->irradiance, irradiance, to_irradiance);
  if (mean_direction) {
    if (!i.mean_direction) i.mean_direction.emplace(i.device);
    i.mean_direction->record(i.recorder, i.irradiance->direction);
    i.deliver(i.irradiance->direction, *mean_direction, *to_direction);
  }
  i.recorder.handOver(depth, surfaces.depth.layout);
  i.recorder.handOver(normal, surfaces.normal.layout);
  i.recorder.submit();
}

std::vector<PassTime> Renderer::passTimes() const { return impl_->times; }

}  // namespace nephroid::vulkan
