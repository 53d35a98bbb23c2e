// Error figures over the pixels that a mask selects. Sums run in double precision in the order of the pixels, so that
// equal pictures give equal figures everywhere. Pictures of one channel count once, others as RGB.

#include "metrics/metrics.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "core/params.h"
#include "metrics/samples.h"
#include "nephroid/error.h"

namespace nephroid {
namespace {

/// Fraction of the mean reference that is added to the denominators of relative errors (DESIGN, "Error figures"):
/// without it, the figure would be ruled by the darkest pixels.
constexpr double kRelativeFloor = 0.01;

/// Calls `visit(value, reference value)` for each channel of each pixel that counts.
template <class Visit>
void forEachSample(const Image& image, const Image& reference, Mask mask, const Visit& visit) {
  checkSameSize(image, reference);
  checkMask(image, mask);
  const int channel_count = image.channels >= 3 || reference.channels >= 3 ? 3 : 1;
  forEachPixel(image, mask, [&](int x, int y) {
    const vec3 value = image.rgb(x, y), truth = reference.rgb(x, y);
    for (int c = 0; c < channel_count; ++c) visit(double{value[c]}, double{truth[c]});
  });
}

/// Mean of `term(value, reference value)` over all samples.
template <class Term>
double computeMean(const Image& image, const Image& reference, Mask mask, const Term& term) {
  double sum = 0.0;
  std::uint64_t count = 0;
  forEachSample(image, reference, mask, [&](double value, double truth) {
    sum += term(value, truth);
    ++count;
  });
  return sum / static_cast<double>(count);
}

double computeReferenceMean(const Image& image, const Image& reference, Mask mask) {
  return computeMean(image, reference, mask, [](double, double truth) { return truth; });
}

/// 0/0 is no error (both black); anything else over 0 is infinite.
double divide(double numerator, double denominator) { return numerator == 0.0 ? 0.0 : numerator / denominator; }

double computeRmse(const Image& image, const Image& reference, Mask mask) {
  const auto square = [](double value, double truth) { return (value - truth) * (value - truth); };
  return std::sqrt(computeMean(image, reference, mask, square));
}

double computeNrmse(const Image& image, const Image& reference, Mask mask) {
  return divide(computeRmse(image, reference, mask), computeReferenceMean(image, reference, mask));
}

double computeRelativeSquare(double value, double truth, double floor) {
  return divide((value - truth) * (value - truth), truth * truth + floor * floor);
}

double computeRelMse(const Image& image, const Image& reference, Mask mask) {
  const double floor = kRelativeFloor * computeReferenceMean(image, reference, mask);
  return computeMean(image, reference, mask,
                     [floor](double value, double truth) { return computeRelativeSquare(value, truth, floor); });
}

double computeL1(const Image& image, const Image& reference, Mask mask) {
  const auto difference = [](double value, double truth) { return std::abs(value - truth); };
  return divide(computeMean(image, reference, mask, difference), computeReferenceMean(image, reference, mask));
}

double computeRelativeError(double value, double truth, double floor) {
  return divide(std::abs(value - truth), std::abs(truth) + std::abs(floor));
}

double computeMape(const Image& image, const Image& reference, Mask mask) {
  const double floor = kRelativeFloor * computeReferenceMean(image, reference, mask);
  return computeMean(image, reference, mask,
                     [floor](double value, double truth) { return computeRelativeError(value, truth, floor); });
}

double computeSmape(const Image& image, const Image& reference, Mask mask) {
  return computeMean(image, reference, mask, [](double value, double truth) {
    return divide(2.0 * std::abs(value - truth), std::abs(value) + std::abs(truth));
  });
}

/// Nearest rank: the smallest error that at least 99 % of the samples do not exceed; NaN if any sample is NaN.
double computeP99(const Image& image, const Image& reference, Mask mask) {
  const double floor = kRelativeFloor * computeReferenceMean(image, reference, mask);
  std::vector<double> errors;
  bool has_nan = false;
  forEachSample(image, reference, mask, [&](double value, double truth) {
    errors.push_back(computeRelativeError(value, truth, floor));
    has_nan = has_nan || std::isnan(errors.back());
  });
  if (has_nan) return std::numeric_limits<double>::quiet_NaN();  // it has no place in an order
  const std::size_t rank = (errors.size() * 99 + 99) / 100;      // ceil(0.99 n), in whole numbers
  const auto found = errors.begin() + static_cast<std::ptrdiff_t>(rank - 1);
  std::nth_element(errors.begin(), found, errors.end());
  return *found;
}

/// A metric that is a matter of numbers, however the pictures are looked at.
template <double (*kCompute)(const Image&, const Image&, Mask)>
double ignoreViewing(const Image& image, const Image& reference, Mask mask, const Viewing&) {
  return kCompute(image, reference, mask);
}

}  // namespace

std::span<const Metric> metrics() {
  static const std::array entries{
      Metric{"rmse", "sqrt(mean (I-R)^2): root of the mean squared error, in the layer's unit",
             ignoreViewing<computeRmse>},
      Metric{"nrmse", "rmse / mean R: the same as a fraction of the mean reference", ignoreViewing<computeNrmse>},
      Metric{"relmse", "mean((I-R)^2 / (R^2 + (0.01 mean R)^2)): mean squared error relative to each pixel",
             ignoreViewing<computeRelMse>},
      Metric{"l1", "mean |I-R| / mean R: absolute error as a fraction of the reference's total",
             ignoreViewing<computeL1>},
      Metric{"mape", "mean(|I-R| / (|R| + 0.01 mean R)): mean absolute error relative to each pixel",
             ignoreViewing<computeMape>},
      Metric{"smape", "mean(2 |I-R| / (|I| + |R|)), 0 where both are black: symmetric, in [0, 2]",
             ignoreViewing<computeSmape>},
      Metric{"p99", "99th percentile (nearest rank) of |I-R| / (|R| + 0.01 mean R): how bad the worst places are",
             ignoreViewing<computeP99>},
      Metric{"flip",
             "FLIP: mean of how much an eye sees change where R takes the place of I, in [0, 1]; 8-bit pictures as "
             "they are (LDR-FLIP), others at every exposure that R has something to show at (HDR-FLIP)",
             computeFlip},
  };
  return entries;
}

const Metric& findMetric(std::string_view name) {
  std::vector<std::string> names;
  for (const Metric& metric : metrics()) {
    if (metric.name == name) return metric;
    names.push_back(metric.name);
  }
  const std::string nearest = suggestName(name, names);
  const std::string hint = nearest.empty() ? "" : fmt::format("; did you mean '{}'?", nearest);
  throw UsageError(fmt::format("unknown metric '{}'{} (known: {})", name, hint, fmt::join(names, ", ")));
}

Image computeRelMseMap(const Image& image, const Image& reference, std::span<const std::uint8_t> mask) {
  const double floor = kRelativeFloor * computeReferenceMean(image, reference, mask);
  Image map(image.width, image.height, 1);
  for (int y = 0; y < image.height; ++y)
    for (int x = 0; x < image.width; ++x) {
      const vec3 value = image.rgb(x, y), truth = reference.rgb(x, y);
      double sum = 0.0;
      for (int c = 0; c < 3; ++c) sum += computeRelativeSquare(double{value[c]}, double{truth[c]}, floor);
      *map.at(x, y) = static_cast<float>(sum / 3.0);
    }
  return map;
}

NotFinitePixels excludeNotFinite(const Image& image, const Image& reference, std::span<std::uint8_t> mask) {
  checkSameSize(image, reference);
  checkMask(image, mask);
  NotFinitePixels found;
  std::size_t left = 0;
  std::size_t index = 0;
  for (int y = 0; y < image.height; ++y)
    for (int x = 0; x < image.width; ++x, ++index) {
      if (mask[index] != kSelected) continue;
      const bool image_is_finite = isFinite(image.rgb(x, y)), reference_is_finite = isFinite(reference.rgb(x, y));
      if (!image_is_finite) ++found.in_image;
      if (!reference_is_finite) ++found.in_reference;
      if (image_is_finite && reference_is_finite)
        ++left;
      else
        mask[index] = 0;
    }
  if (left == 0)
    throw InputError(
        fmt::format("nothing to measure: of the pixels that count, {} of the image and {} of the reference are NaN or "
                    "infinite, and none is finite in both",
                    found.in_image, found.in_reference));
  return found;
}

dvec3 maskedMean(const Image& image, std::span<const std::uint8_t> mask) {
  checkMask(image, mask);
  dvec3 sum(0.0);
  std::uint64_t count = 0;
  forEachPixel(image, mask, [&](int x, int y) {
    sum += dvec3(image.rgb(x, y));
    ++count;
  });
  return sum / static_cast<double>(count);
}

}  // namespace nephroid
