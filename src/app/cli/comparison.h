// Reads two pictures and compares them, for `nephroid compare`.
#pragma once

#include <map>
#include <string>
#include <utility>
#include <vector>

#include "metrics/metrics.h"

namespace nephroid::cli {

struct CompareOptions {
  std::string image, reference, layer, reference_layer, mask, metrics;
  float pixels_per_degree = kDefaultPixelsPerDegree;
};

struct Comparison {
  std::string layer, reference_layer;
  Image image, reference;          ///< those layers
  std::vector<std::uint8_t> mask;  ///< one entry per pixel, 255 for those that were compared
  std::size_t pixel_count = 0;     ///< those that were compared
  NotFinitePixels not_finite;      ///< those that were left out
  dvec3 image_mean{0}, reference_mean{0};
  Viewing viewing;  ///< of `flip`
  std::vector<std::pair<std::string, double>> values;
  std::map<std::string, std::string> image_metadata, reference_metadata;
};

/// @throws InputError, UsageError
Comparison comparePictures(const CompareOptions& options);

}  // namespace nephroid::cli
