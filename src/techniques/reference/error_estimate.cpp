#include "techniques/reference/error_estimate.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <iterator>
#include <limits>
#include <numeric>

#include "core/assert.h"
#include "core/parallel.h"
#include "techniques/layers.h"

namespace nephroid {
namespace {

/// Later batches from the eye are as long as this share of all passes: points of the sampler are well spread together,
/// so that a mean over them errs less than the spread of short runs says.
constexpr std::uint64_t kBatchShare = 4;
/// Batches of a generation at least.
constexpr std::uint64_t kGenerationBatches = 4;
/// Batches that are spread well with each other deviate more from their mean than independent ones of their variance
/// would. Of `count` batches of n passes, n v(n) = A + B n^(-1/2), the textbook's variance has the mean
/// count/(count − 1) · (v(n) − v(count · n)), which is (A + B n^(-1/2) · this)/n.
double deviationOfDeclining(std::uint64_t count) {
  const auto g = static_cast<double>(count);
  return (1.0 - 1.0 / (g * std::sqrt(g))) / (1.0 - 1.0 / g);
}

using PlaneOf = const FilmPlane* LayerPlanes::*;

bool anyActive(const std::vector<LayerPlanes>& planes, PlaneOf direction) {
  return std::any_of(planes.begin(), planes.end(),
                     [&](const LayerPlanes& p) { return p.*direction && (p.*direction)->active(); });
}

dvec3 sumOf(const std::vector<LayerPlanes>& planes, PlaneOf direction, std::size_t pixel) {
  dvec3 sum(0.0);
  for (const LayerPlanes& p : planes)
    if (p.*direction && (p.*direction)->active()) sum += (p.*direction)->at(pixel);
  return sum;
}

/// What a sum over `count` passes adds to the squares by which sums deviate from their mean, weighted by passes.
/// @param earlier  the sum before it, over `before` passes
dvec3 squareApart(dvec3 sum, double count, dvec3 earlier, double before) {
  if (before <= 0.0) return dvec3(0.0);
  const dvec3 apart = sum / count - earlier / before;
  return apart * apart * (count * before / (count + before));
}

}  // namespace

std::vector<std::string> layersWithError(const std::vector<std::string>& asked, double target_error) {
  const auto isAsked = [&](std::string_view name) {
    return std::find(asked.begin(), asked.end(), name) != asked.end();
  };
  std::vector<std::string> layers;
  for (const LayerInfo& info : layerInfos()) {
    const std::string_view erring = erringLayer(info.name);
    const bool wanted = isAsked(info.name) || (target_error > 0.0 && isAsked(erring));
    if (!erring.empty() && wanted) layers.emplace_back(erring);
  }
  return layers;
}

BatchSpread::BatchSpread(std::size_t pixels)
    : closed_(static_cast<int>(pixels), 1), squares_(closed_), generation_(closed_), pair_(closed_) {}

dvec3 BatchSpread::close(std::size_t pixel, dvec3 sum, double count, double before) {
  const dvec3 gained = sum - closed_.at(pixel);
  squares_.set(pixel, squares_.at(pixel) + gained * gained / count);
  const dvec3 deviation = squareApart(gained, count, closed_.at(pixel) - generation_.at(pixel), before);
  closed_.set(pixel, sum);
  return deviation;
}

dvec3 BatchSpread::closePair(std::size_t pixel, double count, double before) {
  const dvec3 sum = closed_.at(pixel), sum_before = pair_.at(pixel);
  pair_.set(pixel, sum);
  return squareApart(sum - sum_before, count, sum_before - generation_.at(pixel), before);
}

dvec3 BatchSpread::varianceOfPass(std::size_t pixel, std::uint64_t batches, std::uint64_t passes) const {
  NEPHROID_ASSERT_GE(batches, 2U);
  const dvec3 sum = closed_.at(pixel);
  const dvec3 spread = squares_.at(pixel) - sum * sum / static_cast<double>(passes);
  // Where all batches agree, rounding may leave a trace below 0.
  return glm::max(spread, dvec3(0.0)) / static_cast<double>(batches - 1);
}

ErrorEstimate::ErrorEstimate(const Film& film, const std::vector<std::string>& layers)
    : tiles_(film.width, film.height), eye_(tiles_.count()) {
  const std::size_t pixels = static_cast<std::size_t>(film.width) * film.height;
  for (const std::string& name : layers) {
    std::vector<LayerPlanes> planes = planesOf(film, name);
    const std::size_t of_eye = anyActive(planes, &LayerPlanes::from_eye) ? pixels : 0;
    const std::size_t of_lights = anyActive(planes, &LayerPlanes::from_lights) ? pixels : 0;
    const std::vector<Recent> none(tiles_.count());
    layers_.push_back({name, std::move(planes), {BatchSpread(of_eye), none}, {BatchSpread(of_lights), none}});
  }
}

void ErrorEstimate::Direction::close(std::uint64_t gained) {
  ++batches, ++current.batches;
  passes += gained, current.passes += gained;
  if (closesPair()) current.paired = current.passes;
}

bool ErrorEstimate::Direction::endsGeneration() const {
  return current.batches >= kGenerationBatches && passes >= 2 * (passes - current.passes);
}

void ErrorEstimate::Direction::beginGeneration() {
  previous = current;
  current = {};
}

template <class Visit>
void ErrorEstimate::visitPixels(const Visit& visit) const {
  parallelFor(tiles_.count(), [&](std::size_t tile) {
    tiles_.visitPixels(tile, [&](int x, int y) { visit(tile, x, y, tiles_.pixelOf(x, y)); });
  });
}

/// What a tile of a layer gained is a batch. @param before,closed  its direction without the batch, and with it
/// @param floor  see floorOf()
void ErrorEstimate::closeTile(LayerSpread& layer, OfDirection LayerSpread::*direction, std::size_t tile,
                              const Direction& before, const Direction& closed, double floor) const {
  OfDirection& of = layer.*direction;
  if (!of.spread.active()) return;
  const PlaneOf plane = direction == &LayerSpread::eye ? &LayerPlanes::from_eye : &LayerPlanes::from_lights;
  const auto gained = static_cast<double>(closed.passes - before.passes);
  const auto earlier = static_cast<double>(before.current.passes);
  const auto paired = static_cast<double>(before.current.paired);
  Squares& squares = of.recent[tile].current;
  tiles_.visitPixels(tile, [&](int x, int y) {
    const std::size_t pixel = tiles_.pixelOf(x, y);
    const dvec3 of_batch = of.spread.close(pixel, sumOf(layer.planes, plane, pixel), gained, earlier);
    const dvec3 mean = meanAt(layer, tile, pixel), scale = mean * mean + floor;
    const auto addTo = [&](double& sum, dvec3 deviation) {
      for (int c = 0; c < 3; ++c)
        if (deviation[c] > 0.0) sum += deviation[c] / scale[c];
    };
    addTo(squares.batches, of_batch);
    if (!closed.closesPair()) return;
    addTo(squares.pairs, of.spread.closePair(pixel, earlier + gained - paired, paired));
  });
}

void ErrorEstimate::beginGeneration(OfDirection LayerSpread::*direction, std::size_t tile) {
  for (LayerSpread& layer : layers_) {
    OfDirection& of = layer.*direction;
    if (!of.spread.active()) continue;
    tiles_.visitPixels(tile, [&](int x, int y) { of.spread.beginGeneration(tiles_.pixelOf(x, y)); });
    of.recent[tile] = {.current = {}, .previous = of.recent[tile].current};
  }
}

std::vector<double> ErrorEstimate::floors() const {
  std::vector<double> floors;
  for (const LayerSpread& layer : layers_) floors.push_back(floorOf(layer));
  return floors;
}

template <class IsDue>
void ErrorEstimate::closeEyeBatchesWhere(std::span<const std::uint64_t> passes, const IsDue& is_due) {
  const std::vector<double> floor = floors();
  parallelFor(tiles_.count(), [&](std::size_t tile) {
    Direction& closed = eye_[tile];
    const std::uint64_t gained = passes[tile] - closed.passes;
    if (gained == 0 || !is_due(closed, gained)) return;
    const Direction before = closed;
    closed.close(gained);
    for (std::size_t i = 0; i < layers_.size(); ++i)
      closeTile(layers_[i], &LayerSpread::eye, tile, before, closed, floor[i]);
    if (!closed.endsGeneration()) return;
    beginGeneration(&LayerSpread::eye, tile);
    closed.beginGeneration();
  });
}

void ErrorEstimate::closeEyeBatches(std::span<const std::uint64_t> passes) {
  closeEyeBatchesWhere(passes, [](const Direction&, std::uint64_t) { return true; });
}

void ErrorEstimate::closeFullEyeBatches(std::span<const std::uint64_t> passes, std::uint64_t shortest) {
  closeEyeBatchesWhere(passes, [&](const Direction& closed, std::uint64_t gained) {
    return gained >= std::max(shortest, std::bit_floor(closed.passes) / kBatchShare);
  });
}

void ErrorEstimate::closeLightBatch(std::uint64_t passes) {
  if (passes == lights_.passes) return;
  const std::vector<double> floor = floors();
  const Direction before = lights_;
  lights_.close(passes - before.passes);
  const bool ends = lights_.endsGeneration();
  parallelFor(tiles_.count(), [&](std::size_t tile) {
    for (std::size_t i = 0; i < layers_.size(); ++i)
      closeTile(layers_[i], &LayerSpread::lights, tile, before, lights_, floor[i]);
    if (ends) beginGeneration(&LayerSpread::lights, tile);
  });
  if (ends) lights_.beginGeneration();
}

void ErrorEstimate::closeFullLightBatch(std::uint64_t passes) {
  if (passes - lights_.passes >= std::max<std::uint64_t>(1, std::bit_floor(lights_.passes) / kBatchShare))
    closeLightBatch(passes);
}

std::uint64_t ErrorEstimate::eyeBatches() const {
  std::uint64_t fewest = eye_.front().batches;
  for (const Direction& tile : eye_) fewest = std::min(fewest, tile.batches);
  return fewest;
}

std::uint64_t ErrorEstimate::batches() const {
  const std::uint64_t from_eye = eyeBatches();
  if (from_eye == 0 || lights_.batches == 0) return std::max(from_eye, lights_.batches);
  return std::min(from_eye, lights_.batches);
}

const ErrorEstimate::LayerSpread& ErrorEstimate::find(std::string_view layer) const {
  const auto found =
      std::find_if(layers_.begin(), layers_.end(), [&](const LayerSpread& l) { return l.name == layer; });
  NEPHROID_ASSERT_LT(found - layers_.begin(), std::ssize(layers_));
  return *found;
}

dvec3 ErrorEstimate::varianceOfMean(const BatchSpread& spread, const Direction& closed, std::size_t pixel,
                                    std::uint64_t passes) {
  if (!spread.active() || closed.batches == 0) return dvec3(0.0);
  if (closed.batches == 1) return dvec3(std::numeric_limits<double>::infinity());
  return spread.varianceOfPass(pixel, closed.batches, closed.passes) / static_cast<double>(passes);
}

ErrorEstimate::PassVariance ErrorEstimate::recentVarianceOfPass(const OfDirection& direction, std::size_t tile,
                                                                const Direction& closed) {
  if (!direction.spread.active() || closed.batches == 0) return {};
  if (closed.batches == 1) return {.by_batches = std::numeric_limits<double>::infinity()};
  const Recent& recent = direction.recent[tile];
  // A mean of each generation is known by one of its batches.
  const auto freedomOf = [](std::uint64_t n) { return n > 0 ? static_cast<double>(n - 1) : 0.0; };
  // B: of the generation before, which alone has pairs to compare.
  const Generation& previous = closed.previous;
  double declining = 0.0;
  if (const std::uint64_t pairs = previous.pairs(); pairs >= 2)
    declining = (recent.previous.batches / freedomOf(previous.batches) - recent.previous.pairs / freedomOf(pairs)) *
                std::sqrt(previous.passesPerBatch()) /
                (deviationOfDeclining(previous.batches) - deviationOfDeclining(pairs) / std::sqrt(2.0));
  const double freedom = freedomOf(closed.current.batches) + freedomOf(previous.batches);
  const double of_whole = 1.0 / std::sqrt(static_cast<double>(closed.passes));
  PassVariance variance;
  const auto addGeneration = [&](const Generation& generation, double squares) {
    if (generation.batches < 2) return;
    const double share = freedomOf(generation.batches) / freedom;
    const double of_batches = deviationOfDeclining(generation.batches) / std::sqrt(generation.passesPerBatch());
    variance.by_batches += squares / freedom;
    variance.least += squares / freedom * of_whole / of_batches;
    variance.decline += share * declining * (of_batches - of_whole);
  };
  addGeneration(closed.current, recent.current.batches);
  addGeneration(previous, recent.previous.batches);
  return variance;
}

Image ErrorEstimate::standardError(std::string_view layer, std::span<const std::uint64_t> passes_from_eye,
                                   std::uint64_t batches_from_lights) const {
  const LayerSpread& of = find(layer);
  Image image(tiles_.width(), tiles_.height(), 3);
  visitPixels([&](std::size_t tile, int x, int y, std::size_t pixel) {
    const dvec3 variance = varianceOfMean(of.eye.spread, eye_[tile], pixel, passes_from_eye[tile]) +
                           varianceOfMean(of.lights.spread, lights_, pixel, batches_from_lights);
    image.setRgb(x, y, vec3(glm::sqrt(variance)));
  });
  return image;
}

dvec3 ErrorEstimate::meanAt(const LayerSpread& layer, std::size_t tile, std::size_t pixel) const {
  dvec3 mean(0.0);
  if (layer.eye.spread.active() && eye_[tile].passes > 0)
    mean += layer.eye.spread.closedSum().at(pixel) / static_cast<double>(eye_[tile].passes);
  if (layer.lights.spread.active() && lights_.passes > 0)
    mean += layer.lights.spread.closedSum().at(pixel) / static_cast<double>(lights_.passes);
  return mean;
}

/// What keeps dark pixels from ruling the figure, squared.
double ErrorEstimate::floorOf(const LayerSpread& layer) const {
  // Tile by tile, so that the sums do not depend on threads.
  std::vector<double> brightness(tiles_.count(), 0.0);
  visitPixels([&](std::size_t tile, int, int, std::size_t pixel) {
    const dvec3 mean = meanAt(layer, tile, pixel);
    brightness[tile] += mean.x + mean.y + mean.z;
  });
  const double values = 3.0 * tiles_.width() * tiles_.height();
  const double floor = kRelativeFloor * std::accumulate(brightness.begin(), brightness.end(), 0.0) / values;
  return floor * floor;
}

RelativeError ErrorEstimate::relMse(std::string_view name) const {
  const LayerSpread& layer = find(name);
  const double values = 3.0 * tiles_.width() * tiles_.height();
  const auto errorOf = [&](const OfDirection& direction, const auto& closedIn) {
    // Single tiles say too little of how it declines.
    double by_batches = 0.0, decline = 0.0, least = 0.0;
    for (std::size_t tile = 0; tile < tiles_.count(); ++tile) {
      const Direction& closed = closedIn(tile);
      const PassVariance variance = recentVarianceOfPass(direction, tile, closed);
      if (!(variance.by_batches > 0.0)) continue;
      const double scale = 1.0 / (static_cast<double>(closed.passes) * values);
      by_batches += scale * variance.by_batches, decline += scale * variance.decline, least += scale * variance.least;
    }
    return std::max(by_batches - decline, least);
  };
  return {.from_eye = errorOf(layer.eye, [&](std::size_t tile) -> const Direction& { return eye_[tile]; }),
          .from_lights = errorOf(layer.lights, [&](std::size_t) -> const Direction& { return lights_; })};
}

std::vector<double> ErrorEstimate::variancesOfPass(std::string_view name) const {
  const LayerSpread& layer = find(name);
  std::vector<double> variances;
  for (std::size_t tile = 0; tile < tiles_.count(); ++tile)
    variances.push_back(recentVarianceOfPass(layer.eye, tile, eye_[tile]).by_batches);
  return variances;
}

std::vector<float> ErrorEstimate::relativeScales(std::string_view name) const {
  if (eyeBatches() == 0) return {};
  const LayerSpread& layer = find(name);
  const double floor = floorOf(layer);
  std::vector<float> scales(tiles_.pixels(), 0.0F);
  visitPixels([&](std::size_t tile, int, int, std::size_t pixel) {
    const dvec3 mean = meanAt(layer, tile, pixel);
    const double brightness = (mean.x + mean.y + mean.z) / 3.0, square = brightness * brightness + floor;
    if (square > 0.0) scales[pixel] = static_cast<float>(1.0 / square);
  });
  return scales;
}

ErrorEstimate::OfLayer ErrorEstimate::worst() const {
  NEPHROID_ASSERT_GT(layers_.size(), 0U);
  OfLayer worst{layers_.front().name, relMse(layers_.front().name)};
  for (std::size_t i = 1; i < layers_.size(); ++i) {
    const RelativeError error = relMse(layers_[i].name);
    if (error.total() > worst.error.total()) worst = {layers_[i].name, error};
  }
  return worst;
}

}  // namespace nephroid
