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

BatchSpread::BatchSpread(std::size_t pixels) : closed_(static_cast<int>(pixels), 1), squares_(closed_) {}

void BatchSpread::close(std::size_t pixel, dvec3 sum, double count) {
  const dvec3 gained = sum - closed_.at(pixel);
  closed_.set(pixel, sum);
  squares_.set(pixel, squares_.at(pixel) + gained * gained / count);
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
    layers_.push_back({name, std::move(planes), BatchSpread(of_eye), BatchSpread(of_lights)});
  }
}

template <class Visit>
void ErrorEstimate::visitPixels(const Visit& visit) const {
  parallelFor(tiles_.count(), [&](std::size_t tile) {
    tiles_.visitPixels(tile, [&](int x, int y) { visit(tile, x, y, tiles_.pixelOf(x, y)); });
  });
}

template <class IsDue>
void ErrorEstimate::closeEyeBatchesWhere(std::span<const std::uint64_t> passes, const IsDue& is_due) {
  parallelFor(tiles_.count(), [&](std::size_t tile) {
    Direction& closed = eye_[tile];
    const std::uint64_t gained = passes[tile] - closed.passes;
    if (gained == 0 || !is_due(closed, gained)) return;
    for (LayerSpread& layer : layers_) {
      if (!layer.eye.active()) continue;
      tiles_.visitPixels(tile, [&](int x, int y) {
        const std::size_t pixel = tiles_.pixelOf(x, y);
        layer.eye.close(pixel, sumOf(layer.planes, &LayerPlanes::from_eye, pixel), static_cast<double>(gained));
      });
    }
    closed = {closed.batches + 1, passes[tile]};
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
  const auto count = static_cast<double>(passes - lights_.passes);
  for (LayerSpread& layer : layers_) {
    if (!layer.lights.active()) continue;
    visitPixels([&](std::size_t, int, int, std::size_t pixel) {
      layer.lights.close(pixel, sumOf(layer.planes, &LayerPlanes::from_lights, pixel), count);
    });
  }
  lights_ = {lights_.batches + 1, passes};
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

Image ErrorEstimate::standardError(std::string_view layer, std::span<const std::uint64_t> passes_from_eye,
                                   std::uint64_t batches_from_lights) const {
  const LayerSpread& spread = find(layer);
  Image image(tiles_.width(), tiles_.height(), 3);
  visitPixels([&](std::size_t tile, int x, int y, std::size_t pixel) {
    const dvec3 variance = varianceOfMean(spread.eye, eye_[tile], pixel, passes_from_eye[tile]) +
                           varianceOfMean(spread.lights, lights_, pixel, batches_from_lights);
    image.setRgb(x, y, vec3(glm::sqrt(variance)));
  });
  return image;
}

dvec3 ErrorEstimate::meanAt(const LayerSpread& layer, std::size_t tile, std::size_t pixel) const {
  dvec3 mean(0.0);
  if (layer.eye.active() && eye_[tile].passes > 0)
    mean += layer.eye.closedSum().at(pixel) / static_cast<double>(eye_[tile].passes);
  if (layer.lights.active() && lights_.passes > 0)
    mean += layer.lights.closedSum().at(pixel) / static_cast<double>(lights_.passes);
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
  const double floor = floorOf(layer);
  std::vector<RelativeError> tiles(tiles_.count());
  visitPixels([&](std::size_t tile, int, int, std::size_t pixel) {
    const dvec3 mean = meanAt(layer, tile, pixel);
    const dvec3 scale = mean * mean + floor;
    const dvec3 eye = varianceOfMean(layer.eye, eye_[tile], pixel, eye_[tile].passes);
    const dvec3 lights = varianceOfMean(layer.lights, lights_, pixel, lights_.passes);
    for (int c = 0; c < 3; ++c) {
      // A black pixel without spread in a black layer: 0/0 is no error.
      if (eye[c] > 0.0) tiles[tile].from_eye += eye[c] / scale[c];
      if (lights[c] > 0.0) tiles[tile].from_lights += lights[c] / scale[c];
    }
  });
  const double values = 3.0 * tiles_.width() * tiles_.height();
  RelativeError error;
  for (const RelativeError& tile : tiles)
    error.from_eye += tile.from_eye / values, error.from_lights += tile.from_lights / values;
  return error;
}

std::vector<double> ErrorEstimate::variancesOfPass(std::string_view name) const {
  const LayerSpread& layer = find(name);
  std::vector<double> variances(tiles_.count(), 0.0);
  if (!layer.eye.active()) return variances;
  const double floor = floorOf(layer);
  visitPixels([&](std::size_t tile, int, int, std::size_t pixel) {
    const dvec3 mean = meanAt(layer, tile, pixel);
    const dvec3 scale = mean * mean + floor;
    const dvec3 variance = layer.eye.varianceOfPass(pixel, eye_[tile].batches, eye_[tile].passes);
    for (int c = 0; c < 3; ++c)
      if (variance[c] > 0.0) variances[tile] += variance[c] / scale[c];
  });
  return variances;
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
