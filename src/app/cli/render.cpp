// `nephroid render`: a scene in, pictures out.
#include <fmt/format.h>

#include <chrono>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <optional>

#include "app/cli/command.h"
#include "app/cli/memory.h"
#include "app/cli/options.h"
#include "app/cli/picture.h"
#include "app/cli/progress_bar.h"
#include "app/cli/scene_options.h"
#include "app/cli/stop.h"
#include "app/cli/technique_options.h"
#include "app/cli/terminal.h"
#include "core/file.h"
#include "nephroid/nephroid.h"
#include "scene/edit.h"
#include "scene/report.h"
#include "techniques/layers.h"
#include "techniques/technique.h"

namespace nephroid::cli {
namespace {

using Json = nlohmann::ordered_json;

constexpr const char* kExamples = R"(Examples:
  nephroid render builtin:ring -o ring.png
  nephroid render glass.glb -o glass.exr --aov beauty,direct,caustic --samples 256
  nephroid render builtin:prism -o prism.png --material 'prism:abbe=20' --seconds 10
  nephroid render builtin:pool -o pool.png --frames 1..48 --fps 24
  nephroid render cup.glb -o cup.png --light sun:azimuth=30,elevation=40,irradiance=10)";

struct RenderOptions {
  SceneOptions scene;
  TechniqueOptions technique;
  PictureOptions picture;
  std::string camera, output, frames;
  std::string aov = "beauty";
  float fps = 24;
  double target_error = 0;
  CheckpointSettings checkpoint;
  bool stats = false, verbose = false, json = false;
};

/// What a run has to say on stdout with --json.
struct Outcome {
  std::vector<std::string> files;
  RenderResult result;
  std::vector<std::string> warnings, diagnosis;
};

/// First and last frame of "A..B".
struct FrameRange {
  int first = 0, last = 0;
};

std::optional<FrameRange> parseFrames(const std::string& text) {
  if (text.empty()) return std::nullopt;
  constexpr std::uint64_t kMaxFrame = 9999;  // what %04d keeps in order
  const std::size_t dots = text.find("..");
  if (dots == std::string::npos)
    throw UsageError(fmt::format("--frames: '{}' is no range; write A..B, such as 1..48", text));
  const std::uint64_t first = parseCount("--frames", text.substr(0, dots));
  const std::uint64_t last = parseCount("--frames", text.substr(dots + 2));
  if (first > last || last > kMaxFrame)
    throw UsageError(fmt::format("--frames: '{}' is no range; 0 <= A <= B <= {} is expected", text, kMaxFrame));
  return FrameRange{static_cast<int>(first), static_cast<int>(last)};
}

std::string frameName(const std::string& output, int frame) {
  const std::filesystem::path path(output);
  return (path.parent_path() / fmt::format("{}_{:04}{}", path.stem().string(), frame, path.extension().string()))
      .string();
}

std::map<std::string, std::string> describeRun(const RenderOptions& options, float time_s) {
  std::map<std::string, std::string> facts = describeSceneOptions(options.scene);
  facts["time"] = fmt::format("{}", time_s);
  facts["version"] = std::string(version());
  facts["camera"] = options.camera.empty() ? "0" : options.camera;
  return facts;
}

/// What varies between equal runs; only with --stats, so that equal runs write equal files.
void addStats(std::map<std::string, std::string>& facts, const RenderStats& stats, int threads) {
  for (const StageTime& stage : stats.stages)
    facts["stats." + stage.name + "_s"] = fmt::format("{:.6f}", stage.seconds);
  facts["stats.rays"] = fmt::format("{}", stats.rays);
  facts["stats.photons"] = fmt::format("{}", stats.photons);
  facts["stats.samples"] = fmt::format("{}", stats.samples);
  facts["stats.not_finite"] = fmt::format("{}", stats.not_finite);
  facts["stats.threads"] = fmt::format("{}", threads);
}

void printVerbose(const Outcome& outcome) {
  const RenderStats& stats = outcome.result.stats;
  writeStderr(fmt::format("{:<24} {:>10}", "technique", outcome.result.image.metadata.at("technique")));
  for (const StageTime& stage : stats.stages) writeStderr(fmt::format("{:<24} {:10.3f} s", stage.name, stage.seconds));
  writeStderr(fmt::format("{:<24} {:>10}\n{:<24} {:>10}\n{:<24} {:>10}", "rays", stats.rays, "photons", stats.photons,
                          "samples per pixel", stats.samples));
  if (stats.not_finite > 0) writeStderr(fmt::format("{:<24} {:>10}", "dropped, not finite", stats.not_finite));
  if (!outcome.result.ledgers.empty()) writeStderr(formatLedgers(outcome.result.ledgers));
  for (const std::string& note : outcome.result.notes) writeStderr("note: " + note);
  for (const std::string& line : outcome.diagnosis) writeStderr("diagnosis: " + line);
}

Json toJson(const Outcome& outcome) {
  const RenderStats& stats = outcome.result.stats;
  Json stages = Json::object();
  for (const StageTime& stage : stats.stages) stages[stage.name] = stage.seconds;
  return {{"files", outcome.files},
          {"width", outcome.result.image.width},
          {"height", outcome.result.image.height},
          {"metadata", outcome.result.image.metadata},
          {"interrupted", outcome.result.interrupted},
          {"stages_s", stages},
          {"rays", stats.rays},
          {"photons", stats.photons},
          {"samples", stats.samples},
          {"not_finite", stats.not_finite},
          {"ledgers", Json::parse(formatLedgersJson(outcome.result.ledgers))},
          {"warnings", outcome.warnings},
          {"notes", outcome.result.notes},
          {"diagnosis", outcome.diagnosis}};
}

/// Renders and writes one picture.
/// @throws Error
Outcome renderPicture(const RenderOptions& options, const RenderSettings& settings, const std::string& output,
                      float time_s, const std::string& title) {
  const auto start = std::chrono::steady_clock::now();
  const SceneData scene = loadEditedScene(options.scene, time_s);
  const Camera camera = selectCamera(scene, options.camera.empty() ? "0" : options.camera);
  const double load_s = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  if (stopToken().requested()) throw InterruptedError("interrupted while loading; nothing was drawn");

  Outcome outcome;
  {
    ProgressBar bar(title);
    outcome.result = findTechnique(options.technique.name).render(scene, camera, settings, &bar, &stopToken());
  }
  outcome.result.stats.stages.insert(outcome.result.stats.stages.begin(), {"load", load_s});
  outcome.result.image.metadata.merge(describeRun(options, time_s));
  if (options.stats) addStats(outcome.result.image.metadata, outcome.result.stats, settings.threads);
  outcome.warnings = scene.warnings;
  outcome.diagnosis = diagnoseLedgers(outcome.result.ledgers);
  if (outcome.result.ledgers.empty()) outcome.diagnosis = inspectScene(scene).diagnosis;
  outcome.files = writePicture(output, outcome.result.image, options.picture);
  return outcome;
}

/// Each layer is held at least twice: where it is summed, and as the picture.
double estimateMemory(const RenderSettings& settings) {
  constexpr double kBytesPerMib = 1 << 20;
  int channels = 0;
  for (const std::string& layer : settings.layers) channels += findLayerInfo(layer).channels;
  return 2.0 * sizeof(float) * channels * settings.width * settings.height / kBytesPerMib;
}

ExitCode runRender(RenderOptions options) {
  if (options.output.empty()) throw UsageError("render: no output given; add -o picture.png or -o picture.exr");
  const std::vector<std::string> layers = parseLayerList(options.aov);
  const RenderSettings wanted{.layers = layers,
                              .target_error = options.target_error,
                              .checkpoint = options.checkpoint,
                              .device = options.technique.device};
  options.technique.name = chooseTechnique(options.technique.name, wanted).name;
  RenderSettings settings = makeSettings(options.technique);
  settings.ledgers = options.verbose || options.json;
  settings.layers = layers;
  settings.target_error = options.target_error;
  settings.checkpoint = options.checkpoint;
  checkProgressive(findTechnique(options.technique.name), settings);
  const std::optional<FrameRange> frames = parseFrames(options.frames);
  checkPicture(frames ? frameName(options.output, frames->first) : options.output, settings.layers, options.picture);
  if (!options.checkpoint.path.empty()) checkWritable(options.checkpoint.path);

  checkMemory(estimateMemory(settings), readAvailableMemory());

  bool interrupted = false;
  Json report = Json::array();
  const FrameRange range = frames.value_or(FrameRange{0, 0});
  for (int frame = range.first; frame <= range.last && !interrupted; ++frame) {
    const std::string output = frames ? frameName(options.output, frame) : options.output;
    const float time_s = options.scene.time + (frames ? static_cast<float>(frame) / options.fps : 0.0F);
    const std::string title = frames ? fmt::format("frame {}/{}", frame, range.last) : "";
    if (frames && !options.checkpoint.path.empty())
      settings.checkpoint.path = frameName(options.checkpoint.path, frame);
    const Outcome outcome = renderPicture(options, settings, output, time_s, title);
    interrupted = outcome.result.interrupted || stopToken().requested();
    if (options.verbose) printVerbose(outcome);
    for (const std::string& file : outcome.files) writeStderr("wrote " + file);
    if (options.json) report.push_back(toJson(outcome));
    // The picture is safe by now; that it cannot be taken up again must not pass for success.
    if (!outcome.result.checkpoint_failure.empty()) throw ResourceError(outcome.result.checkpoint_failure);
  }
  if (options.json) writeStdout((frames ? report : report.front()).dump(2) + "\n");
  if (interrupted) writeStderr("interrupted: the last picture holds what was reached");
  return interrupted ? ExitCode::kInterrupted : ExitCode::kDone;
}

void addOutputOptions(CLI::App& app, RenderOptions& options) {
  beginGroup(app, "Output");
  addValue(app, "-o,--output", options.output, "FILE",
           {"Where the picture goes. .exr: every layer, linear; .png: sRGB, beauty or the only layer asked for; each "
            "further layer goes to FILE.LAYER.png.",
            "", "*.exr|*.png", ""});
  std::vector<std::string> names;
  for (const LayerInfo& layer : layerInfos()) names.emplace_back(layer.name);
  addValue(app, "--aov", options.aov, "LAYERS",
           {"Layers, separated by commas. beauty is the sum of emission, direct, caustic, specular and indirect; "
            "docs/cli.md explains each.",
            "beauty", fmt::format("{}", fmt::join(names, "|")), ""});
  addPictureOptions(app, options.picture);
  addSwitch(app, "--stats", options.stats,
            "Also store times, rays and photons in the file; without it, equal runs write equal files.");
  addSwitch(app, "--verbose", options.verbose,
            "Print times, the photon ledger, notes and, where no caustic is seen, why, to stderr.");
  addSwitch(app, "--json", options.json, "Print the same as JSON to stdout.");
  endGroup(app);
}

void addConvergenceOptions(CLI::App& app, RenderOptions& options) {
  beginGroup(app, "Budget");
  addValue(
      app, "--target-error", options.target_error, "X",
      {"Ends the render when relMSE, estimated from the standard errors of the layers asked for, is down to this in "
       "each of them; docs/cli.md explains it. Other budgets that are given still end it.",
       "none", "1e-9 to 10", ""},
      checkNumber(1e-9, 10));
  addValue(
      app, "--checkpoint", options.checkpoint.path, "FILE",
      {"Keeps the render in FILE while it runs and goes on from there if FILE exists; a finished one can be given a "
       "larger budget. With --frames one file for each.",
       "none", "", ""});
  addValue(app, "--checkpoint-every", options.checkpoint.interval_s, "S",
           {"Time between two writings of --checkpoint: what a crash can cost.", "60", "0.1 to 1e6", "s"},
           checkNumber(0.1, 1e6));
  endGroup(app);
}

void addAnimationOptions(CLI::App& app, RenderOptions& options) {
  beginGroup(app, "Animation");
  addValue(app, "--frames", options.frames, "A..B",
           {"Draws frames A to B at time T + frame/F into FILE_0001 and so on.", "one picture", "0 to 9999", ""});
  addValue(app, "--fps", options.fps, "F", {"Frames per second of --frames.", "24", "0.001 to 100000", "1/s"},
           checkNumber(1e-3, 1e5));
  endGroup(app);
}

}  // namespace

Command addRenderCommand(CLI::App& root) {
  const auto options = std::make_shared<RenderOptions>();
  CLI::App* app = addCommand(root, "render", "Draw a picture of a scene, with its caustics.", kExamples);
  addSceneOptions(*app, options->scene);
  addCameraOption(*app, options->camera);
  addOutputOptions(*app, *options);
  addTechniqueOptions(*app, options->technique, options->technique.name, describeDefaults(options->technique));
  addConvergenceOptions(*app, *options);
  addAnimationOptions(*app, *options);
  return {app, [app, options] {
            if (!options->scene.state.empty()) applyStateFile(*app, options->scene.state);
            return runRender(*options);
          }};
}

}  // namespace nephroid::cli
