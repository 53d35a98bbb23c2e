#include "techniques/realtime/realtime_render.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <limits>
#include <memory>
#include <optional>
#include <string_view>

#include "frame/realtime_technique.h"
#include "nephroid/error.h"
#include "techniques/layers.h"
#include "techniques/realtime/open_device.h"
#include "techniques/settings.h"
#include "trace/box_tree_builder.h"

namespace nephroid {
namespace {

/// Soft shadows and edges of few levels, in a fraction of a second on a GPU.
constexpr std::uint64_t kDefaultSamples = 16;
/// Six views of so many cells a side, of 4 bytes each, are still within the 128 MiB that lavapipe lets a buffer have.
constexpr int kMaxShadowSize = 2048;
/// Samples are numbered in 32 bits.
constexpr std::uint64_t kMaxSamples = std::numeric_limits<std::uint32_t>::max();
/// Share of the flux on receivers from which on it is worth a word that their map lacks it: a tenth of what is
/// tolerated of energy.
constexpr double kNotedLoss = 1e-3;
/// Between two reports of progress: frames may be much shorter.
constexpr double kReportInterval_s = 0.1;

/// Means over frames: what every frame makes, and what it makes of a technique's irradiance.
constexpr std::array<std::string_view, 3> kFrameLayers{"direct", "emission", "specular"};
constexpr std::array<std::string_view, 2> kCausticLayers{"caustic", "irradiance_caustic"};
constexpr std::array<std::string_view, 5> kGeometryLayers{"albedo", "normal", "position", "depth", "id"};

template <std::size_t N>
bool contains(const std::array<std::string_view, N>& names, std::string_view name) {
  return std::find(names.begin(), names.end(), name) != names.end();
}

using Clock = std::chrono::steady_clock;
double secondsSince(Clock::time_point start) { return std::chrono::duration<double>(Clock::now() - start).count(); }

/// @throws DeviceError if the device makes no images of that size
void checkSize(const gpu::Device& device, const RenderSettings& settings) {
  const std::uint32_t limit = device.limits().maxImageDimension2D;
  if (static_cast<std::uint32_t>(std::max(settings.width, settings.height)) > limit)
    throw DeviceError(fmt::format("a picture of {}x{} is too large for {}: its images have at most {} texels a side",
                                  settings.width, settings.height, device.name(), limit));
}

FrameSettings makeSettings(const RenderSettings& settings) {
  FrameSettings frame = makeFrameSettings(settings.params);
  frame.width = settings.width, frame.height = settings.height;
  frame.specular = std::ranges::any_of(settings.layers, [](const std::string& l) {
    return l == "beauty" || l == "specular" || l == "specular_caustic";
  });
  frame.seed = foldSeed(settings.seed);
  return frame;
}

/// One progressive render.
class ProgressiveFrames {
 public:
  ProgressiveFrames(gpu::Device& device, const Technique& technique, const SceneData& scene, const Camera& camera,
                    const RenderSettings& settings, ProgressSink* progress, const StopToken* stop,
                    Clock::time_point start)
      : device_(device),
        technique_(technique),
        settings_(settings),
        progress_(progress),
        stop_(stop),
        start_(start),
        frame_(device, scene, camera, makeSettings(settings), factoryOf(technique, settings.params)) {
    const bool sums =
        std::ranges::any_of(settings.layers, [&](const std::string& n) { return n == "beauty" || isMade(n); });
    const bool timed_only = settings.seconds > 0 && settings.samples == 0;
    budget_ = settings.samples ? std::min(settings.samples, kMaxSamples) : timed_only ? kMaxSamples : kDefaultSamples;
    if (!sums) budget_ = 0;
    stages_.push_back({"build", secondsSince(start)});
  }

  RenderResult run() {
    while (frame_.samples() < budget_ && !stopped() && !(timeIsUp() && frame_.samples() > 0)) {
      const Clock::time_point begin = Clock::now();
      frame_.render(frame_.samples());
      frame_seconds_.push_back(secondsSince(begin));
      addTime("whole", frame_seconds_.back());
      for (const gpu::PassTime& pass : frame_.passTimes()) addTime(pass.name, 1e-3 * pass.ms);
      report();
    }
    RenderResult result;
    result.interrupted = stopped();
    if (result.interrupted && budget_ > 0 && frame_.samples() == 0)
      throw InterruptedError("interrupted before there was anything to keep");
    result.image.width = settings_.width, result.image.height = settings_.height;
    for (const std::string& name : settings_.layers) result.image.layers.push_back({name, readLayer(name)});
    if (settings_.ledgers && technique_.account && frame_.technique()) {
      result.ledgers = technique_.account(*frame_.technique());
      noteLostByReceivers(result);
    }
    describe(result);
    return result;
  }

