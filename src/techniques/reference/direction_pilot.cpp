#include "techniques/reference/direction_pilot.h"

#include <cmath>
#include <iterator>

#include "core/parallel.h"
#include "techniques/reference/pilot.h"

namespace nephroid {
namespace {

/// Each is a place where the light may be another.
constexpr double kPixels = 16'000.0;
/// Passes without a guide, as many by what those learned, and those that the final guide learns from.
constexpr std::uint32_t kFirstPasses = 4, kLastPasses = 16;
/// Passes that are taken as one: points of the sampler are well spread together.
constexpr std::uint32_t kPassesTogether = 2;
/// A guide takes time that is not in its rays, and four passes know little.
constexpr double kLeastGain = 2.0;

/// Passes with one guide, or none.
class Lessons {
 public:
  Lessons(const PathTracer& tracer, int width, int height, const LayerNeeds& needs)
      : tracer_(tracer), film_(width, height, needs), spread_(pixels()), rays_(pixels(), 0.0) {}

  void trace(std::uint32_t begin, std::uint32_t end) {
    for (std::uint32_t pass = begin; pass < end; ++pass) {
      tracePass(pass);
      if ((pass + 1) % kPassesTogether != 0) continue;
      spread_.close([&](std::size_t pixel) {
        dvec3 sum(0.0);
        for (const LayerPlanes& planes : planesOf(film_, "beauty"))
          if (planes.from_eye && planes.from_eye->active()) sum += planes.from_eye->at(pixel);
        return sum;
      });
    }
  }
  const PilotSpread& spread() const { return spread_; }
  const std::vector<double>& rays() const { return rays_; }
  std::vector<DirectionLesson> take() { return std::move(lessons_); }

 private:
  std::size_t pixels() const { return static_cast<std::size_t>(film_.width) * static_cast<std::size_t>(film_.height); }
  void tracePass(std::uint32_t pass) {
    std::vector<std::vector<DirectionLesson>> rows(static_cast<std::size_t>(film_.height));
    parallelFor(rows.size(), [&](std::size_t row) {
      for (int x = 0; x < film_.width; ++x) {
        PathCounters counters;
        counters.lessons = &rows[row];
        tracer_.tracePath(x, static_cast<int>(row), pass, film_, counters);
        rays_[row * static_cast<std::size_t>(film_.width) + x] += static_cast<double>(counters.rays);
      }
    });
    for (std::vector<DirectionLesson>& row : rows)
      lessons_.insert(lessons_.end(), std::make_move_iterator(row.begin()), std::make_move_iterator(row.end()));
  }

  const PathTracer& tracer_;
  Film film_;
  PilotSpread spread_;
  std::vector<double> rays_;  ///< by pixel
  std::vector<DirectionLesson> lessons_;
};

/// That these passes' paths would need. @param truth  the picture, as far as it is known
double timeOf(const Lessons& lessons, const std::vector<dvec3>& truth, const PictureTiles& tiles) {
  const double floor = pilotFloor(truth);
  std::vector<double> variances(tiles.count(), 0.0), costs(variances);
  for (std::size_t tile = 0; tile < tiles.count(); ++tile) {
    tiles.visitPixels(tile, [&](int x, int y) {
      const std::size_t pixel = tiles.pixelOf(x, y);
      const double brightness = (truth[pixel].x + truth[pixel].y + truth[pixel].z) / 3.0;
      const double scale = brightness * brightness + floor * floor;
      const dvec3 variance = lessons.spread().varianceOfMeanAt(pixel);
      if (scale > 0.0) variances[tile] += (variance.x + variance.y + variance.z) / scale;
      costs[tile] += lessons.rays()[pixel];
    });
  }
  return timeToError(variances, costs);
}

}  // namespace

double timeToError(std::span<const double> variances, std::span<const double> costs) {
  double sum = 0.0;
  for (std::size_t tile = 0; tile < variances.size(); ++tile) sum += std::sqrt(variances[tile] * costs[tile]);
  return sum * sum;
}

DirectionGuide learnDirections(ReferenceWorld& world, const Camera& camera, int width, int height,
                               const LayerNeeds& needs, PathTracer tracer) {
  const PilotView view(world, camera, width, height, kPixels);
  const int w = world.camera_model.width(), h = world.camera_model.height();
  tracer.guideBy(nullptr);
  Lessons by_bsdf(tracer, w, h, needs);
  by_bsdf.trace(0, kFirstPasses);
  DirectionGuide guide(by_bsdf.take());
  if (guide.empty()) return {};

  tracer.guideBy(&guide);
  Lessons by_guide(tracer, w, h, needs);
  by_guide.trace(kFirstPasses, 2 * kFirstPasses);
  std::vector<dvec3> picture;
  for (std::size_t pixel = 0; pixel < by_bsdf.spread().pixels(); ++pixel)
    picture.push_back(0.5 * (by_bsdf.spread().meanAt(pixel) + by_guide.spread().meanAt(pixel)));
  const std::vector<dvec3> truth = blurPilot(picture, w, h);
  const PictureTiles tiles(w, h);
  if (!(timeOf(by_bsdf, truth, tiles) > kLeastGain * timeOf(by_guide, truth, tiles))) return {};

  guide = DirectionGuide(by_guide.take());
  by_guide.trace(2 * kFirstPasses, 2 * kFirstPasses + kLastPasses);
  DirectionGuide better(by_guide.take());
  better.keepWhatPays();
  return better;
}

}  // namespace nephroid
