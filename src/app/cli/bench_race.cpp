#include "app/cli/bench_race.h"

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <ctime>
#include <filesystem>
#include <nlohmann/json.hpp>

#include "app/cli/comparison.h"
#include "app/cli/plot_svg.h"
#include "app/cli/progress_bar.h"
#include "app/cli/scene_options.h"
#include "app/cli/stop.h"
#include "core/image/image_io.h"
#include "nephroid/error.h"
#include "scene/edit.h"

namespace nephroid::cli {
namespace {

/// Photons of an estimator's first render.
constexpr std::uint64_t kFirstPhotons = 1 << 15;
/// Samples per pixel of a reference of its own: direct light is far better known then than in the race.
constexpr std::uint64_t kReferenceSamples = 256;
constexpr const char* kCompared = "direct+caustic";
constexpr const char* kMetrics = "nrmse,l1,relmse";

/// A folder that is gone afterwards.
class ScratchFolder {
 public:
  ScratchFolder() : path_(std::filesystem::temp_directory_path() / fmt::format("nephroid-race-{}", getpid())) {
    std::filesystem::create_directories(path_);
  }
  ~ScratchFolder() {
    std::error_code ignored;  // what cannot be removed is in the folder for what may be
    std::filesystem::remove_all(path_, ignored);
  }
  ScratchFolder(const ScratchFolder&) = delete;
  ScratchFolder& operator=(const ScratchFolder&) = delete;
  std::string file(const char* name) const { return (path_ / name).string(); }

 private:
  std::filesystem::path path_;
};

/// User and system time of all threads of this process, s.
double readCpuSeconds() {
  timespec now{};
  clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &now);
  return static_cast<double>(now.tv_sec) + 1e-9 * static_cast<double>(now.tv_nsec);
}

/// From the scene to the finished file. @return CPU time, s
double renderToFile(const std::string& scene_name, const TechniqueOptions& options, const std::string& file,
                    const std::string& title) {
  const double start = readCpuSeconds();
  const SceneData scene = loadEditedScene({.scene = scene_name}, 0.0F, false);
  RenderSettings settings = makeSettings(options);
  settings.layers = {"direct", "caustic", "specular"};
  ProgressBar bar(title);
  const RenderResult result =
      findTechnique(options.name).render(scene, selectCamera(scene, "0"), settings, &bar, &stopToken());
  if (stopToken().requested()) throw InterruptedError("interrupted: the figures so far are complete");
  writeExr(file, result.image);
  return readCpuSeconds() - start;
}

/// What estimators that the command line names, or all.
std::vector<std::string> chooseEstimators(TechniqueOptions& technique) {
  constexpr std::string_view kKey = "estimator=";
  std::vector<std::string> chosen;
  std::erase_if(technique.parameters, [&](const std::string& parameter) {
    if (!parameter.starts_with(kKey)) return false;
    chosen.push_back(parameter.substr(kKey.size()));
    return true;
  });
  if (!chosen.empty()) return chosen;
  for (const ParamSpec& spec : findTechnique("reference").params)
    if (spec.name == "estimator")
      for (const std::string& choice : spec.choices)
        if (choice != "auto") chosen.push_back(choice);
  return chosen;
}

/// The layers of a reference file that are compared: the sum where it has both, else its picture.
std::string chooseReferenceLayer(const std::string& file) {
  const LayeredImage image = readExr(file);
  return image.find("direct") != nullptr && image.find("caustic") != nullptr ? kCompared : "beauty";
}

std::string renderReferenceOf(const std::string& scene, const RaceOptions& options, const ScratchFolder& folder) {
  TechniqueOptions reference = options.technique;
  reference.parameters = {"estimator=light"};
  reference.photons = options.reference_photons;
  reference.samples = kReferenceSamples;
  reference.seed = options.technique.seed + 1;  // no photon of those that are compared
  const std::string file = folder.file("reference.exr");
  renderToFile(scene, reference, file, scene + " reference");
  return file;
}

RacePoint compareWith(const std::string& image, const std::string& reference, const std::string& mask) {
  const Comparison comparison = comparePictures({.image = image,
                                                 .reference = reference,
                                                 .layer = kCompared,
                                                 .reference_layer = chooseReferenceLayer(reference),
                                                 .mask = mask,
                                                 .metrics = kMetrics});
  RacePoint point;
  for (const auto& [name, value] : comparison.values)
    (name == "nrmse" ? point.nrmse : name == "l1" ? point.l1 : point.relmse) = value;
  return point;
}

RaceCurve raceEstimator(const std::string& scene, const std::string& estimator, const std::string& reference,
                        const RaceOptions& options, const ScratchFolder& folder) {
  RaceCurve curve{estimator, {}};
  TechniqueOptions technique = options.technique;
  technique.parameters.push_back("estimator=" + estimator);
  const auto pixels =
      static_cast<std::uint64_t>(technique.size.width) * static_cast<std::uint64_t>(technique.size.height);
  const std::string file = folder.file("picture.exr");
  double last_s = 0.0;
  // The next would take about twice as long.
  for (std::uint64_t photons = kFirstPhotons; curve.points.empty() || 2.0 * last_s <= options.seconds; photons *= 2) {
    technique.photons = photons;
    technique.samples = std::max<std::uint64_t>((photons + pixels - 1) / pixels, 1);
    last_s = renderToFile(scene, technique, file, fmt::format("{} {} {} k", scene, estimator, photons / 1000));
    RacePoint point = compareWith(file, reference, options.mask);
    point.cpu_s = last_s;
    point.photons = photons, point.samples = technique.samples;
    curve.points.push_back(point);
  }
  return curve;
}

}  // namespace

