#include "techniques/reference/error_estimate.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <limits>
#include <numeric>

#include "core/assert.h"
#include "core/parallel.h"
#include "techniques/layers.h"

namespace nephroid {
namespace {

/// As in metrics: without it the darkest pixels would rule the figure (DESIGN, "Error figures").
constexpr double kRelativeFloor = 0.01;

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
    : width_(film.width), height_(film.height) {
  const std::size_t pixels = static_cast<std::size_t>(film.width) * film.height;
  for (const std::string& name : layers) {
    std::vector<LayerPlanes> planes = planesOf(film, name);
    const std::size_t of_eye = anyActive(planes, &LayerPlanes::from_eye) ? pixels : 0;
    const std::size_t of_lights = anyActive(planes, &LayerPlanes::from_lights) ? pixels : 0;
    layers_.push_back({name, std::move(planes), BatchSpread(of_eye), BatchSpread(of_lights)});
  }
}

template <class Visit>
void ErrorEstimate::visitRows(const Visit& visit) const {
  parallelFor(static_cast<std::size_t>(height_), [&](std::size_t row) {
    for (std::size_t pixel = row * width_; pixel < (row + 1) * width_; ++pixel) visit(row, pixel);
  });
}

void ErrorEstimate::closeEyeBatch(std::uint64_t passes) {
  if (passes == eye_.passes) return;
  const auto count = static_cast<double>(passes - eye_.passes);
  for (LayerSpread& layer : layers_) {
    if (!layer.eye.active()) continue;
    visitRows([&](std::size_t, std::size_t pixel) {
      layer.eye.close(pixel, sumOf(layer.planes, &LayerPlanes::from_eye, pixel), count);
    });
  }
  eye_ = {eye_.batches + 1, passes};
}

void ErrorEstimate::closeLightBatch(std::uint64_t passes) {
  if (passes == lights_.passes) return;
  const auto count = static_cast<double>(passes - lights_.passes);
  for (LayerSpread& layer : layers_) {
    if (!layer.lights.active()) continue;
    visitRows([&](std::size_t, std::size_t pixel) {
      layer.lights.close(pixel, sumOf(layer.planes, &LayerPlanes::from_lights, pixel), count);
    });
  }
  lights_ = {lights_.batches + 1, passes};
}

std::uint64_t ErrorEstimate::batches() const {
  if (eye_.batches == 0 || lights_.batches == 0) return std::max(eye_.batches, lights_.batches);
  return std::min(eye_.batches, lights_.batches);
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

Image ErrorEstimate::standardError(std::string_view layer, std::uint64_t passes_from_eye,
                                   std::uint64_t batches_from_lights) const {
  const LayerSpread& spread = find(layer);
  Image image(width_, height_, 3);
  visitRows([&](std::size_t row, std::size_t pixel) {
    const dvec3 variance = varianceOfMean(spread.eye, eye_, pixel, passes_from_eye) +
                           varianceOfMean(spread.lights, lights_, pixel, batches_from_lights);
    image.setRgb(static_cast<int>(pixel - row * width_), static_cast<int>(row), vec3(glm::sqrt(variance)));
  });
  return image;
}

dvec3 ErrorEstimate::meanAt(const LayerSpread& layer, std::size_t pixel) const {
  dvec3 mean(0.0);
  if (layer.eye.active() && eye_.passes > 0) mean += layer.eye.closedSum().at(pixel) / static_cast<double>(eye_.passes);
  if (layer.lights.active() && lights_.passes > 0)
    mean += layer.lights.closedSum().at(pixel) / static_cast<double>(lights_.passes);
  return mean;
}

RelativeError ErrorEstimate::relMse(std::string_view name) const {
  const LayerSpread& layer = find(name);
  // Row by row, so that the sums do not depend on threads.
  std::vector<double> brightness(static_cast<std::size_t>(height_), 0.0);
  visitRows([&](std::size_t row, std::size_t pixel) {
    const dvec3 mean = meanAt(layer, pixel);
    brightness[row] += mean.x + mean.y + mean.z;
  });
  const double samples = 3.0 * width_ * height_;
  const double floor = kRelativeFloor * std::accumulate(brightness.begin(), brightness.end(), 0.0) / samples;
  std::vector<RelativeError> rows(static_cast<std::size_t>(height_));
  visitRows([&](std::size_t row, std::size_t pixel) {
    const dvec3 mean = meanAt(layer, pixel);
    const dvec3 scale = mean * mean + floor * floor;
    const dvec3 eye = varianceOfMean(layer.eye, eye_, pixel, eye_.passes);
    const dvec3 lights = varianceOfMean(layer.lights, lights_, pixel, lights_.passes);
    for (int c = 0; c < 3; ++c) {
      // A black pixel without spread in a black layer: 0/0 is no error.
      if (eye[c] > 0.0) rows[row].from_eye += eye[c] / scale[c];
      if (lights[c] > 0.0) rows[row].from_lights += lights[c] / scale[c];
    }
  });
  RelativeError error;
  for (const RelativeError& row : rows)
    error.from_eye += row.from_eye / samples, error.from_lights += row.from_lights / samples;
  return error;
}

ErrorEstimate::Worst ErrorEstimate::worst() const {
  NEPHROID_ASSERT_GT(layers_.size(), 0U);
  Worst worst{layers_.front().name, relMse(layers_.front().name)};
  for (std::size_t i = 1; i < layers_.size(); ++i) {
    const RelativeError error = relMse(layers_[i].name);
    if (error.total() > worst.error.total()) worst = {layers_[i].name, error};
  }
  return worst;
}

}  // namespace nephroid
