#include "techniques/reference/estimator_pilot.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include "techniques/reference/photon_batch.h"
#include "techniques/reference/pilot.h"

namespace nephroid {
namespace {

/// Passes of paths that tell whether lights are met at all: scenes with small lights pay for these alone.
constexpr std::uint32_t kFirstPasses = 8;
/// Passes and batches from whose spread variances are taken: known to a quarter in each pixel, to far less in the mean.
constexpr std::uint32_t kPasses = 32, kBatches = 8;
/// Of a batch, and passes from the eye that gather it: kernels are about as wide as a pixel, as in larger pictures, and
/// each direction takes about as many rays.
constexpr std::uint32_t kBatchPhotons = 4096, kPassesPerBatch = 4;
/// Effective contributions that the first passes, and then all, must have.
constexpr double kFirstContributions = 4.0, kFewestContributions = 50.0;
/// Share of the photons' light that paths must have met.
constexpr double kFewestFound = 0.8;
/// By which paths must be better: figures are known to some ten per cent, and footprints do better than what is
/// measured of photons.
constexpr double kLeastGain = 2.0;
/// Time of a photon's ray over that of a ray from the eye: 1.3 on `pool`, 1.6 on `coffee`, 2.7 on `sphere`.
constexpr double kPhotonRayCost = 1.6;
/// Mean squared bias of a whole batch (2¹⁸ photons) over that of a batch here. A kernel errs most at the edges of light
/// and of surfaces, and pixels near those are the fewer the narrower it is: as the root of the photons.
constexpr double kBiasOfWholeBatches = 0.125;
static_assert(kBiasOfWholeBatches * kBiasOfWholeBatches * PhotonBatch::kMaxPhotons == kBatchPhotons);

/// Mean over pixels of squared errors over what the light about there would be. @param squared  by pixel
template <class Squared>
double meanRelative(const std::vector<dvec3>& truth, const Squared& squared) {
  const double floor = pilotFloor(truth);
  if (floor <= 0.0) return 0.0;
  double error = 0.0;
  for (std::size_t pixel = 0; pixel < truth.size(); ++pixel) {
    const dvec3 relative = squared(pixel) / (truth[pixel] * truth[pixel] + floor * floor);
    error += relative.x + relative.y + relative.z;
  }
  return error / (3.0 * static_cast<double>(truth.size()));
}

bool allLightsHaveASize(const SceneData& scene) {
  return std::none_of(scene.lights.begin(), scene.lights.end(), [](const Light& light) {
    return light.kind == LightKind::kSun ? light.angle_deg == 0.0F : light.radius == 0.0F;
  });
}

/// Passes of one estimator and what they cost, in eye rays.
struct Trial {
  explicit Trial(std::size_t pixels) : spread(pixels) {}
  PilotSpread spread;
  double cost = 0.0;
  std::uint32_t passes = 0;
};

/// One kind of caustic by paths from the eye alone.
class PathTrial {
 public:
  PathTrial(const ReferenceWorld& world, const char* layer, FilmPlane Film::*plane)
      : needs_({layer}),
        tracer_(world, needs_),
        film_(world.camera_model.width(), world.camera_model.height(), needs_),
        plane_(plane),
        trial_(static_cast<std::size_t>(film_.width) * film_.height) {}

  /// Up to so many passes in all.
  void trace(std::uint32_t passes) {
    for (; trial_.passes < passes; ++trial_.passes) {
      trial_.cost += tracePilotPass(tracer_, trial_.passes, film_);
      trial_.spread.close([&](std::size_t pixel) { return (film_.*plane_).at(pixel); });
    }
  }
  bool isHopeless() const { return trial_.spread.contributions() < kFirstContributions; }
  /// @param is_blurred  by kernels, as paths are not
  EstimatorFigures compare(const Trial& photons, bool is_blurred) const {
    const PilotSpread &a = photons.spread, &b = trial_.spread;
    std::vector<dvec3> means;
    for (std::size_t pixel = 0; pixel < a.pixels(); ++pixel) means.push_back(0.5 * (a.meanAt(pixel) + b.meanAt(pixel)));
    const std::vector<dvec3> truth = blurPilot(means, film_.width, film_.height);
    EstimatorFigures figures;
    figures.photons = meanRelative(truth, [&](std::size_t pixel) { return a.varianceOfMeanAt(pixel); });
    if (is_blurred) {
      const double squared_bias = meanRelative(truth, [&](std::size_t pixel) {
        const dvec3 difference = a.meanAt(pixel) - b.meanAt(pixel);
        return difference * difference - a.varianceOfMeanAt(pixel) - b.varianceOfMeanAt(pixel);
      });
      figures.photons += kBiasOfWholeBatches * std::max(squared_bias, 0.0);
    }
    figures.paths =
        meanRelative(truth, [&](std::size_t pixel) { return b.varianceOfMeanAt(pixel); }) * trial_.cost / photons.cost;
    figures.contributions = b.contributions();
    figures.found = a.total() > 0.0 ? b.total() / a.total() : 0.0;
    return figures;
  }

