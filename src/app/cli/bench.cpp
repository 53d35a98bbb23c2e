// `nephroid bench`: how fast each technique draws each scene on this machine, and how far from the reference.
#include <fmt/format.h>

#include <algorithm>
#include <fstream>
#include <nlohmann/json.hpp>
#include <thread>

#include "app/cli/bench_closed_form.h"
#include "app/cli/bench_error.h"
#include "app/cli/bench_race.h"
#include "app/cli/bench_speed.h"
#include "app/cli/command.h"
#include "app/cli/embedded.h"
#include "app/cli/options.h"
#include "app/cli/stop.h"
#include "app/cli/technique_options.h"
#include "app/cli/terminal.h"
#include "core/file.h"
#include "nephroid/nephroid.h"

namespace nephroid::cli {
namespace {

using Json = nlohmann::ordered_json;

constexpr const char* kExamples = R"(Examples:
  nephroid bench
  nephroid bench builtin:ring glass.glb --repeats 11 --json
  nephroid bench --error
  nephroid bench --error builtin:ring --technique caustic-map --set grid=512 --reference-photons 200M
  nephroid bench --race builtin:ring --svg race.svg
  nephroid bench --race cup.glb --reference truth.exr --mask floor.png --set estimator=footprint
  nephroid bench --closed-form
  nephroid bench --closed-form ring ball-behind --technique caustic-map --set grid=256)";

constexpr int kMaxRepeats = 1000;

struct BenchOptions {
  std::vector<std::string> scenes;
  std::string only_technique;
  TechniqueOptions technique;
  int warmup = 1, repeats = 5;
  bool error = false, race = false, closed_form = false;
  double race_seconds = 20;
  std::string reference, mask, svg;
  std::uint64_t reference_photons = 0;
  bool json = false;
};

/// What bench/scenes.json has for one of the kinds of benchmark.
struct Defaults {
  Size size;
  std::uint64_t samples = 0, photons = 0, reference_photons = 0;
  std::vector<std::string> scenes;
};

/// Which of the kinds of benchmark this is, as bench/scenes.json calls it.
const char* kindOf(const BenchOptions& options) {
  return options.closed_form ? "closed-form" : options.race ? "race" : options.error ? "error" : "speed";
}

/// @param kind  "speed", "error" or "race"
Defaults readDefaults(const char* kind) {
  const Json list = Json::parse(kBenchScenes)[kind];
  const auto count = [&](const char* key) { return parseCount(key, list.value(key, "0")); };
  return {parseSize("size", list["size"].get<std::string>()), count("samples"), count("photons"),
          count("reference-photons"), list["scenes"].get<std::vector<std::string>>()};
}

/// Gives what the command line leaves open the value that it has for this kind of benchmark. Closed forms have their
/// own: see readClosedFormOptions.
void completeOptions(BenchOptions& options, const CLI::App& app) {
  if (options.closed_form) {
    if (options.scenes.empty())
      for (const closed_form::ClosedForm& form : closed_form::closedForms()) options.scenes.push_back(form.name);
    return;
  }
  const Defaults defaults = readDefaults(kindOf(options));
  if (options.scenes.empty()) options.scenes = defaults.scenes;
  if (!isGiven(app, "--size")) options.technique.size = defaults.size;
  if (!isGiven(app, "--samples")) options.technique.samples = defaults.samples;
  if (!isGiven(app, "--photons")) options.technique.photons = defaults.photons;
  if (!isGiven(app, "--reference-photons")) options.reference_photons = defaults.reference_photons;
}

/// @throws UsageError for an option of another kind of benchmark: it would do nothing
void checkOptions(const BenchOptions& options, const CLI::App& app) {
  const auto refuse = [&](std::initializer_list<const char*> names, const std::string& why) {
    for (const char* name : names)
      if (isGiven(app, name)) throw UsageError(fmt::format("{} {}", name, why));
  };
  if (options.error + options.race + options.closed_form > 1)
    throw UsageError("--error, --race and --closed-form are benchmarks of their own: one at a time");
  if (!options.error && !options.race)
    refuse({"--reference-photons"}, "is for --error and --race: others need no reference");
  if (!options.race) refuse({"--race-seconds", "--reference", "--mask", "--svg"}, "is for --race");
  if (options.closed_form) {
    refuse({"--warmup", "--repeats"}, "is for speed: with --closed-form each technique renders once");
    refuse({"--size"}, "is not for --closed-form, whose pictures have the size that their formula is compared at");
    refuse({"--seconds"}, "is not for --closed-form: what it measures must not depend on how fast a machine is");
  }
  if (options.error) refuse({"--warmup", "--repeats"}, "is for speed: with --error each technique renders once");
  if (options.race) {
    refuse({"--warmup", "--repeats"}, "is for speed: with --race each estimator renders once for each point");
    refuse({"--photons", "--samples", "--seconds"}, "is not for --race, whose renders have more and more of both");
    if (!options.only_technique.empty() && options.only_technique != "reference")
      throw UsageError("--race is run by the estimators of the technique 'reference'");
    if (!options.reference.empty() && options.scenes.size() != 1)
      throw UsageError("--reference is of one scene: name that scene alone");
  }
  if ((options.error || options.race) && options.reference_photons < 2)
    throw UsageError("--reference-photons: expected 2 or more: the reference is two renders of half of them");
}

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
  const TechniqueOptions& technique = options.technique;
  Json run{{"version", version()}, {"cpu", readCpuModel()}, {"threads", threadCount(technique)}};
  if (options.error || options.race) {
    run["reference_photons"] = options.reference_photons;
  } else if (!options.closed_form) {
    run["warmup"] = options.warmup;
    run["repeats"] = options.repeats;
  }
  if (!options.closed_form) run["size"] = fmt::format("{}x{}", technique.size.width, technique.size.height);
  run["samples"] = technique.samples;
  run["photons"] = technique.photons;
  run["seed"] = technique.seed;
  run["set"] = technique.parameters;
  run["results"] = Json::array();
  return run;
}

