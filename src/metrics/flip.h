// FLIP: how much an eye sees change where one picture takes the place of the other.
#pragma once

#include <span>
#include <vector>

#include "core/image/image.h"

namespace nephroid {

/// What an observer has on a screen 0.7 m wide of 3840 pixels, 0.7 m away ([andersson-2020]).
inline constexpr float kDefaultPixelsPerDegree = 67.0F;
/// Below, filters are narrower than a pixel; above, they are wider than any feature of a picture.
inline constexpr float kMinPixelsPerDegree = 10.0F, kMaxPixelsPerDegree = 1000.0F;

/// How the pictures are looked at.
struct Viewing {
  bool display_referred = false;  ///< values in [0, 1] are what a screen shows; else exposed and tone mapped for it
  float pixels_per_degree = kDefaultPixelsPerDegree;  ///< of visual angle
};

/// FLIP by pixel, in [0, 1]: `height × width × 1`.
///
/// Display-referred pictures are compared as they are, outside [0, 1] clipped (LDR-FLIP, [andersson-2020]); others at
/// each of computeFlipExposures, and the largest error counts (HDR-FLIP, [andersson-2021]). Equal for any number of
/// threads. A pixel that is not finite in either picture is black in both, so that it says nothing of its neighbours,
/// and NaN in the map.
/// @throws InputError if sizes differ, UsageError if pixels_per_degree is out of its range
Image computeFlipMap(const Image& image, const Image& reference, const Viewing& viewing);

/// The factors that HDR-FLIP exposes both pictures with before the tone curve, from the darkest on; at least one.
///
/// From the one that brings the brightest pixel of the reference to 0.85 of white to the one that does so for the
/// median of its luminance, a stop apart at most ([andersson-2021]). Where more than half of the reference is
/// black, as it is of a caustic alone, there is no such exposure: then the median is that of its other pixels. Black is
/// what is 20 stops or more below the brightest. A reference without any light takes the picture's exposures.
std::vector<double> computeFlipExposures(const Image& image, const Image& reference);

/// Mean of computeFlipMap over the pixels that the mask selects: the metric `flip`.
/// @throws InputError, UsageError
double computeFlip(const Image& image, const Image& reference, std::span<const std::uint8_t> mask,
                   const Viewing& viewing);

}  // namespace nephroid
