#include "techniques/reference/estimator.h"

#include <algorithm>
#include <array>

#include "techniques/reference/footprint_pilot.h"

namespace nephroid {
namespace {

constexpr std::array<std::string_view, 6> kNames{"light", "footprint", "photon-map", "path", "manifold", "vcm"};

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
      "how well it does (no dispersion); auto: footprint, or light where errors are to be estimated",
      choices};
}

Estimator chooseEstimator(std::string_view name, bool estimates_errors) {
  const auto found = std::find(kNames.begin(), kNames.end(), name);
  if (found != kNames.end()) return static_cast<Estimator>(found - kNames.begin());
  return estimates_errors ? Estimator::kLight : Estimator::kFootprint;
}

std::string_view nameOf(Estimator estimator) { return kNames[static_cast<std::size_t>(estimator)]; }

std::vector<std::string> estimatorNames() { return {kNames.begin(), kNames.end()}; }

void FootprintSpread::apply(const ReferenceWorld& world, LightTracer& tracer, PhotonBatch& batch) {
  view = std::make_unique<ReceiverView>(world);
  tracer.spreadOver(view.get());
  overlaps = chooseFootprintOverlaps(tracer, batch.shares(), world.options.seed);
  batch.spreadOver(view.get(), overlaps);
}

void describeEstimators(Estimator estimator, const LayerNeeds& needs, std::map<std::string, std::string>& metadata) {
  if (needs.caustic || needs.irradiance_caustic) metadata["estimator.caustic"] = nameOf(estimator);
  if (needs.throughSpecular())
    metadata["estimator.specular_caustic"] = nameOf(
        estimator == Estimator::kLight || estimator == Estimator::kFootprint ? Estimator::kPhotonMap : estimator);
}

}  // namespace nephroid
