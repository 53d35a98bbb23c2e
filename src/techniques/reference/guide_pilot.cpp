#include "techniques/reference/guide_pilot.h"

#include <algorithm>
#include <cmath>
#include <optional>

#include "core/parallel.h"
#include "techniques/reference/path_tracer.h"

namespace nephroid {
namespace {

/// Photons of a batch for each of the pilot: what is learned from fewer is mostly noise, and more cost more than they
/// gain.
constexpr std::uint32_t kPhotonsPerPilot = 16;
/// Where they need only tell blocks whose photons are of use from others, so many times as many: with blocks that need
/// no smoothing a guide is sharper. Such renders are long.
constexpr std::uint32_t kPilotsToPlaces = 4;
/// A pilot is not worth its time, and knows too little, below this.
constexpr std::uint32_t kFewestPilots = 2048;
/// Photons of one task.
constexpr std::uint32_t kChunkPhotons = 256;
/// Pixels along each side of a tile of the picture whose radiance is taken as one: a few photons of the pilot each.
constexpr int kTilePixels = 8;
/// Darker than this share of the mean, an error counts by what it is and not by what is there.
constexpr double kFloor = 0.1;
/// Photons that guiding must bring where they are of use, over those that come there anyway: guided and even ones side
/// by side are less evenly spread than even ones alone.
constexpr double kLeastGain = 1.25;
/// Passes of smoothing: over tiles, and over the blocks of a guide, each of which few photons of the pilot began in.
constexpr int kTilePasses = 1, kBlockPasses = 2;
/// Random numbers of their own: streams of pixels, lights and of the footprints' pilot lie elsewhere.
constexpr std::uint32_t kPilotStream = 0xF0080000U;

/// What a photon of the pilot adds to the pixels about one.
struct Landing {
  std::uint32_t pixel;
  double radiance;       ///< to the pixel if it took all, × emitted count, as luminance
  double concentration;  ///< sum of the squared weights of the pixels: 1 if one takes all
};
struct PilotPhoton {
  std::size_t block = 0;  ///< of the guide
  std::vector<Landing> landings;
  std::vector<vec3> deposits;  ///< where it may be gathered
  bool of_use = false;         ///< lands in sight, or where it is gathered
};

std::size_t blockAt(vec2 place) {
  constexpr int kSide = EmissionGuide::kSide;
  return static_cast<std::size_t>(place.y * kSide) * kSide + static_cast<std::size_t>(place.x * kSide);
}

/// Of the kernel 1 − r² over an ellipse: 4 / (3 · its area), where that is more than a pixel.
double concentrationOf(const FootprintSplat& footprint) {
  const double determinant =
      static_cast<double>(footprint.xx) * footprint.yy - static_cast<double>(footprint.xy) * footprint.xy;
  return std::min(4.0 * std::sqrt(std::max(determinant, 0.0)) / (3.0 * kPi), 1.0);
}

PilotPhoton tracePilotPhoton(const LightTracer& tracer, std::size_t emitter, Sampler sampler,
                             const FootprintScale& spread) {
  PilotPhoton result;
  Sampler place = sampler;
  result.block = blockAt(place.next2D());
  PhotonWave::Photon photon{{}, sampler};
  photon.emitted = tracer.emitters()[emitter]->emit(photon.sampler);
  const PhotonTally tally = tracer.traceAlone(emitter, photon, spread);
  for (const Splat& splat : tally.splats) result.landings.push_back({splat.pixel, luminance(splat.radiance), 1.0});
  for (const FootprintSplat& f : tally.footprints)
    result.landings.push_back({f.splat.pixel, luminance(f.splat.radiance), concentrationOf(f)});
  for (const GridPhoton& deposit : tally.caustic_deposits) result.deposits.push_back(deposit.position);
  result.of_use = !result.landings.empty();
  return result;
}

std::vector<PilotPhoton> tracePilot(const LightTracer& tracer, std::size_t emitter, std::uint32_t count,
                                    const FootprintScale& spread, std::uint32_t seed) {
  std::vector<PilotPhoton> photons(count);
  parallelFor((count + kChunkPhotons - 1) / kChunkPhotons, [&](std::size_t chunk) {
    const auto begin = static_cast<std::uint32_t>(chunk) * kChunkPhotons;
    for (std::uint32_t i = begin; i < std::min(begin + kChunkPhotons, count); ++i)
      photons[i] = tracePilotPhoton(tracer, emitter,
                                    Sampler(seed, kPilotStream + static_cast<std::uint32_t>(emitter), i), spread);
  });
  return photons;
}

/// A grid of numbers that can be smoothed.
struct Plane {
  Plane(int w, int h) : width(w), height(h), values(static_cast<std::size_t>(w) * h, 0.0) {}
  double& at(int x, int y) { return values[static_cast<std::size_t>(y) * width + x]; }
  double clamped(int x, int y) const {
    return values[static_cast<std::size_t>(std::clamp(y, 0, height - 1)) * width + std::clamp(x, 0, width - 1)];
  }
  /// By (1, 2, 1) / 4 along each side.
  void smooth() {
    for (const bool along_x : {true, false}) {
      const Plane before = *this;
      const int dx = along_x ? 1 : 0, dy = along_x ? 0 : 1;
      for (int y = 0; y < height; ++y)
        for (int x = 0; x < width; ++x)
          at(x, y) = 0.25 * (before.clamped(x - dx, y - dy) + before.clamped(x + dx, y + dy)) + 0.5 * at(x, y);
    }
  }
  int width, height;
  std::vector<double> values;
};

/// Radiance about each pixel, as luminance over its mean where there is any.
class RoughPicture {
 public:
  RoughPicture(int width, int height) : width_(width), height_(height), tiles_(tilesAlong(width), tilesAlong(height)) {}

