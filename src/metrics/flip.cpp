// The picture is done in bands of rows, each by itself with the rows about it: so intermediate pictures stay small and
// in the cache, and no sum depends on the number of threads. HDR-FLIP after Andersson et al., "Visualizing Errors in
// Rendered High Dynamic Range Images" [andersson-2021].

#include "metrics/flip.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

#include "core/image/tonemap.shared.h"
#include "core/math.h"
#include "core/parallel.h"
#include "metrics/flip_observer.h"
#include "metrics/perceived_colour.h"
#include "metrics/samples.h"
#include "nephroid/error.h"

namespace nephroid {
namespace {

/// The tone curve's value that the brightest pixel is brought to, and the median.
constexpr double kExposedTo = 0.85;
/// Rows of a band. Its border is of 20 rows more at the default distance; much higher and it leaves the cache.
constexpr int kBandRows = 48;

/// A factor before the tone curve; none: shown as it is.
using Exposure = std::optional<double>;

/// What applyFilmicCurve maps to kExposedTo: solves (2.51 − 2.43 t) x² + (0.03 − 0.59 t) x − 0.14 t = 0. The scale of
/// the curve's argument is ours and not the paper's, and cancels: exposures are relative to this.
double invertFilmicCurve() {
  const double t = kExposedTo, a = 2.51 - 2.43 * t, b = 0.03 - 0.59 * t, c = -0.14 * t;
  return (-b + std::sqrt(b * b - 4.0 * a * c)) / (2.0 * a) / double{kFilmicCurveScale};
}

/// What a screen shows of radiance.
vec3 display(vec3 rgb, const Exposure& exposure) {
  if (!exposure) return clamp(rgb, vec3(0.0F), vec3(1.0F));
  vec3 shown;
  for (int c = 0; c < 3; ++c) {
    constexpr double kWhite = 1e6;  // far beyond the end of the curve, and finite
    shown[c] = applyFilmicCurve(static_cast<float>(std::clamp(*exposure * double{rgb[c]}, 0.0, kWhite)));
  }
  return shown;
}

/// Luminances of a picture without its pixels that are not finite; negative light is none.
std::vector<double> collectLuminances(const Image& picture) {
  std::vector<double> luminances;
  for (int y = 0; y < picture.height; ++y)
    for (int x = 0; x < picture.width; ++x)
      if (const vec3 rgb = picture.rgb(x, y); isFinite(rgb)) {
        const dvec3 light = max(dvec3(rgb), dvec3(0.0));
        luminances.push_back(0.2126 * light.x + 0.7152 * light.y + 0.0722 * light.z);
      }
  return luminances;
}

/// The mean of the two in the middle of an even number. @param values  not empty; put in another order
double takeMedian(std::span<double> values) {
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  if (values.size() % 2 == 1) return *middle;
  return 0.5 * (*middle + *std::max_element(values.begin(), middle));
}

/// Luminance of the median, or of the median of those above `black` if that is not.
double findMiddle(std::vector<double> luminances, double black) {
  const double median = takeMedian(luminances);
  if (median > black) return median;
  std::erase_if(luminances, [black](double luminance) { return luminance <= black; });
  return takeMedian(luminances);
}

/// Two pictures within a band, and what becomes of them.
class Band {
 public:
  Band(const FlipObserver& observer, const Image& image, const Image& reference, int first_row, int row_count)
      : observer_(observer),
        image_(image),
        reference_(reference),
        first_row_(first_row),
        row_count_(row_count),
        shown_(image.width + 2 * observer.border(), row_count + 2 * observer.border()),
        image_percept_(image.width, row_count),
        reference_percept_(image.width, row_count) {}

  /// Raises the map's pixels to the error at this exposure.
  void raise(Image& map, const Exposure& exposure) {
    look(image_, exposure, image_percept_);
    look(reference_, exposure, reference_percept_);
    for (int y = 0; y < row_count_; ++y)
      for (int x = 0; x < map.width; ++x) {
        float& error = *map.at(x, first_row_ + y);
        error = std::max(error, computeFlip(image_percept_, reference_percept_, x, y));
      }
  }

  void markUnknown(Image& map) const {
    for (int y = first_row_; y < first_row_ + row_count_; ++y)
      for (int x = 0; x < map.width; ++x)
        if (!isKnown(x, y)) *map.at(x, y) = std::numeric_limits<float>::quiet_NaN();
  }