/// Whether a technique that was not named is measured: all are for their speed, those that draw a caustic frame by
/// frame for their error, and for closed forms the reference as well.
bool isMeasured(const Technique& technique, const BenchOptions& options) {
  if (options.error) return technique.make_realtime != nullptr;
  if (options.closed_form) return technique.make_realtime != nullptr || technique.is_progressive;
  return true;
}

/// The one that was named, or all that have a use for the device.
std::vector<const Technique*> chooseTechniques(const BenchOptions& options) {
  if (!options.only_technique.empty())
    return {&chooseTechnique(options.only_technique, {.device = options.technique.device})};
  std::vector<const Technique*> chosen;
  for (const Technique& technique : techniques())
    if (takesDevice(technique, options.technique.device) && isMeasured(technique, options))
      chosen.push_back(&technique);
  return chosen;
}

/// Calls `measure()`. Where technique and device were left to us, a technique that the machine has no device for is
/// left out.
template <class Measure>
void whereThereIsADevice(const BenchOptions& options, const Technique& technique, const Measure& measure) {
  try {
    measure();
  } catch (const DeviceError& error) {
    if (!options.only_technique.empty() || options.technique.device != "auto") throw;
    warnOnce(fmt::format("{} is left out: {}", technique.name, error.what()));
  }
}

/// Calls `measure(technique)` for each technique.
template <class Measure>
void forEachTechnique(const BenchOptions& options, const Measure& measure) {
  for (const Technique* technique : chooseTechniques(options))
    whereThereIsADevice(options, *technique, [&] { measure(*technique); });
}

void benchSpeed(const BenchOptions& options, Json& results) {
  if (!options.json)
    writeStdout(fmt::format("nephroid {}, {}, {} threads, median and half range of {}\n", version(), readCpuModel(),
                            threadCount(options.technique), options.repeats));
  const SpeedOptions speed{options.technique, options.warmup, options.repeats};
  for (const std::string& scene : options.scenes)
    forEachTechnique(options, [&](const Technique& technique) {
      if (stopToken().requested()) return;
      const SpeedResult result = measureSpeed(scene, technique, speed);
      if (stopToken().requested()) return;
      results.push_back(speedToJson(result));
      if (!options.json) writeStdout(formatSpeed(result));
    });
}

