// How far a picture is from its reference.
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "core/image/image.h"
#include "metrics/flip.h"

namespace nephroid {

/// One metric: an entry of the explicit list in metrics.cpp.
struct Metric {
  std::string name;  ///< "rmse", "relmse", "mape", "smape", "p99", "flip", …
  std::string text;  ///< formula and meaning
  double (*compute)(const Image& image, const Image& reference, std::span<const std::uint8_t> mask,
                    const Viewing& viewing);
};
std::span<const Metric> metrics();
/// @throws UsageError with the names there are
const Metric& findMetric(std::string_view name);

/// `relmse` by pixel, the mean over channels: `height × width × 1`, also where the mask, whose mean reference it takes,
/// selects nothing. @throws InputError as the metric
Image computeRelMseMap(const Image& image, const Image& reference, std::span<const std::uint8_t> mask);

/// The layer `expression` names: "caustic", or a sum "direct+caustic".
/// @throws InputError naming the layer that the file lacks
Image evaluateLayerExpression(const LayeredImage& image, std::string_view expression);

/// How many pixels that the mask selects hold a NaN or an infinity.
struct NotFinitePixels {
  std::size_t in_image = 0, in_reference = 0;  ///< a pixel may be in both
};
/// Takes pixels that are not finite in either picture out of the mask: an error there is no number, and one of them
/// would hide that of all others. Whoever asks must tell how many there were.
/// @param mask  one entry per pixel
/// @throws InputError if sizes differ or no pixel remains
NotFinitePixels excludeNotFinite(const Image& image, const Image& reference, std::span<std::uint8_t> mask);

/// Means over the mask, per channel.
dvec3 maskedMean(const Image& image, std::span<const std::uint8_t> mask);

}  // namespace nephroid
