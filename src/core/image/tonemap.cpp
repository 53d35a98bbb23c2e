#include "core/image/tonemap.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <vector>

namespace nephroid {
namespace {

std::vector<double> collectPositiveLuminances(const Image& radiance) {
  std::vector<double> luminances;
  luminances.reserve(static_cast<std::size_t>(radiance.width) * static_cast<std::size_t>(radiance.height));
  for (int y = 0; y < radiance.height; ++y)
    for (int x = 0; x < radiance.width; ++x) {
      const double l = luminance(radiance.rgb(x, y));
      if (l > 0.0 && std::isfinite(l)) luminances.push_back(l);
    }
  return luminances;
}

}  // namespace

/// exp of the mean log luminance over the pixels that are not black goes to 0.18; but the 99th percentile of the
/// luminance of those pixels goes to 4 at most.
float computeAutoExposure(const Image& radiance) {
  std::vector<double> luminances = collectPositiveLuminances(radiance);
  if (luminances.empty()) return 0.0F;
  const std::uint32_t rank = highlightRank(static_cast<std::uint32_t>(luminances.size()));
  const auto highlight = luminances.begin() + static_cast<std::ptrdiff_t>(rank - 1);
  std::nth_element(luminances.begin(), highlight, luminances.end());
  const double highlight_luminance = *highlight;

  // nth_element leaves an order that depends on the library; sorted, the sum is the same everywhere.
  std::sort(luminances.begin(), luminances.end());
  const double black = std::exp2(-double{kBlackOctaves}) * highlight_luminance;
  double log_sum = 0.0;
  std::size_t count = 0;
  for (const double l : luminances) {
    if (l < black) continue;
    log_sum += std::log2(l);
    ++count;
  }
  const double grey_ev = std::log2(double{kMiddleGrey}) - log_sum / static_cast<double>(count);
  const double highlight_ev = std::log2(double{kMaxHighlight} / highlight_luminance);
  return static_cast<float>(std::min(grey_ev, highlight_ev));
}

Image toDisplay(const Image& radiance, float exposure_ev, ToneMap tone_map) {
  Image display(radiance.width, radiance.height, 3);
  const float scale = std::exp2(exposure_ev);
  for (int y = 0; y < radiance.height; ++y)
    for (int x = 0; x < radiance.width; ++x) {
      const vec3 rgb = radiance.rgb(x, y) * scale;
      vec3 coded;
      for (int c = 0; c < 3; ++c) {
        const float positive = rgb[c] > 0.0F ? rgb[c] : 0.0F;  // NaN is black, too
        const float mapped = tone_map == ToneMap::kFilmic ? applyFilmicCurve(positive) : std::min(positive, 1.0F);
        coded[c] = srgbFromLinear(mapped);
      }
      display.setRgb(x, y, coded);
    }
  return display;
}

}  // namespace nephroid