 private:
  bool stopped() const { return stop_ && stop_->requested(); }
  bool timeIsUp() const { return settings_.seconds > 0 && secondsSince(start_) >= settings_.seconds; }

  /// A pass that runs several times in a frame, such as once a light, is one stage. "whole" is a frame by our own
  /// clock: with what the CPU does for it, and where the device has no timestamps.
  void addTime(const std::string& name, double seconds) {
    auto found = std::find_if(stages_.begin(), stages_.end(), [&](const StageTime& s) { return s.name == name; });
    if (found == stages_.end()) found = stages_.insert(stages_.end(), StageTime{name});
    found->seconds += seconds;
  }

  void report() {
    if (!progress_) return;
    const bool last = frame_.samples() == budget_;
    if (!last && reported_ && secondsSince(*reported_) < kReportInterval_s) return;
    reported_ = Clock::now();
    double fraction = static_cast<double>(frame_.samples()) / static_cast<double>(budget_);
    if (settings_.seconds > 0) fraction = std::max(fraction, secondsSince(start_) / settings_.seconds);
    progress_->update(std::min(fraction, 1.0), fmt::format("{} samples", frame_.samples()));
  }

  /// Whether it is a mean over frames.
  bool isMade(std::string_view layer) const {
    return contains(kFrameLayers, layer) || (technique_.make_realtime && contains(kCausticLayers, layer)) ||
           (technique_.lights_receivers && layer == "specular_caustic");
  }

  Image readLayer(const std::string& name) {
    if (contains(kGeometryLayers, name)) return frame_.readGeometry(name);
    if (isMade(name)) return frame_.readSummed(name);
    if (name != "beauty") return {settings_.width, settings_.height, findLayerInfo(name).channels};
    Image sum(settings_.width, settings_.height, 3);
    for (const LayerInfo& info : layerInfos()) {
      if (!info.summed || !isMade(info.name)) continue;
      const Image layer = frame_.readSummed(std::string(info.name));
      for (std::size_t i = 0; i < sum.pixels.size(); ++i) sum.pixels[i] += layer.pixels[i];
    }
    return sum;
  }

  void describe(RenderResult& result) {
    if (!frame_seconds_.empty()) {
      // The first frame builds what the others use.
      auto middle = frame_seconds_.begin() + static_cast<std::ptrdiff_t>(frame_seconds_.size() / 2);
      std::nth_element(frame_seconds_.begin(), middle, frame_seconds_.end());
      stages_.insert(stages_.begin() + 1, {"median", *middle * static_cast<double>(frame_seconds_.size())});
    }
    // All but the first are sums over the frames.
    for (std::size_t i = 1; i < stages_.size(); ++i) stages_[i].frames = frame_.samples();
    result.stats.stages = stages_;
    result.stats.samples = frame_.samples();
    auto& metadata = result.image.metadata;
    metadata["technique"] = technique_.name;
    metadata["device"] = device_.name();
    metadata["seed"] = std::to_string(settings_.seed);
    metadata["samples"] = std::to_string(frame_.samples());
    for (const ParamSpec& spec : settings_.params.specs())
      metadata["set." + spec.name] = settings_.params.toText(spec.name);
    noteWhatIsMissing(result);
  }

  void noteLostByReceivers(RenderResult& result) {
    double ended = 0.0;
    for (const Ledger& ledger : result.ledgers) ended += luminance(vec3(ledger.deposited));
    const double lost = frame_.samples() > 0 ? luminance(vec3(frame_.technique()->lostByReceivers())) : 0.0;
    if (!(lost > kNotedLoss * ended)) return;
    result.notes.push_back(
        fmt::format("specular_caustic lacks {:.3g} W, {:.1f} % of what ends on receivers: behind two others from every "
                    "axis, or beside an edge, no view of them shows it",
                    lost, 100.0 * lost / ended));
  }