void benchError(const BenchOptions& options, Json& results) {
  const ErrorOptions error{options.technique, options.reference_photons};
  if (!options.json) writeStdout(formatErrorHeader(options.scenes, error));
  const auto add = [&](const ErrorResult& result) {
    results.push_back(errorToJson(result));
    if (!options.json) writeStdout(formatErrorRow(options.scenes, result));
  };
  for (const std::string& scene : options.scenes) {
    const CausticReference reference = renderCausticReference(scene, error);
    add(measureNoise(scene, reference));
    forEachTechnique(options,
                     [&](const Technique& technique) { add(measureError(scene, technique, reference, error)); });
  }
}

void benchRace(const BenchOptions& options, Json& results) {
  const RaceOptions race{options.technique, options.reference, options.mask, options.reference_photons,
                         options.race_seconds};
  std::vector<RaceResult> done;
  for (const std::string& scene : options.scenes) {
    done.push_back(runRace(scene, race));
    results.push_back(raceToJson(done.back()));
    if (!options.json) writeStdout(formatRace(done.back()));
    if (options.svg.empty()) continue;
    const std::string drawing = drawRace(done);
    writeFileAtomically(options.svg, std::as_bytes(std::span(drawing)));
  }
}

/// What bench/scenes.json has for closed forms, and the command line.
ClosedFormOptions readClosedFormOptions(const BenchOptions& options) {
  const Json list = Json::parse(kBenchScenes)["closed-form"];
  const auto count = [&](const char* key) { return parseCount(key, list[key].get<std::string>()); };
  return {options.technique, list["frame-set"].get<std::vector<std::string>>(), count("eye-samples"), count("frames")};
}

std::vector<std::string> readClosedFormEstimators() {
  return Json::parse(kBenchScenes)["closed-form"]["estimators"].get<std::vector<std::string>>();
}

void benchClosedForm(const BenchOptions& options, Json& results) {
  ClosedFormOptions closed = readClosedFormOptions(options);
  std::vector<Drawer> drawers =
      listDrawers(chooseTechniques(options), closed.technique.parameters, readClosedFormEstimators());
  if (drawers.empty()) throw UsageError("--set estimator=: the technique has no estimators to choose from");
  checkParameters(closed.technique.parameters, drawers);
  std::vector<const closed_form::ClosedForm*> forms;
  for (const std::string& name : options.scenes) forms.push_back(&closed_form::findClosedForm(name));
  if (!options.json) writeStdout(formatClosedFormHeader());
  for (const closed_form::ClosedForm* form : forms)
    for (const Drawer& drawer : drawers)
      whereThereIsADevice(options, *drawer.technique, [&] {
        for (const ClosedFormRow& row : measureClosedForm(*form, drawer, closed)) {
          results.push_back(closedFormToJson(row));
          if (!options.json) writeStdout(formatClosedFormRow(row));
        }
      });
}

ExitCode runBench(BenchOptions options, const CLI::App& app) {
  checkOptions(options, app);
  completeOptions(options, app);
  Json run = describeRun(options);
  try {
    (options.closed_form ? benchClosedForm
     : options.race      ? benchRace
     : options.error     ? benchError
                         : benchSpeed)(options, run["results"]);
  } catch (const InterruptedError&) {  // what was measured before is whole, and is told
  }
  if (options.json) writeStdout(run.dump(2) + "\n");
  return stopToken().requested() ? ExitCode::kInterrupted : ExitCode::kDone;
}

