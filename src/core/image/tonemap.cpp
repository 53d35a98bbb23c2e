#include "core/image/tonemap.h"

#include <algorithm>
#include <cmath>
#include <vector>

namespace nephroid {
namespace {

/// Middle grey: what the log-average is mapped to (the "key" of Reinhard et al. 2002, section 3.1).
constexpr double kMiddleGrey = 0.18;
/// Where auto exposure lets the 99th percentile lie at most. A caustic is small, bright and the point of the picture:
/// by the log-average alone it would be burnt out. Four times white still shades through the filmic curve.
constexpr double kMaxHighlight = 4.0;
constexpr double kHighlightQuantile = 0.99;
/// Pixels dimmer than this fraction of the highlights are as good as black; a logarithm would let a few stray photons
/// in the dark rule the whole picture.
constexpr double kBlackFraction = 0x1p-20;

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

/// Narkowicz' rational fit of the ACES curve (K. Narkowicz, "ACES Filmic Tone Mapping Curve", 2015):
/// x (2.51 x + 0.03) / (x (2.43 x + 0.59) + 0.14), clamped to 1.
/// The argument is scaled so that middle grey stays middle grey and switching the curve on does not change exposure:
/// 2.0726 x² − 0.0762 x − 0.0252 = 0 gives the x = 0.13017 that the curve maps to 0.18; hence 0.13017 / 0.18.
float applyFilmicCurve(float linear) {
  constexpr float kGreyScale = 0.72316F;
  constexpr float kSaturated = 1e4F;  // far into the clamp, and its square is still finite
  const float x = std::min(linear * kGreyScale, kSaturated);
  return std::min(x * (2.51F * x + 0.03F) / (x * (2.43F * x + 0.59F) + 0.14F), 1.0F);
}

}  // namespace

/// exp of the mean log luminance over the pixels that are not black goes to 0.18; but the 99th percentile of the
/// luminance of those pixels goes to 4 at most.
float computeAutoExposure(const Image& radiance) {
  std::vector<double> luminances = collectPositiveLuminances(radiance);
  if (luminances.empty()) return 0.0F;
  const auto rank = static_cast<std::size_t>(std::ceil(kHighlightQuantile * static_cast<double>(luminances.size())));
  const auto highlight = luminances.begin() + static_cast<std::ptrdiff_t>(std::max<std::size_t>(rank, 1) - 1);
  std::nth_element(luminances.begin(), highlight, luminances.end());
  const double highlight_luminance = *highlight;

  // nth_element leaves an order that depends on the library; sorted, the sum is the same everywhere.
  std::sort(luminances.begin(), luminances.end());
  double log_sum = 0.0;
  std::size_t count = 0;
  for (const double l : luminances) {
    if (l < kBlackFraction * highlight_luminance) continue;
    log_sum += std::log2(l);
    ++count;
  }
  const double grey_ev = std::log2(kMiddleGrey) - log_sum / static_cast<double>(count);
  const double highlight_ev = std::log2(kMaxHighlight / highlight_luminance);
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

float srgbFromLinear(float linear) {
  return linear <= 0.0031308F ? 12.92F * linear : 1.055F * std::pow(linear, 1.0F / 2.4F) - 0.055F;
}

float linearFromSrgb(float coded) {
  return coded <= 0.04045F ? coded / 12.92F : std::pow((coded + 0.055F) / 1.055F, 2.4F);
}

}  // namespace nephroid
