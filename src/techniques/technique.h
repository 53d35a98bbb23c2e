// What a technique is to the rest of the program, and the list of those that exist.
#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "core/image/image.h"
#include "core/params.h"
#include "core/progress.h"
#include "scene/scene_data.h"
#include "techniques/ledger.h"

namespace nephroid {

class RealtimeTechnique;
struct RealtimeInputs;

/// Where a progressive render is kept while it runs, and taken up again.
struct CheckpointSettings {
  std::string path;        ///< empty: nowhere
  double interval_s = 60;  ///< between two writings
};

/// What to render. A budget of 0 means "not given"; the first budget to be spent ends a progressive render.
struct RenderSettings {
  int width = 1024, height = 768;
  std::vector<std::string> layers{"beauty"};  ///< names of layerInfos()
  std::uint64_t photons = 0;                  ///< emitted, all lights and bands
  std::uint64_t samples = 0;                  ///< per pixel
  double seconds = 0;
  double target_error = 0;        ///< relMSE of the worst layer by its own estimate; only of progressive techniques
  CheckpointSettings checkpoint;  ///< only of progressive techniques
  std::uint64_t seed = 0;
  int threads = 0;              ///< 0: all cores
  std::string device = "auto";  ///< "auto", "cpu" or the number of a Vulkan device
  bool ledgers = false;         ///< also where they take time of their own
  ParamSet params;              ///< of the technique, from --set
};

struct StageTime {
  std::string name;
  double seconds = 0;
  std::uint64_t frames = 0;  ///< that `seconds` is the sum over; 0: no part of a frame
};

/// What was done; varies between equal runs, so it goes into files only with --stats.
struct RenderStats {
  std::vector<StageTime> stages;
  std::uint64_t rays = 0;        ///< traced, shadow rays included
  std::uint64_t photons = 0;     ///< emitted
  std::uint64_t samples = 0;     ///< per pixel
  std::uint64_t not_finite = 0;  ///< path contributions dropped because they were not finite
};

struct RenderResult {
  LayeredImage image;  ///< the layers asked for; metadata: technique, device, parameters, seed, budgets spent
  RenderStats stats;
  std::vector<Ledger> ledgers;     ///< one per light that photons were emitted from
  std::vector<std::string> notes;  ///< what a layer does not contain and why
  bool interrupted = false;        ///< stopped early; the picture is what was reached
  std::string checkpoint_failure;  ///< why the latest checkpoint could not be written; empty: it could
};

/// One technique: an entry of the explicit list in registry.cpp.
struct Technique {
  std::string name;
  std::string text;
  std::string source;
  bool on_vulkan = false;  ///< needs a Vulkan device; else computes on the CPU alone
  /// Converges, and knows how far it is: takes RenderSettings::target_error and checkpoint.
  bool is_progressive = false;
  std::vector<ParamSpec> params;
  /// Of a real-time technique: draws the caustic of a frame. Null: it has none.
  /// @return  null if the scene has no caustic that it could draw
  std::unique_ptr<RealtimeTechnique> (*make_realtime)(const RealtimeInputs& inputs, const ParamSet& params) = nullptr;
  /// What make_realtime makes also says what mirrors and glass show of caustics (RealtimeTechnique::lightReceivers).
  bool lights_receivers = false;
  /// What became of the photons of what make_realtime made. Null: nothing is known of them.
  std::vector<Ledger> (*account)(RealtimeTechnique& technique) = nullptr;
  /// Pictures of the same scene, settings and seed are identical for any thread count unless a time budget ends them.
  /// @throws UsageError, InputError (a checkpoint), DeviceError, ResourceError, InterruptedError (stopped before there
  /// was anything to keep)
  RenderResult (*render)(const SceneData& scene, const Camera& camera, const RenderSettings& settings,
                         ProgressSink* progress, const StopToken* stop);
};

std::span<const Technique> techniques();
/// @throws UsageError with the names there are
const Technique& findTechnique(std::string_view name);
/// What is chosen for the user: caustic-map on a Vulkan device, the reference where there is none or where what is
/// wanted is the reference's alone: a target for the error, its estimates, a checkpoint.
inline constexpr std::string_view kAutoTechnique = "auto";
/// @param name    of a technique, or kAutoTechnique: then Vulkan is asked for its devices
/// @param wanted  its device, layers, target_error and checkpoint count
/// @throws UsageError as above
const Technique& chooseTechnique(std::string_view name, const RenderSettings& wanted);

/// Whether the technique has a use for RenderSettings::device.
bool takesDevice(const Technique& technique, std::string_view device);
/// Only its form: whether there is such a device is known once Vulkan is asked.
/// @throws UsageError if the technique does not take it, or nothing is called so
void checkDevice(const Technique& technique, std::string_view device);
/// @throws UsageError if settings ask for what only a progressive technique can do, and it is none
void checkProgressive(const Technique& technique, const RenderSettings& settings);

}  // namespace nephroid
