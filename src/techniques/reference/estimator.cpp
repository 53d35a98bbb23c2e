#include "techniques/reference/estimator.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>

#include "techniques/reference/footprint_pilot.h"

namespace nephroid {
namespace {

constexpr std::array<std::string_view, 6> kNames{"light", "footprint", "photon-map", "path", "manifold", "vcm"};

/// As its name alone says.
EstimatorChoice choiceOfOne(Estimator estimator) {
  const bool only_photons_seen = estimator == Estimator::kLight || estimator == Estimator::kFootprint;
  return {estimator,
          only_photons_seen ? Estimator::kPhotonMap : estimator,
          estimator == Estimator::kPath ? Estimator::kPath : Estimator::kLight,
          {}};
}

std::string formatFigures(const EstimatorFigures& figures) {
  return fmt::format("{:.3g} by photons, {:.3g} by paths, of which {:.0f} contributed and found {:.0f} % of the light",
                     figures.photons, figures.paths, figures.contributions, 100.0 * figures.found);
}

}  // namespace

ParamSpec makeEstimatorParam() {
  std::vector<std::string> choices{"auto"};
  for (const std::string_view name : kNames) choices.emplace_back(name);
  return {
      "estimator",
      std::string("auto"),
      0,
      0,
      "",
      "what makes caustics. light: photons, each for the pixel that sees it; footprint: spread over what neighbours "
      "would cover, less and less; photon-map: gathered under kernels that shrink; path: paths from the eye alone, "
      "for checking (needs lights with a size); manifold: walks from what is seen over one or two smooth interfaces to "
      "the lights, photons for all other ways; vcm: photons seen, gathered and connected, and paths, each weighted by "
      "how well it does (no dispersion); auto: measures whether paths are better, as under large lights; else "
      "footprint, or light where errors of caustics alone are to be estimated",
      choices};
}

EstimatorChoice chooseEstimators(std::string_view name, bool may_blur, ReferenceWorld& world, const Camera& camera,
                                 int width, int height, const LayerNeeds& needs) {
  const auto found = std::find(kNames.begin(), kNames.end(), name);
  if (found != kNames.end()) return choiceOfOne(static_cast<Estimator>(found - kNames.begin()));
  EstimatorChoice choice = choiceOfOne(may_blur ? Estimator::kFootprint : Estimator::kLight);
  choice.figures = measureEstimators(world, camera, width, height, needs);
  const auto isWon = [](const std::optional<EstimatorFigures>& f) { return f && f->pathsAreBetter(); };
  // Smooth, and beside all other light.
  if (may_blur && needs.beauty) choice.indirect = Estimator::kPhotonMap;
  if (isWon(choice.figures.caustic)) choice.caustic = Estimator::kPath;
  if (isWon(choice.figures.specular_caustic)) choice.specular_caustic = Estimator::kPath;
  return choice;
}

std::string_view nameOf(Estimator estimator) { return kNames[static_cast<std::size_t>(estimator)]; }

std::vector<std::string> estimatorNames() { return {kNames.begin(), kNames.end()}; }

PhotonPaths photonPathsOf(const EstimatorChoice& choice) {
  return {.caustic = choice.caustic != Estimator::kPath,
          .indirect = choice.indirect != Estimator::kPath,
          .specular_caustic = choice.specular_caustic != Estimator::kPath,
          .specular_indirect =
              choice.specular_caustic == Estimator::kPhotonMap || choice.specular_caustic == Estimator::kManifold};
}

void FootprintSpread::apply(const ReferenceWorld& world, LightTracer& tracer, PhotonBatch& batch) {
  view = std::make_unique<ReceiverView>(world);
  tracer.spreadOver(view.get());
  overlaps = chooseFootprintOverlaps(tracer, batch.shares(), world.options.seed);
  batch.spreadOver(view.get(), overlaps);
}

void describeEstimators(const EstimatorChoice& choice, const LayerNeeds& needs,
                        std::map<std::string, std::string>& metadata) {
  if (needs.caustic || needs.irradiance_caustic) metadata["estimator.caustic"] = nameOf(choice.caustic);
  if (needs.throughSpecular()) metadata["estimator.specular_caustic"] = nameOf(choice.specular_caustic);
  if (needs.indirect) metadata["estimator.indirect"] = nameOf(choice.indirect);
  const PilotFigures& figures = choice.figures;
  if (figures.caustic) metadata["estimator.caustic.measured"] = formatFigures(*figures.caustic);
  if (figures.specular_caustic)
    metadata["estimator.specular_caustic.measured"] = formatFigures(*figures.specular_caustic);
}

std::vector<std::string> explainEstimators(const EstimatorChoice& choice) {
  std::vector<std::string> sentences;
  const auto explain = [&](std::string_view layer, Estimator chosen, const std::optional<EstimatorFigures>& figures) {
    if (figures)
      sentences.push_back(
          fmt::format("{} by {}: relMSE at equal cost is {}", layer, nameOf(chosen), formatFigures(*figures)));
  };
  explain("caustic", choice.caustic, choice.figures.caustic);
  explain("specular_caustic", choice.specular_caustic, choice.figures.specular_caustic);
  return sentences;
}

}  // namespace nephroid
