// `nephroid bench`: how fast each technique draws each scene on this machine.
#include "app/cli/bench.h"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <fstream>
#include <nlohmann/json.hpp>
#include <optional>
#include <thread>

#include "app/cli/command.h"
#include "app/cli/embedded.h"
#include "app/cli/memory.h"
#include "app/cli/options.h"
#include "app/cli/progress_bar.h"
#include "app/cli/scene_options.h"
#include "app/cli/stop.h"
#include "app/cli/technique_options.h"
#include "app/cli/terminal.h"
#include "nephroid/nephroid.h"
#include "scene/edit.h"

namespace nephroid::cli {
namespace {

using Json = nlohmann::ordered_json;
using Clock = std::chrono::steady_clock;

constexpr const char* kExamples = R"(Examples:
  nephroid bench
  nephroid bench builtin:ring glass.glb --repeats 11 --json)";

constexpr int kMaxRepeats = 1000;

struct BenchOptions {
  std::vector<std::string> scenes;
  TechniqueOptions technique;
  std::string only_technique;
  int warmup = 1, repeats = 5;
  bool json = false;
};

Json defaultList() { return Json::parse(kBenchScenes); }

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

BenchResult benchScene(const std::string& source, const Technique& technique, const BenchOptions& options) {
  TechniqueOptions technique_options = options.technique;
  technique_options.name = technique.name;
  RenderSettings settings = makeSettings(technique_options);
  settings.layers = {"beauty"};
  BenchResult result{source, technique.name, {}, {}};
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

std::string readCpuModel() {
  std::ifstream info("/proc/cpuinfo");
  for (std::string line; std::getline(info, line);)
    if (line.starts_with("model name")) return line.substr(std::min(line.find(':') + 2, line.size()));
  return "unknown";
}

/// A rate of millions reads better with its prefix.
std::string formatQuantity(double value, const std::string& unit) {
  if (unit == "1/s" && value >= 1e6) return fmt::format("{:.3f} M/s", value * 1e-6);
  if (unit == "1/s") return fmt::format("{:.3g} /s", value);
  return fmt::format("{:.4g}{}{}", value, unit.empty() ? "" : " ", unit);
}

std::string formatResult(const BenchResult& result) {
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

Json toJson(const BenchResult& result) {
  Json measurements = Json::array();
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

int threadCount(const BenchOptions& options) {
  return options.technique.threads > 0 ? options.technique.threads
                                       : static_cast<int>(std::thread::hardware_concurrency());
}

Json describeRun(const BenchOptions& options) {
  const TechniqueOptions& technique = options.technique;
  return {{"version", version()},
          {"cpu", readCpuModel()},
          {"threads", threadCount(options)},
          {"warmup", options.warmup},
          {"repeats", options.repeats},
          {"size", fmt::format("{}x{}", technique.size.width, technique.size.height)},
          {"samples", technique.samples},
          {"photons", technique.photons},
          {"seed", technique.seed},
          {"set", technique.parameters}};
}

/// The one that was named, or all that have a use for the device.
std::vector<const Technique*> chooseTechniques(const std::string& name, const std::string& device) {
  if (!name.empty()) return {&findTechnique(name)};
  std::vector<const Technique*> chosen;
  for (const Technique& technique : techniques())
    if (takesDevice(technique, device)) chosen.push_back(&technique);
  return chosen;
}

/// Nothing where technique and device were left to us and the machine has no device for the technique.
std::optional<BenchResult> benchIfPossible(const std::string& scene, const Technique& technique,
                                           const BenchOptions& options) {
  try {
    return benchScene(scene, technique, options);
  } catch (const DeviceError& error) {
    if (!options.only_technique.empty() || options.technique.device != "auto") throw;
    writeStderr(fmt::format("warning: {} is left out: {}", technique.name, error.what()));
    return std::nullopt;
  }
}

ExitCode runBench(BenchOptions options) {
  if (options.scenes.empty()) options.scenes = defaultList()["scenes"].get<std::vector<std::string>>();
  Json run = describeRun(options);
  run["results"] = Json::array();
  if (!options.json)
    writeStdout(fmt::format("nephroid {}, {}, {} threads, median and half range of {}\n", version(), readCpuModel(),
                            threadCount(options), options.repeats));
  for (const std::string& scene : options.scenes) {
    for (const Technique* technique : chooseTechniques(options.only_technique, options.technique.device)) {
      const std::optional<BenchResult> result = benchIfPossible(scene, *technique, options);
      if (stopToken().requested()) break;
      if (!result) continue;
      if (options.json)
        run["results"].push_back(toJson(*result));
      else
        writeStdout(formatResult(*result));
    }
  }
  if (options.json) writeStdout(run.dump(2) + "\n");
  return stopToken().requested() ? ExitCode::kInterrupted : ExitCode::kDone;
}

/// The options' defaults are those of the list, so that --help and the list cannot disagree.
void applyListDefaults(TechniqueOptions& options, const Json& list) {
  options.size = parseSize("bench/scenes.json", list["size"].get<std::string>());
  options.samples = list["samples"].get<std::uint64_t>();
  options.photons = parseCount("bench/scenes.json", list["photons"].get<std::string>());
}

}  // namespace

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

Command addBenchCommand(CLI::App& root) {
  const auto options = std::make_shared<BenchOptions>();
  const Json list = defaultList();
  applyListDefaults(options->technique, list);
  CLI::App* app = addCommand(root, "bench", "Measure speed and memory of each technique on each scene.", kExamples);
  addArguments(*app, "SCENES", options->scenes, "SCENE",
               {"Scenes, as for render.",
                fmt::format("{}", fmt::join(list["scenes"].get<std::vector<std::string>>(), " ")), "", ""});
  addTechniqueOptions(*app, options->technique, options->only_technique, "all");
  addValue(*app, "--warmup", options->warmup, "N",
           {"Renders before the measured ones.", "1", fmt::format("0 to {}", kMaxRepeats), ""},
           checkNumber(0, kMaxRepeats));
  addValue(*app, "--repeats", options->repeats, "N",
           {"Measured renders per scene and technique.", "5", fmt::format("1 to {}", kMaxRepeats), ""},
           checkNumber(1, kMaxRepeats));
  addSwitch(*app, "--json", options->json, "Print JSON, with every value.");
  return {app, [options] { return runBench(*options); }};
}

}  // namespace nephroid::cli