 private:
  bool isKnown(int x, int y) const { return isFinite(image_.rgb(x, y)) && isFinite(reference_.rgb(x, y)); }

  /// Pixels beyond the picture's edges are as the nearest within.
  void look(const Image& picture, const Exposure& exposure, Percept& percept) {
    const int border = observer_.border();
    for (int row = 0; row < shown_.luminance.height; ++row) {
      const int y = std::clamp(first_row_ + row - border, 0, picture.height - 1);
      for (int x = 0; x < picture.width; ++x) {
        const vec3 shown = isKnown(x, y) ? display(picture.rgb(x, y), exposure) : vec3(0.0F);
        const vec3 opponent = toOpponent(shown);
        shown_.luminance.row(row)[border + x] = opponent.x;
        shown_.red_green.row(row)[border + x] = opponent.y;
        shown_.blue_yellow.row(row)[border + x] = opponent.z;
      }
      for (Plane* plane : {&shown_.luminance, &shown_.red_green, &shown_.blue_yellow}) {
        float* begin = plane->row(row);
        std::fill_n(begin, border, begin[border]);
        std::fill_n(begin + border + picture.width, border, begin[border + picture.width - 1]);
      }
    }
    observer_.look(shown_, percept);
  }

  const FlipObserver& observer_;
  const Image& image_;
  const Image& reference_;
  int first_row_, row_count_;
  OpponentPlanes shown_;
  Percept image_percept_, reference_percept_;
};

void checkViewing(const Viewing& viewing) {
  const float ppd = viewing.pixels_per_degree;
  if (!(ppd >= kMinPixelsPerDegree && ppd <= kMaxPixelsPerDegree))
    throw UsageError(
        fmt::format("{} pixels per degree; expected {} to {}", ppd, kMinPixelsPerDegree, kMaxPixelsPerDegree));
}

std::vector<Exposure> chooseExposures(const Image& image, const Image& reference, const Viewing& viewing) {
  if (viewing.display_referred) return {std::nullopt};
  const std::vector<double> exposures = computeFlipExposures(image, reference);
  return {exposures.begin(), exposures.end()};
}

}  // namespace

std::vector<double> computeFlipExposures(const Image& image, const Image& reference) {
  for (const Image* picture : {&reference, &image}) {
    std::vector<double> luminances = collectLuminances(*picture);
    const double brightest = luminances.empty() ? 0.0 : *std::max_element(luminances.begin(), luminances.end());
    if (brightest == 0.0) continue;
    const double middle = findMiddle(std::move(luminances), std::exp2(-double{kBlackOctaves}) * brightest);
    const double stops = std::log2(brightest / middle);
    const int steps = std::max(static_cast<int>(std::ceil(stops)) - 1, 1);
    const double first = invertFilmicCurve() / brightest;
    std::vector<double> exposures;
    // As multiples of the first one, so that pictures that are brighter by a power of two are shown alike to the bit.
    for (int i = 0; i <= steps; ++i) exposures.push_back(first * std::exp2(stops * i / steps));
    return exposures;
  }
  return {1.0};  // both black
}

Image computeFlipMap(const Image& image, const Image& reference, const Viewing& viewing) {
  checkSameSize(image, reference);
  checkViewing(viewing);
  const FlipObserver observer(viewing.pixels_per_degree);
  const std::vector<Exposure> exposures = chooseExposures(image, reference, viewing);
  Image map(image.width, image.height, 1);
  const int band_count = (image.height + kBandRows - 1) / kBandRows;
  parallelFor(static_cast<std::size_t>(band_count), [&](std::size_t index) {
    const int first_row = static_cast<int>(index) * kBandRows;
    Band band(observer, image, reference, first_row, std::min(kBandRows, image.height - first_row));
    for (const Exposure& exposure : exposures) band.raise(map, exposure);
    band.markUnknown(map);
  });
  return map;
}

double computeFlip(const Image& image, const Image& reference, std::span<const std::uint8_t> mask,
                   const Viewing& viewing) {
  checkMask(image, mask);
  const Image map = computeFlipMap(image, reference, viewing);
  double sum = 0.0;
  std::size_t count = 0;
  forEachPixel(map, mask, [&](int x, int y) {
    sum += double{*map.at(x, y)};
    ++count;
  });
  return sum / static_cast<double>(count);
}

}  // namespace nephroid
