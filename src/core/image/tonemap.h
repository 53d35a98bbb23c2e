// From scene-referred radiance to display values.
#pragma once

#include "core/image/image.h"
#include "core/image/tonemap.shared.h"

namespace nephroid {

enum class ToneMap { kClamp, kFilmic };

/// Exposure value such that 18 % grey lands on the picture's log-average luminance, highlights kept: see the .cpp.
/// @return EV; multiply radiance by 2^EV. 0 for a black picture.
float computeAutoExposure(const Image& radiance);

/// Linear in [0, ∞) to sRGB-coded in [0, 1]: exposure, then clamp (kClamp) or a filmic curve (kFilmic), then sRGB.
/// Negative values (signed dispersion bands) are clamped here and nowhere else.
Image toDisplay(const Image& radiance, float exposure_ev, ToneMap tone_map);

}  // namespace nephroid