  void add(const std::vector<PilotPhoton>& photons) {
    const double scale = 1.0 / (static_cast<double>(photons.size()) * kTilePixels * kTilePixels);
    for (const PilotPhoton& photon : photons)
      for (const Landing& landing : photon.landings) tileOf(landing.pixel) += scale * landing.radiance;
  }
  void smooth() {
    for (int pass = 0; pass < kTilePasses; ++pass) tiles_.smooth();
  }
  /// One path from the eye for each tile.
  void addDirect(const ReferenceWorld& world) {
    const LayerNeeds needs({"direct"});
    const PathTracer tracer(world, needs);
    Film film(width_, height_, needs);
    parallelFor(static_cast<std::size_t>(tiles_.height), [&](std::size_t row) {
      PathCounters counters;
      const int tile_y = static_cast<int>(row), y = middleOf(tile_y, height_);
      for (int tile_x = 0; tile_x < tiles_.width; ++tile_x) {
        const int x = middleOf(tile_x, width_);
        tracer.tracePath(x, y, 0, film, counters);
        tiles_.at(tile_x, tile_y) += luminance(vec3(film.direct.at(static_cast<std::size_t>(y) * width_ + x)));
      }
    });
  }
  void findMean() {
    const auto lit = std::count_if(tiles_.values.begin(), tiles_.values.end(), [](double v) { return v > 0.0; });
    for (const double value : tiles_.values) mean_ += value / static_cast<double>(std::max<std::ptrdiff_t>(lit, 1));
  }
  /// The weight w of a squared error of this pixel.
  double weightOf(std::uint32_t pixel) {
    const double value = tileOf(pixel), floor = kFloor * mean_;
    return mean_ > 0.0 ? 1.0 / (mean_ * std::sqrt(value * value + floor * floor)) : 0.0;
  }

