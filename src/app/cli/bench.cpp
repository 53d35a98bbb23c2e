// `nephroid bench`: how fast each technique draws each scene on this machine.
#include <fmt/format.h>

#include <algorithm>
#include <fstream>
#include <nlohmann/json.hpp>
#include <optional>
#include <thread>

#include "app/cli/bench_speed.h"
#include "app/cli/command.h"
#include "app/cli/embedded.h"
#include "app/cli/options.h"
#include "app/cli/stop.h"
#include "app/cli/technique_options.h"
#include "app/cli/terminal.h"
#include "nephroid/nephroid.h"

namespace nephroid::cli {
namespace {

using Json = nlohmann::ordered_json;

constexpr const char* kExamples = R"(Examples:
  nephroid bench
  nephroid bench builtin:ring glass.glb --repeats 11 --json)";

constexpr int kMaxRepeats = 1000;

struct BenchOptions {
  std::vector<std::string> scenes;
  std::string only_technique;
  SpeedOptions speed;
  bool json = false;
};

Json defaultList() { return Json::parse(kBenchScenes); }

std::string readCpuModel() {
  std::ifstream info("/proc/cpuinfo");
  for (std::string line; std::getline(info, line);)
    if (line.starts_with("model name")) return line.substr(std::min(line.find(':') + 2, line.size()));
  return "unknown";
}

int threadCount(const TechniqueOptions& options) {
  return options.threads > 0 ? options.threads : static_cast<int>(std::thread::hardware_concurrency());
}

Json describeRun(const BenchOptions& options) {
  const TechniqueOptions& technique = options.speed.technique;
  return {{"version", version()},
          {"cpu", readCpuModel()},
          {"threads", threadCount(technique)},
          {"warmup", options.speed.warmup},
          {"repeats", options.speed.repeats},
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
std::optional<SpeedResult> benchIfPossible(const std::string& scene, const Technique& technique,
                                           const BenchOptions& options) {
  try {
    return measureSpeed(scene, technique, options.speed);
  } catch (const DeviceError& error) {
    if (!options.only_technique.empty() || options.speed.technique.device != "auto") throw;
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
                            threadCount(options.speed.technique), options.speed.repeats));
  for (const std::string& scene : options.scenes) {
    for (const Technique* technique : chooseTechniques(options.only_technique, options.speed.technique.device)) {
      const std::optional<SpeedResult> result = benchIfPossible(scene, *technique, options);
      if (stopToken().requested()) break;
      if (!result) continue;
      if (options.json)
        run["results"].push_back(speedToJson(*result));
      else
        writeStdout(formatSpeed(*result));
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

Command addBenchCommand(CLI::App& root) {
  const auto options = std::make_shared<BenchOptions>();
  const Json list = defaultList();
  applyListDefaults(options->speed.technique, list);
  CLI::App* app = addCommand(root, "bench", "Measure speed and memory of each technique on each scene.", kExamples);
  addArguments(*app, "SCENES", options->scenes, "SCENE",
               {"Scenes, as for render.",
                fmt::format("{}", fmt::join(list["scenes"].get<std::vector<std::string>>(), " ")), "", ""});
  addTechniqueOptions(*app, options->speed.technique, options->only_technique, "all");
  addValue(*app, "--warmup", options->speed.warmup, "N",
           {"Renders before the measured ones.", "1", fmt::format("0 to {}", kMaxRepeats), ""},
           checkNumber(0, kMaxRepeats));
  addValue(*app, "--repeats", options->speed.repeats, "N",
           {"Measured renders per scene and technique.", "5", fmt::format("1 to {}", kMaxRepeats), ""},
           checkNumber(1, kMaxRepeats));
  addSwitch(*app, "--json", options->json, "Print JSON, with every value.");
  return {app, [options] { return runBench(*options); }};
}

}  // namespace nephroid::cli