/// What --help says of the defaults of all kinds.
TechniqueDefaults describeAllDefaults() {
  TechniqueOptions speed, error;
  const auto apply = [](TechniqueOptions& options, const Defaults& defaults) {
    options.size = defaults.size, options.samples = defaults.samples, options.photons = defaults.photons;
    return describeDefaults(options);
  };
  const TechniqueDefaults a = apply(speed, readDefaults("speed")), b = apply(error, readDefaults("error"));
  const auto both = [](const std::string& first, const std::string& second) {
    return fmt::format("{}, with --error {}", first, second);
  };
  const Size race = readDefaults("race").size;
  const Json closed_form = Json::parse(kBenchScenes)["closed-form"];
  const auto count = [&](const char* key) { return closed_form[key].get<std::string>(); };
  return {both("all", "all that draw caustics in real time") + ", with --closed-form reference and those",
          fmt::format("{}, with --race {}x{}", both(a.size, b.size), race.width, race.height),
          both(a.photons, b.photons) + ", with --closed-form what each form needs",
          fmt::format("{}, with --closed-form {} of the reference and {} of others", both(a.samples, b.samples),
                      count("eye-samples"), count("frames"))};
}

}  // namespace

Command addBenchCommand(CLI::App& root) {
  const auto options = std::make_shared<BenchOptions>();
  const Defaults speed = readDefaults("speed"), error = readDefaults("error"), race = readDefaults("race");
  options->reference_photons = error.reference_photons;
  CLI::App* app = addCommand(root, "bench",
                             "Measure speed and memory of each technique on each scene, its error against the "
                             "reference or against formulas, or the error over CPU time of the reference's own "
                             "estimators.",
                             kExamples);
  addArguments(*app, "SCENES", options->scenes, "SCENE",
               {"Scenes, as for render; with --closed-form, names of closed forms.",
                fmt::format("{}; with --error {}; with --race {}; with --closed-form all", fmt::join(speed.scenes, " "),
                            fmt::join(error.scenes, " "), fmt::join(race.scenes, " ")),
                "", ""});
  addTechniqueOptions(*app, options->technique, options->only_technique, describeAllDefaults());
  addValue(*app, "--warmup", options->warmup, "N",
           {"Renders before the measured ones.", "1", fmt::format("0 to {}", kMaxRepeats), ""},
           checkNumber(0, kMaxRepeats));
  addValue(*app, "--repeats", options->repeats, "N",
           {"Measured renders per scene and technique.", "5", fmt::format("1 to {}", kMaxRepeats), ""},
           checkNumber(1, kMaxRepeats));
  addSwitch(*app, "--error", options->error,
            "Instead of speed, tell how far the caustics of each technique are from the reference's: relMSE, FLIP, "
            "energy, and the share of flux that was lost.");
  addSwitch(*app, "--race", options->race,
            "Instead of speed, let the estimators of the technique 'reference' race: nRMSE, L1 and relMSE of direct + "
            "caustic over the CPU time that it took from the scene to the finished file.");
  addSwitch(*app, "--closed-form", options->closed_form,
            "Instead of speed, tell how far each technique is from pictures that can be worked out with pen and paper: "
            "slab, water, ball, ring, prism, drop, mirrors, a shadow's edge; with the tolerance and whether it holds. "
            "Of the technique 'reference' by the estimators light and footprint, or those of --set estimator=.");
  addValue(*app, "--race-seconds", options->race_seconds, "S",
           {"With --race: no render is begun that would take longer.", "20", "0.001 to 1e7", "CPU s"},
           checkNumber(1e-3, 1e7));
  addCount(
      *app, "--reference-photons", options->reference_photons,
      {"With --error and --race: photons of the reference; with --error the table shows what their noise makes of "
       "each figure.",
       fmt::format("{}, with --race {}", error.reference_photons, race.reference_photons), "2 to 9e15", "photons"});
  addValue(
      *app, "--reference", options->reference, "FILE",
      {"With --race and one scene: a picture to compare with, whose layers direct and caustic are added, or beauty "
       "is taken where it lacks them.",
       "one of --reference-photons by light tracing", "", ""});
  addValue(*app, "--mask", options->mask, "FILE",
           {"With --race: a PNG of the same size; pixels of value 255 count.", "all", "", ""});
  addValue(*app, "--svg", options->svg, "FILE", {"With --race: also draws the curves.", "none", "*.svg", ""});
  addSwitch(*app, "--json", options->json, "Print JSON, with every value.");
  return {app, [options, app] { return runBench(*options, *app); }};
}

}  // namespace nephroid::cli