RaceResult runRace(const std::string& scene, const RaceOptions& given) {
  RaceOptions options = given;
  options.technique.name = "reference";
  const std::vector<std::string> estimators = chooseEstimators(options.technique);
  const ScratchFolder folder;
  const std::string reference =
      options.reference.empty() ? renderReferenceOf(scene, options, folder) : options.reference;
  RaceResult result{scene, {}};
  for (const std::string& estimator : estimators)
    result.curves.push_back(raceEstimator(scene, estimator, reference, options, folder));
  return result;
}

std::string formatRace(const RaceResult& result) {
  std::string text = fmt::format("{}\n{:<12} {:>9} {:>11} {:>8} {:>9} {:>9} {:>9}\n", result.scene, "estimator",
                                 "CPU s", "photons", "samples", "nRMSE", "L1", "relMSE");
  for (const RaceCurve& curve : result.curves)
    for (const RacePoint& p : curve.points)
      text += fmt::format("{:<12} {:>9.2f} {:>11} {:>8} {:>9.4f} {:>9.4f} {:>9.4g}\n", curve.estimator, p.cpu_s,
                          p.photons, p.samples, p.nrmse, p.l1, p.relmse);
  return text;
}

nlohmann::ordered_json raceToJson(const RaceResult& result) {
  nlohmann::ordered_json curves = nlohmann::ordered_json::array();
  for (const RaceCurve& curve : result.curves) {
    nlohmann::ordered_json points = nlohmann::ordered_json::array();
    for (const RacePoint& p : curve.points)
      points.push_back({{"cpu_s", p.cpu_s},
                        {"photons", p.photons},
                        {"samples", p.samples},
                        {"nrmse", p.nrmse},
                        {"l1", p.l1},
                        {"relmse", p.relmse}});
    curves.push_back({{"estimator", curve.estimator}, {"points", points}});
  }
  return {{"scene", result.scene}, {"curves", curves}};
}

std::string drawRace(const std::vector<RaceResult>& results) {
  struct Figure {
    const char* name;
    double RacePoint::*value;
  };
  std::vector<std::vector<PlotPanel>> rows;
  for (const RaceResult& result : results) {
    std::vector<PlotPanel>& row = rows.emplace_back();
    for (const Figure& figure :
         {Figure{"nRMSE", &RacePoint::nrmse}, Figure{"L1", &RacePoint::l1}, Figure{"relMSE", &RacePoint::relmse}}) {
      PlotPanel panel{std::filesystem::path(result.scene).filename().string(), "CPU seconds", figure.name, {}};
      for (const RaceCurve& curve : result.curves) {
        PlotCurve& drawn = panel.curves.emplace_back(PlotCurve{curve.estimator, {}});
        for (const RacePoint& p : curve.points) drawn.points.emplace_back(p.cpu_s, p.*figure.value);
      }
      row.push_back(panel);
    }
  }
  return drawPlots(rows);
}

}  // namespace nephroid::cli
