// Nephroid's public API: load a scene, edit it, render it, read the layers.
//
// Units are metres, seconds and watts; colours are linear RGB with Rec. 709 primaries; the world is right-handed with Y
// up. Every function reports failure by an exception of nephroid/error.h; nothing here prints or ends the program.
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "nephroid/error.h"

namespace nephroid {

/// "MAJOR.MINOR.PATCH" of the library.
std::string_view version();

/// What there is to choose from; `nephroid scenes` and `nephroid techniques` describe each.
std::vector<std::string> builtinSceneNames();
std::vector<std::string> techniqueNames();
std::vector<std::string> layerNames();

/// When Nephroid puts a floor under a scene.
enum class Floor { kAuto, kOn, kOff };

struct LoadSettings {
  float time = 0.0F;           ///< s, >= 0: the moment of an animation
  Floor floor = Floor::kAuto;  ///< kAuto: only where nothing catches light
};

/// What is rendered: geometry, materials, lights, environment, cameras.
///
/// Move-only. Different scenes may be used from different threads; one scene from one thread at a time.
class Scene {
 public:
  /// @param source  a .glb or .gltf file, or "builtin:NAME[?key=value&…]"
  /// @throws InputError for a file, UsageError for an unknown built-in scene or parameter
  static Scene load(std::string_view source, const LoadSettings& settings = {});

  Scene(Scene&&) noexcept;
  Scene& operator=(Scene&&) noexcept;
  ~Scene();

  /// The edits of `nephroid render`, in the same words: see `nephroid render --help`.
  /// @throws UsageError
  void editMaterial(std::string_view edit);  ///< "glass*:ior=1.6,abbe=30"
  void editObject(std::string_view edit);    ///< "ring:translate=0,0.1,0"
  void editLight(std::string_view edit);     ///< "sun:azimuth=30,elevation=40,irradiance=10"

  /// @param choice  NAME or INDEX of a camera of the scene, or "eye=x,y,z:target=x,y,z:fov=DEG[:ortho=H]"; checked by
  ///                `render`, which adds a camera where there is none
  void setCamera(std::string_view choice);

  /// @param source  a latitude-longitude .exr or .hdr file, or "sky[:key=value,…]"
  /// @param scale   multiplies its radiance, >= 0
  /// @throws InputError, UsageError
  void setEnvironment(std::string_view source, float rotation_deg = 0.0F, float scale = 1.0F);

  /// What the file asks for and Nephroid does not do, and what was added for want of it (a light, a floor, a camera).
  /// Complete once the scene was rendered.
  std::vector<std::string> warnings() const;

  /// Geometry, materials, who casts caustics and who catches them: what `nephroid info` prints.
  std::string describe() const;

 private:
  friend struct SceneAccess;
  struct Impl;
  explicit Scene(std::unique_ptr<Impl> impl);
  std::unique_ptr<Impl> impl_;
};

/// What to render. A budget of 0 is "not given"; the first budget that is spent ends the render.
struct RenderRequest {
  /// Of `techniqueNames()`, or "auto": caustic-map where there is a Vulkan device and `device` is not "cpu"; else, and
  /// for what only it has (a target for the error, layers of errors, a checkpoint), reference.
  /// `Picture::metadata("technique")` tells what it was.
  std::string technique = "auto";
  int width = 1024, height = 768;             ///< px, 1 to 16384
  std::vector<std::string> layers{"beauty"};  ///< of `layerNames()`
  std::uint64_t photons = 0;                  ///< emitted, over all lights and bands
  std::uint64_t samples = 0;                  ///< per pixel
  double seconds = 0;                         ///< ends a progressive render; the picture then varies between runs
  /// Of progressive techniques: ends the render when relMSE, estimated from the standard errors of the layers asked
  /// for, is down to this in each of them (docs/cli.md, "Errors").
  double target_error = 0;
  /// Of progressive techniques: a file that the render is kept in while it runs, and taken up from if it exists. What
  /// cannot be written ends nothing; it is among `Picture::notes()`.
  std::string checkpoint;
  double checkpoint_interval_s = 60;  ///< between two writings
  std::uint64_t seed = 0;
  int threads = 0;  ///< 0: all cores; the picture does not depend on it
  /// What computes: "auto" (the best Vulkan device where the technique needs one, else the CPU), "cpu" (no Vulkan at
  /// all), or the number of a Vulkan device, from 0. `Picture::metadata("device")` tells what it was.
  std::string device = "auto";
  std::vector<std::pair<std::string, std::string>> parameters;  ///< of the technique: {key, value}

  /// Called a few times a second, from any thread but one at a time, with the fraction done, in [0, 1], and a short
  /// status. Return false to stop; the picture then holds what was reached.
  std::function<bool(double fraction, const std::string& status)> on_progress;
};

/// How a layer is brought to a screen.
struct PngSettings {
  bool auto_exposure = true;  ///< from beauty where the picture has it
  float exposure_ev = 0.0F;   ///< otherwise: radiance is multiplied by 2^exposure_ev
  bool filmic = false;        ///< roll highlights off instead of clipping them
};

/// A layer's pixels: `height × width × channels`, interleaved, row 0 on top; radiance in W/m²/sr, irradiance in W/m².
struct LayerView {
  std::span<const float> pixels;
  int width = 0, height = 0, channels = 0;
};

/// The layers of one render. Move-only; safe to read from several threads.
class Picture {
 public:
  Picture(Picture&&) noexcept;
  Picture& operator=(Picture&&) noexcept;
  ~Picture();

  std::vector<std::string> layerNames() const;
  /// Valid as long as the picture.
  /// @throws UsageError if the picture has no such layer
  LayerView layer(std::string_view name) const;
  /// The value that was recorded under `key` ("technique", "seed", …), or "".
  std::string metadata(std::string_view key) const;
  /// What a layer does not contain and why.
  std::vector<std::string> notes() const;
  /// Where the photons of each light ended, as a table; "" if none were emitted.
  std::string ledger() const;
  /// Stopped early by `on_progress`.
  bool interrupted() const;

  /// Every layer into one OpenEXR file, written under a temporary name and renamed.
  /// @throws ResourceError
  void writeExr(const std::string& path, bool half = false) const;
  /// One layer as an sRGB picture, likewise.
  /// @throws ResourceError, UsageError
  void writePng(const std::string& path, std::string_view layer = "beauty", const PngSettings& settings = {}) const;

 private:
  friend struct SceneAccess;
  struct Impl;
  explicit Picture(std::unique_ptr<Impl> impl);
  std::unique_ptr<Impl> impl_;
};

/// Renders `scene`, after adding what it lacks (see `Scene::warnings`).
/// @throws UsageError for what is unknown or out of range, InputError for a checkpoint of another render, DeviceError
/// where there is no device for it, ResourceError
///         when memory is short, InterruptedError if stopped before there was anything to keep
Picture render(Scene& scene, const RenderRequest& request = {});

}  // namespace nephroid