 private:
  static int tilesAlong(int pixels) { return (pixels + kTilePixels - 1) / kTilePixels; }
  static int middleOf(int tile, int pixels) { return std::min(tile * kTilePixels + kTilePixels / 2, pixels - 1); }
  double& tileOf(std::uint32_t pixel) {
    const auto p = static_cast<int>(pixel);
    return tiles_.at(p % width_ / kTilePixels, p / width_ / kTilePixels);
  }
  int width_, height_;
  Plane tiles_;
  double mean_ = 0.0;
};

/// @param moments  by block, mean squares
EmissionGuide guideBySquares(const Plane& moments, float guided) {
  std::vector<float> weights;
  for (const double moment : moments.values) weights.push_back(static_cast<float>(std::sqrt(moment)));
  return EmissionGuide(weights, 1.0F - guided);
}

EmissionGuide learn(const std::vector<PilotPhoton>& photons, RoughPicture& picture, float guided) {
  Plane moments(EmissionGuide::kSide, EmissionGuide::kSide);
  for (const PilotPhoton& photon : photons)
    for (const Landing& landing : photon.landings)
      moments.values[photon.block] +=
          picture.weightOf(landing.pixel) * landing.radiance * landing.radiance * landing.concentration;
  for (int pass = 0; pass < kBlockPasses; ++pass) moments.smooth();
  return guideBySquares(moments, guided);
}

GuidedLight describe(const Emitter& emitter, const std::vector<PilotPhoton>& photons, const EmissionGuide& guide) {
  GuidedLight light{emitter.name(), 0.0, 0.0};
  const double share = 1.0 / static_cast<double>(photons.size());
  for (const PilotPhoton& photon : photons) {
    if (!photon.of_use) continue;
    light.seen_even += share;
    light.seen_guided += share * guide.densityOfBlock(photon.block);
  }
  return light;
}

/// Photons of a light's pilot; 0: it is not worth one.
std::uint32_t countPilot(const LightTracer& tracer, std::size_t emitter, const GuideRequest& request) {
  const std::uint32_t count = request.photons[emitter] / kPhotonsPerPilot;
  const bool pays = request.guided > 0.0F && count >= kFewestPilots && tracer.emitters()[emitter]->canBeGuided();
  return pays ? count : 0;
}

}  // namespace

ParamSpec makeGuidingParam() {
  return {"guiding",
          0.7F,
          0.0,
          0.9,
          "",
          "share of the photons of suns, points and spots that go where a pilot found that they lessen the error of "
          "caustics most or, where paths gather photons, end near places where they do; the others are emitted evenly. "
          "Only where there are enough of them. 0: paths from the eye are not guided either",
          {}};
}

bool paysToGuide(Estimator estimator, const LayerNeeds& needs) {
  const bool seen = estimator == Estimator::kLight || estimator == Estimator::kFootprint;
  const bool others = needs.indirect || needs.irradiance || needs.specular_caustic || needs.specular_caustic_bias;
  return seen && needs.lightTraced() && !others;
}

std::vector<GuidedLight> guideEmission(const ReferenceWorld& world, LightTracer& tracer, const GuideRequest& request) {
  std::vector<GuidedLight> lights;
  std::vector<std::vector<PilotPhoton>> pilots(request.photons.size());
  RoughPicture picture(world.camera_model.width(), world.camera_model.height());
  for (std::size_t e = 0; e < pilots.size(); ++e) {
    const std::uint32_t count = countPilot(tracer, e, request);
    if (count == 0) continue;
    const FootprintScale spread = request.overlaps.empty()
                                      ? FootprintScale{}
                                      : tracer.scaleFootprints(request.overlaps[e], request.photons[e], 0);
    pilots[e] = tracePilot(tracer, e, count, spread, world.options.seed);
    picture.add(pilots[e]);
  }
  if (std::all_of(pilots.begin(), pilots.end(), [](const auto& pilot) { return pilot.empty(); })) return lights;
  picture.smooth();
  picture.addDirect(world);
  picture.findMean();
  for (std::size_t e = 0; e < pilots.size(); ++e) {
    if (pilots[e].empty()) continue;
    const EmissionGuide guide = learn(pilots[e], picture, request.guided);
    lights.push_back(describe(*tracer.emitters()[e], pilots[e], guide));
    tracer.guide(e, guide);
  }
  return lights;
}

std::vector<GuidedLight> guideToPlaces(const ReferenceWorld& world, LightTracer& tracer, const GuideRequest& request,
                                       const GatherPlaces& places) {
  std::vector<GuidedLight> lights;
  for (std::size_t e = 0; e < request.photons.size(); ++e) {
    const std::uint32_t count = kPilotsToPlaces * countPilot(tracer, e, request);
    if (count == 0) continue;
    std::vector<PilotPhoton> photons = tracePilot(tracer, e, count, FootprintScale{}, world.options.seed);
    Plane moments(EmissionGuide::kSide, EmissionGuide::kSide);
    for (PilotPhoton& photon : photons) {
      for (const vec3 position : photon.deposits) photon.of_use = photon.of_use || places.isNear(position);
      if (photon.of_use) moments.values[photon.block] += 1.0;
    }
    const EmissionGuide guide = guideBySquares(moments, request.guided);
    const GuidedLight light = describe(*tracer.emitters()[e], photons, guide);
    if (light.seen_guided <= kLeastGain * light.seen_even) continue;
    lights.push_back(light);
    tracer.guide(e, guide);
  }
  return lights;
}

void emitEvenly(LightTracer& tracer) {
  for (std::size_t e = 0; e < tracer.emitters().size(); ++e)
    if (tracer.emitters()[e]->canBeGuided()) tracer.guide(e, std::nullopt);
}

}  // namespace nephroid