 private:
  LayerNeeds needs_;
  PathTracer tracer_;
  Film film_;
  FilmPlane Film::*plane_;
  Trial trial_;
};

/// Both kinds by photons: seen by the camera, and gathered.
class PhotonTrial {
 public:
  explicit PhotonTrial(const ReferenceWorld& world)
      : needs_({"caustic", "specular_caustic"}),
        gathering_needs_({"specular_caustic"}),
        light_tracer_(world, {.caustic = true}),
        path_tracer_(world, gathering_needs_),
        film_(world.camera_model.width(), world.camera_model.height(), needs_),
        caustic_(static_cast<std::size_t>(film_.width) * film_.height),
        specular_caustic_(caustic_) {
    light_tracer_.keepDeposits(false);
    const PhotonPaths gathered{.specular_caustic = true};
    path_tracer_.leaveToPhotons(gathered);
    path_tracer_.gatherFrom(&gathered_, gathered);
  }

  bool reachesAnything() const { return !light_tracer_.emitters().empty(); }
  void trace(bool gather) {
    PhotonBatch batch(light_tracer_, kBatchPhotons, film_.width, film_.height);
    for (std::uint32_t i = 0; i < kBatches; ++i) {
      batch.trace(i, [] { return false; });
      see(batch);
      if (gather) gatherFrom(batch, i);
    }
  }
  const Trial& caustic() const { return caustic_; }
  const Trial& specularCaustic() const { return specular_caustic_; }

 private:
  void see(const PhotonBatch& batch) {
    batch.visitSplats([&](const Splat& splat, std::uint32_t pixel, std::span<const float> weights) {
      for (std::size_t k = 0; k < weights.size(); ++k) film_.caustic.add(pixel + k, splat.radiance * weights[k]);
    });
    caustic_.spread.close([&](std::size_t pixel) { return film_.caustic.at(pixel); });
    for (const PhotonBatch::Chunk& chunk : batch.chunks())
      caustic_.cost += kPhotonRayCost * static_cast<double>(chunk.tally.rays);
    ++caustic_.passes;
  }
  void gatherFrom(const PhotonBatch& batch, std::uint32_t index) {
    gathered_.take(batch, index);
    for (std::uint32_t pass = 0; pass < kPassesPerBatch; ++pass)
      eye_rays_ += tracePilotPass(path_tracer_, index * kPassesPerBatch + pass, film_);
    specular_caustic_.spread.close(
        [&](std::size_t pixel) { return film_.specular_caustic.at(pixel) / (1.0 * kPassesPerBatch); });
    specular_caustic_.cost = caustic_.cost + eye_rays_;
    ++specular_caustic_.passes;
  }

  LayerNeeds needs_, gathering_needs_;
  LightTracer light_tracer_;
  PathTracer path_tracer_;
  GatheredPhotons gathered_;
  Film film_;
  Trial caustic_, specular_caustic_;
  double eye_rays_ = 0.0;
};

}  // namespace

bool EstimatorFigures::pathsAreBetter() const {
  return contributions >= kFewestContributions && found >= kFewestFound && kLeastGain * paths <= photons;
}

PilotFigures measureEstimators(ReferenceWorld& world, const Camera& camera, int width, int height,
                               const LayerNeeds& needs) {
  PilotFigures figures;
  if (!allLightsHaveASize(world.scene.scene())) return figures;
  const PilotView view(world, camera, width, height);

  std::optional<PathTrial> caustic, specular_caustic;
  const auto begin = [&](std::optional<PathTrial>& trial, const char* layer, FilmPlane Film::*plane) {
    trial.emplace(world, layer, plane);
    trial->trace(kFirstPasses);
    if (trial->isHopeless()) trial.reset();
  };
  if (needs.caustic || needs.irradiance_caustic) begin(caustic, "caustic", &Film::caustic_from_eye);
  if (needs.throughSpecular()) begin(specular_caustic, "specular_caustic", &Film::specular_caustic);
  if (!caustic && !specular_caustic) return figures;
  PhotonTrial photons(world);
  if (!photons.reachesAnything()) return figures;
  photons.trace(specular_caustic.has_value());
  if (caustic) {
    caustic->trace(kPasses);
    figures.caustic = caustic->compare(photons.caustic(), false);
  }
  if (specular_caustic) {
    specular_caustic->trace(kPasses);
    figures.specular_caustic = specular_caustic->compare(photons.specularCaustic(), true);
  }
  return figures;
}

}  // namespace nephroid