  void noteWhatIsMissing(RenderResult& result) const {
    const auto asked = [&](std::string_view name) {
      return std::find(settings_.layers.begin(), settings_.layers.end(), name) != settings_.layers.end();
    };
    std::vector<std::string_view> missing, missing_from_beauty, in_beauty;
    for (const LayerInfo& layer : layerInfos()) {
      if (layer.summed && isMade(layer.name)) in_beauty.push_back(layer.name);
      if (layer.name == "beauty" || isMade(layer.name) || contains(kGeometryLayers, layer.name)) continue;
      if (layer.summed) missing_from_beauty.push_back(layer.name);
      if (asked(layer.name)) {
        missing.push_back(layer.name);
        result.notes.push_back(fmt::format("{} is black: technique {} does not make it", layer.name, technique_.name));
      }
    }
    auto& metadata = result.image.metadata;
    if (!missing.empty()) metadata["not_made"] = fmt::format("{}", fmt::join(missing, ","));
    if (!asked("beauty")) return;
    metadata["not_in_beauty"] = fmt::format("{}", fmt::join(missing_from_beauty, ","));
    result.notes.push_back(fmt::format("beauty is {} alone: technique {} makes no {}", fmt::join(in_beauty, ", "),
                                       technique_.name, fmt::join(missing_from_beauty, ", ")));
  }

  gpu::Device& device_;
  const Technique& technique_;
  const RenderSettings& settings_;
  ProgressSink* progress_;
  const StopToken* stop_;
  Clock::time_point start_;
  RealtimeFrame frame_;
  std::vector<StageTime> stages_;  ///< the first is "build"
  std::vector<double> frame_seconds_;
  std::uint64_t budget_ = 0;  ///< samples
  std::optional<Clock::time_point> reported_;
};

}  // namespace

std::vector<ParamSpec> makeFrameParams() {
  return {
      makeSpecularAlphaParam(),
      {"shadow-size",
       static_cast<int>(FrameSettings{}.shadow_size),
       64,
       kMaxShadowSize,
       "cells",
       "along a side of each view from a light, in which shadows look for what casts them; bears on speed only",
       {}},
      {"max-events",
       static_cast<int>(FrameSettings{}.max_events),
       1,
       256,
       "",
       "reflections and refractions in a row that are followed in what mirrors and glass show",
       {}},
      {"specular-spacing",
       static_cast<int>(FrameSettings{}.specular_spacing),
       1,
       4,
       "pixels",
       "between those from which smooth mirrors and glass are followed; those between show what lies between; 1: all",
       {}},
  };
}

FrameSettings makeFrameSettings(const ParamSet& params) {
  return {.shadow_size = static_cast<std::uint32_t>(params.getInt("shadow-size")),
          .specular_alpha = params.getFloat("specular-alpha"),
          .box_tree_builder = buildBoxTree,
          .max_events = static_cast<std::uint32_t>(params.getInt("max-events")),
          .specular_spacing = static_cast<std::uint32_t>(params.getInt("specular-spacing"))};
}

MakeRealtimeTechnique factoryOf(const Technique& technique, const ParamSet& params) {
  if (!technique.make_realtime) return {};
  return [make = technique.make_realtime, params](const RealtimeInputs& inputs) { return make(inputs, params); };
}

RenderResult renderRealtime(const Technique& technique, const SceneData& scene, const Camera& camera,
                            const RenderSettings& settings, ProgressSink* progress, const StopToken* stop) {
  const Clock::time_point start = Clock::now();
  checkDevice(technique, settings.device);
  if (settings.width < 1 || settings.height < 1) throw UsageError("a picture has at least 1 × 1 pixels");
  OpenDevice open(settings.device);
  checkSize(open.device(), settings);
  RenderResult result;
  {
    ProgressiveFrames frames(open.device(), technique, scene, camera, settings, progress, stop, start);
    open.keepPipelines();
    result = frames.run();
  }
  for (std::string& limit : describeFrameLimits(scene, makeSettings(settings), technique.lights_receivers))
    result.notes.push_back(std::move(limit));
  open.checkValidation();
  return result;
}

}  // namespace nephroid
