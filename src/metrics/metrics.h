// How far a picture is from its reference.
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "core/image/image.h"

namespace nephroid {

/// One metric: an entry of the explicit list in metrics.cpp.
struct Metric {
  std::string name;  ///< "rmse", "relmse", "mape", "smape", "p99", …
  std::string text;  ///< formula and meaning
  double (*compute)(const Image& image, const Image& reference, std::span<const std::uint8_t> mask);
};
std::span<const Metric> metrics();
/// @throws UsageError with the names there are
const Metric& findMetric(std::string_view name);

/// The layer `expression` names: "caustic", or a sum "direct+caustic".
/// @throws InputError naming the layer that the file lacks
Image evaluateLayerExpression(const LayeredImage& image, std::string_view expression);

/// Means over the mask, per channel.
dvec3 maskedMean(const Image& image, std::span<const std::uint8_t> mask);

}  // namespace nephroid
