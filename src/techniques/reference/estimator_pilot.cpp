#include "techniques/reference/estimator_pilot.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include "core/parallel.h"
#include "techniques/reference/path_tracer.h"
#include "techniques/reference/photon_batch.h"

namespace nephroid {
namespace {

/// Pixels of the small picture: each is a place where the light may be another.
constexpr double kPixels = 384.0;
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
/// As in metrics (DESIGN, "Error figures").
constexpr double kRelativeFloor = 0.01;
constexpr std::uint32_t kPilotSeed = 0x9110700DU;

/// The picture of each pass, summed, and how passes differ.
class Spread {
 public:
  explicit Spread(std::size_t pixels) : sums_(pixels, dvec3(0.0)), squares_(sums_) {}

  /// @param plane  holds the sum of all passes so far  @param scale  to radiance
  void close(const FilmPlane& plane, double scale = 1.0) {
    for (std::size_t pixel = 0; pixel < sums_.size(); ++pixel) {
      const dvec3 sum = scale * plane.at(pixel), gained = sum - sums_[pixel];
      sums_[pixel] = sum;
      squares_[pixel] += gained * gained;
      const double brightness = std::max({gained.x, gained.y, gained.z});
      light_ += brightness, light_squared_ += brightness * brightness;
    }
    ++passes_;
  }

  double contributions() const { return light_squared_ > 0.0 ? light_ * light_ / light_squared_ : 0.0; }
  dvec3 meanAt(std::size_t pixel) const { return sums_[pixel] / passes_; }
  std::size_t pixels() const { return sums_.size(); }
  double total() const {
    double total = 0.0;
    for (std::size_t pixel = 0; pixel < sums_.size(); ++pixel) total += luminance(vec3(meanAt(pixel)));
    return total;
  }
  dvec3 varianceOfMeanAt(std::size_t pixel) const {
    const dvec3 mean = meanAt(pixel);
    return glm::max(squares_[pixel] / passes_ - mean * mean, dvec3(0.0)) / (passes_ - 1.0);
  }

 private:
  std::vector<dvec3> sums_, squares_;  ///< by pixel
  double passes_ = 0.0, light_ = 0.0, light_squared_ = 0.0;
};

/// Mean over pixels of squared errors over what the light about there would be. @param squared  by pixel
template <class Squared>
double meanRelative(const std::vector<dvec3>& truth, const Squared& squared) {
  double brightness = 0.0, error = 0.0;
  for (const dvec3& value : truth) brightness += value.x + value.y + value.z;
  const double samples = 3.0 * static_cast<double>(truth.size());
  const double floor = kRelativeFloor * brightness / samples;
  if (floor <= 0.0) return 0.0;
  for (std::size_t pixel = 0; pixel < truth.size(); ++pixel) {
    const dvec3 relative = squared(pixel) / (truth[pixel] * truth[pixel] + floor * floor);
    error += relative.x + relative.y + relative.z;
  }
  return error / samples;
}

/// Means over 5 × 5 pixels: few passes know the light of a pixel badly, and an estimate that is divided by itself hides
/// how rare the paths are that found it.
std::vector<dvec3> blur(const std::vector<dvec3>& picture, int width, int height) {
  std::vector<dvec3> blurred;
  for (int y = 0; y < height; ++y) {
    for (int x = 0; x < width; ++x) {
      dvec3 sum(0.0);
      int count = 0;
      for (int j = std::max(0, y - 2); j <= std::min(height - 1, y + 2); ++j)
        for (int i = std::max(0, x - 2); i <= std::min(width - 1, x + 2); ++i, ++count)
          sum += picture[static_cast<std::size_t>(j) * width + i];
      blurred.push_back(sum / static_cast<double>(count));
    }
  }
  return blurred;
}

bool allLightsHaveASize(const SceneData& scene) {
  return std::none_of(scene.lights.begin(), scene.lights.end(), [](const Light& light) {
    return light.kind == LightKind::kSun ? light.angle_deg == 0.0F : light.radius == 0.0F;
  });
}

/// The world through another camera, with other random numbers, while this lives.
class PilotView {
 public:
  PilotView(ReferenceWorld& world, const CameraModel& camera)
      : world_(world), camera_(world.camera_model), seed_(world.options.seed) {
    world.camera_model = camera;
    world.options.seed = kPilotSeed;
  }
  ~PilotView() {
    world_.camera_model = camera_;
    world_.options.seed = seed_;
  }
  PilotView(const PilotView&) = delete;
  PilotView& operator=(const PilotView&) = delete;

 private:
  ReferenceWorld& world_;
  CameraModel camera_;
  std::uint32_t seed_;
};

/// One pass of paths. @return rays
double tracePass(const PathTracer& tracer, std::uint32_t pass, Film& film) {
  std::vector<PathCounters> rows(static_cast<std::size_t>(film.height));
  parallelFor(rows.size(), [&](std::size_t row) {
    for (int x = 0; x < film.width; ++x) tracer.tracePath(x, static_cast<int>(row), pass, film, rows[row]);
  });
  double rays = 0.0;
  for (const PathCounters& row : rows) rays += static_cast<double>(row.rays);
  return rays;
}

/// Passes of one estimator and what they cost, in eye rays.
struct Trial {
  explicit Trial(std::size_t pixels) : spread(pixels) {}
  Spread spread;
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
      trial_.cost += tracePass(tracer_, trial_.passes, film_);
      trial_.spread.close(film_.*plane_);
    }
  }
  bool isHopeless() const { return trial_.spread.contributions() < kFirstContributions; }
  /// @param is_blurred  by kernels, as paths are not
  EstimatorFigures compare(const Trial& photons, bool is_blurred) const {
    const Spread &a = photons.spread, &b = trial_.spread;
    std::vector<dvec3> means;
    for (std::size_t pixel = 0; pixel < a.pixels(); ++pixel) means.push_back(0.5 * (a.meanAt(pixel) + b.meanAt(pixel)));
    const std::vector<dvec3> truth = blur(means, film_.width, film_.height);
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
    caustic_.spread.close(film_.caustic);
    for (const PhotonBatch::Chunk& chunk : batch.chunks())
      caustic_.cost += kPhotonRayCost * static_cast<double>(chunk.tally.rays);
    ++caustic_.passes;
  }
  void gatherFrom(const PhotonBatch& batch, std::uint32_t index) {
    gathered_.take(batch, index);
    for (std::uint32_t pass = 0; pass < kPassesPerBatch; ++pass)
      eye_rays_ += tracePass(path_tracer_, index * kPassesPerBatch + pass, film_);
    specular_caustic_.spread.close(film_.specular_caustic, 1.0 / kPassesPerBatch);
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
  const double scale = std::sqrt(kPixels / (static_cast<double>(width) * height));
  const auto scaled = [&](int side) { return std::max(1, static_cast<int>(std::lround(side * scale))); };
  const PilotView view(world, CameraModel(camera, scaled(width), scaled(height)));

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
