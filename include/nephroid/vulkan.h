// Nephroid on your own Vulkan device: it draws with your queue, from your images, into your images.
//
// Two ways to use it. `drawPicture` draws the scene, as `nephroid::render` does with a real-time technique. With
// `drawIrradiance` you draw the scene yourself; you hand over your depths and normals and get back, by pixel, how much
// light falls there, which your own shaders then multiply by their albedo / π.
//
// Every call submits to your queue and gives your images back in the layout that you named. What you submit to that
// queue later runs after it and sees what it wrote; no semaphore is needed. Calls may wait for the device.
#pragma once

#include <vulkan/vulkan_core.h>

#include <array>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "nephroid/nephroid.h"

namespace nephroid::vulkan {

/// What your device must have been made with, besides API version 1.3.
///
/// Ask for it when you make the device: `features()` goes into VkDeviceCreateInfo::pNext (pEnabledFeatures null),
/// `extensions()` into ppEnabledExtensionNames. Or enable the same among your own; `missing` tells what a device lacks.
class Requirements {
 public:
  Requirements();
  ~Requirements();
  Requirements(const Requirements&) = delete;
  Requirements& operator=(const Requirements&) = delete;

  /// With what is chained to it; valid as long as this. Bits may be set in it.
  VkPhysicalDeviceFeatures2* features();
  std::vector<const char*> extensions() const;
  /// Names of what a physical device has not; empty: it will do.
  std::vector<std::string> missing(PFN_vkGetInstanceProcAddr get, VkInstance instance, VkPhysicalDevice physical) const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

/// Yours, and outlives every Renderer. The queue does graphics and compute, and is left alone while a call submits.
struct Device {
  PFN_vkGetInstanceProcAddr get_instance_proc_addr = nullptr;
  VkInstance instance = VK_NULL_HANDLE;
  VkPhysicalDevice physical = VK_NULL_HANDLE;
  VkDevice device = VK_NULL_HANDLE;
  VkQueue queue = VK_NULL_HANDLE;
  std::uint32_t queue_family = 0;
  /// Made with the features shaderInt64 and shaderBufferInt64Atomics: a device that is a CPU then draws fine meshes
  /// faster. Others do not need it.
  bool int64_atomics = false;
};

/// Two-dimensional, one layer, one mip, one sample, exclusive to the queue's family. Not owned; must live until the
/// device is done with what was submitted.
struct Image {
  VkImage handle = VK_NULL_HANDLE;
  VkFormat format = VK_FORMAT_UNDEFINED;
  std::uint32_t width = 0, height = 0;
  /// Of what is read: that it is in, and is left in. Of what is drawn to: that it is left in; what was there is lost.
  VkImageLayout layout = VK_IMAGE_LAYOUT_GENERAL;
};

/// Where the picture is taken from.
struct View {
  std::array<float, 3> eye{0, 0, 5}, target{0, 0, 0}, up{0, 1, 0};  ///< world, m
  float vertical_fov_deg = 45.0F;                                   ///< of perspective pictures, in (0, 180)
  float orthographic_height = 0.0F;                                 ///< m; 0: perspective
};

/// How a picture is drawn.
struct PictureSettings {
  /// Of layerNames(): those that are summed. What the technique does not make is black.
  std::vector<std::string> layers{"beauty"};
  /// Added by this call to those since the last change; the picture is the mean of all. One is a real-time frame.
  std::uint32_t samples = 1;
  /// For a screen: exposed, tone-mapped and coded as sRGB (by the format, if it is one that codes). Else radiance in
  /// W/m²/sr, for images of floats.
  bool for_screen = true;
  std::optional<float> exposure_ev;  ///< radiance is multiplied by 2^exposure_ev; empty: automatic
  bool filmic = false;               ///< roll highlights off instead of clipping them
};

/// What you drew: the surfaces of the scene, or others that lie within its bounds. Both images were made with
/// VK_IMAGE_USAGE_SAMPLED_BIT and have the same size.
struct Surfaces {
  Image depth;   ///< a depth format, as your depth test left it; reversed or not
  Image normal;  ///< world space, unit length, on the side that is seen; what is not of unit length is no surface
  bool normals_are_coded = false;  ///< as 0.5 + 0.5 n, for formats without a sign
  /// Column by column: the product that takes a place in the world to Vulkan's clip space (y down, z in [0, w]).
  std::array<float, 16> clip_from_world{};
};

struct IrradianceSettings {
  bool direct = true;         ///< light that comes straight from the lights, shadows included
  bool caustic = true;        ///< light through glass and water and off mirrors, by the renderer's technique
  std::uint32_t samples = 1;  ///< of what has a size: soft shadows take several, or several frames
};

struct RendererSettings {
  std::string technique = "none";  ///< a real-time one
  std::uint64_t seed = 0;
  std::vector<std::pair<std::string, std::string>> parameters;  ///< of the technique: {key, value}
};

/// What was edited in a scene since the last call; the less, the less is made again.
enum class Edit {
  kLights,   ///< values of lights; none came or went
  kObjects,  ///< where objects stand
  kAnything,
};

struct PassTime {
  std::string name;
  double ms = 0.0;
};

/// Draws one scene on one device. Move-only; one thread at a time.
class Renderer {
 public:
  /// Uploads the scene, after adding what it lacks (Scene::warnings). Device and scene must outlive it.
  /// @throws UsageError for an unknown technique or parameter, DeviceError if the device lacks something,
  ///         ResourceError
  Renderer(const Device& device, Scene& scene, const RendererSettings& settings = {});
  Renderer(Renderer&&) noexcept;
  Renderer& operator=(Renderer&&) noexcept;
  ~Renderer();

  /// Else the scene's own camera is taken. @throws UsageError for what is no view
  void setView(const View& view);
  /// Tells that the scene was edited. @throws ResourceError
  void sceneChanged(Edit edit);

  /// Draws the scene, of the target's size.
  /// @param target  made with VK_IMAGE_USAGE_TRANSFER_DST_BIT, of a format that can be blitted to
  /// @throws UsageError for an unknown layer or such a format, DeviceError, ResourceError
  void drawPicture(const Image& target, const PictureSettings& settings = {});

  /// Irradiance in W/m² on your surfaces, and the flux-weighted mean direction of the travel of light, whose length is
  /// 1 where it all comes from one side and less where it comes from many.
  /// @param irradiance      of the size of the surfaces and otherwise as the target of a picture; best of floats
  /// @param mean_direction  likewise, with a sign: of floats or SNORM; null: not wanted
  /// @throws UsageError, DeviceError, ResourceError
  void drawIrradiance(const Surfaces& surfaces, const Image& irradiance, const Image* mean_direction = nullptr,
                      const IrradianceSettings& settings = {});

  /// Of the last frame or sample, on the device; empty where it has no timestamps.
  std::vector<PassTime> passTimes() const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace nephroid::vulkan
