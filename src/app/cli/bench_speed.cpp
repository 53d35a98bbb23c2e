#include "app/cli/bench_speed.h"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <nlohmann/json.hpp>

#include "app/cli/memory.h"
#include "app/cli/progress_bar.h"
#include "app/cli/scene_options.h"
#include "app/cli/stop.h"
#include "scene/edit.h"

namespace nephroid::cli {
namespace {

using Clock = std::chrono::steady_clock;

double secondsSince(Clock::time_point start) { return std::chrono::duration<double>(Clock::now() - start).count(); }

/// Adds `value` to the measurement of that name, made on first use.
void addMeasured(std::vector<Measurement>& measurements, const std::string& name, const std::string& unit,
                 double value) {
  auto found = std::find_if(measurements.begin(), measurements.end(),
                            [&](const Measurement& measurement) { return measurement.name == name; });
  if (found == measurements.end()) found = measurements.insert(measurements.end(), Measurement{name, unit, {}});
  found->values.push_back(value);
}

/// A stage as time of a frame, if it is a part of one; frames are what real time is counted in.
void addStage(std::vector<Measurement>& measurements, const StageTime& stage) {
  if (stage.frames == 0) return addMeasured(measurements, stage.name, "s", stage.seconds);
  addMeasured(measurements, stage.name + " / frame", "ms", 1e3 * stage.seconds / static_cast<double>(stage.frames));
}

/// One timed render. @return what computed it
std::string measureRender(const Technique& technique, const SceneData& scene, const RenderSettings& settings,
                          std::vector<Measurement>& measurements) {
  const Camera camera = selectCamera(scene, "0");
  resetPeakMemory();
  const Clock::time_point start = Clock::now();
  const RenderResult result = technique.render(scene, camera, settings, nullptr, &stopToken());
  const double total_s = secondsSince(start);
  if (stopToken().requested()) return "";  // half a measurement would be a wrong one
  addMeasured(measurements, "total", "s", total_s);
  for (const StageTime& stage : result.stats.stages) addStage(measurements, stage);
  if (result.stats.rays > 0) {  // a frame of triangles has none of either
    addMeasured(measurements, "rays", "1/s", static_cast<double>(result.stats.rays) / total_s);
    addMeasured(measurements, "photons", "1/s", static_cast<double>(result.stats.photons) / total_s);
  }
  addMeasured(measurements, "peak memory", "MiB", readPeakMemory());
  return result.image.metadata.at("device");
}

/// A rate of millions reads better with its prefix.
std::string formatQuantity(double value, const std::string& unit) {
  if (unit == "1/s" && value >= 1e6) return fmt::format("{:.3f} M/s", value * 1e-6);
  if (unit == "1/s") return fmt::format("{:.3g} /s", value);
  return fmt::format("{:.4g}{}{}", value, unit.empty() ? "" : " ", unit);
}

}  // namespace

SpeedResult measureSpeed(const std::string& source, const Technique& technique, const SpeedOptions& options) {
  TechniqueOptions technique_options = options.technique;
  technique_options.name = technique.name;
  RenderSettings settings = makeSettings(technique_options);
  settings.layers = {"beauty"};
  SpeedResult result{source, technique.name, {}, {}};
  const Clock::time_point start = Clock::now();
  const SceneData scene = loadEditedScene({.scene = source}, 0.0F);
  const double load_s = secondsSince(start);
  ProgressBar bar(source + " " + technique.name);
  const int run_count = options.warmup + options.repeats;
  std::vector<Measurement> warmup;
  for (int run = 0; run < run_count && !stopToken().requested(); ++run) {
    bar.update(static_cast<double>(run) / run_count, run < options.warmup ? "warming up" : "measuring");
    result.device = measureRender(technique, scene, settings, run < options.warmup ? warmup : result.measurements);
  }
  addMeasured(result.measurements, "load", "s", load_s);
  if (technique.name == "reference" && !stopToken().requested())
    for (Measurement& measurement : measureLightTracingShare(scene, options.repeats))
      result.measurements.push_back(std::move(measurement));
  return result;
}

std::string formatSpeed(const SpeedResult& result) {
  std::size_t width = 0;
  for (const Measurement& m : result.measurements) width = std::max(width, m.name.size());
  std::string text = fmt::format("{} {} on {}\n", result.scene, result.technique, result.device);
  for (const Measurement& m : result.measurements) {
    text += fmt::format("  {:<{}} {:>16}", m.name, width, formatQuantity(computeMedian(m.values), m.unit));
    if (m.values.size() > 1) text += fmt::format("  +- {:.1f} %", 100 * computeSpread(m.values));
    text += '\n';
  }
  return text;
}

nlohmann::ordered_json speedToJson(const SpeedResult& result) {
  nlohmann::ordered_json measurements = nlohmann::ordered_json::array();
  for (const Measurement& measurement : result.measurements)
    measurements.push_back({{"name", measurement.name},
                            {"unit", measurement.unit},
                            {"median", computeMedian(measurement.values)},
                            {"spread", computeSpread(measurement.values)},
                            {"values", measurement.values}});
  return {{"scene", result.scene},
          {"technique", result.technique},
          {"device", result.device},
          {"measurements", measurements}};
}

double computeMedian(std::vector<double> values) {
  if (values.empty()) return 0;
  std::sort(values.begin(), values.end());
  const std::size_t middle = values.size() / 2;
  return values.size() % 2 == 1 ? values[middle] : 0.5 * (values[middle - 1] + values[middle]);
}

double computeSpread(const std::vector<double>& values) {
  const double median = computeMedian(values);
  if (values.size() < 2 || median == 0) return 0;
  const auto [lowest, highest] = std::minmax_element(values.begin(), values.end());
  return 0.5 * (*highest - *lowest) / median;
}

}  // namespace nephroid::cli
