// Curves from linear light to what a screen is sent, for C++ and GLSL.
#ifndef NEPHROID_TONEMAP_SHARED_H
#define NEPHROID_TONEMAP_SHARED_H

#include "../optics/bridge.shared.h"

NEPHROID_NAMESPACE_BEGIN

/// What the log-average of a picture is mapped to (the "key" of Reinhard et al. 2002, section 3.1).
NEPHROID_CONST float kMiddleGrey = 0.18f;
/// Where automatic exposure lets the 99th percentile (highlightRank) lie at most. A caustic is small, bright and the point of the
/// picture: by the log-average alone it would be burnt out. Four times white still shades through the filmic curve.
NEPHROID_CONST float kMaxHighlight = 4.0f;
/// In octaves: what is dimmer than the highlights by more is as good as black; a logarithm would let a few stray photons
/// in the dark rule the whole picture.
NEPHROID_CONST float kBlackOctaves = 20.0f;

/// Of `count` values in ascending order, from 1, the one that 99 % do not exceed: the least whole number that is not
/// below 0.99 · count.
NEPHROID_FN uint highlightRank(uint count) { return count - count / 100u; }

/// Scales the argument of the filmic curve so that middle grey stays middle grey and switching the curve on does not
/// change exposure: 2.0726 x² − 0.0762 x − 0.0252 = 0 gives the x = 0.13017 that the curve maps to 0.18; hence
/// 0.13017 / 0.18.
NEPHROID_CONST float kFilmicCurveScale = 0.72316f;

/// Narkowicz' rational fit of the ACES curve (K. Narkowicz, "ACES Filmic Tone Mapping Curve", 2015):
/// x (2.51 x + 0.03) / (x (2.43 x + 0.59) + 0.14) of x = kFilmicCurveScale · linear, clamped to 1.
///
/// @param linear  >= 0
NEPHROID_FN float applyFilmicCurve(float linear) {
  // Far into the clamp, and its square is still finite.
  float x = min(linear * kFilmicCurveScale, 1e4f);
  return min(x * (2.51f * x + 0.03f) / (x * (2.43f * x + 0.59f) + 0.14f), 1.0f);
}

/// IEC 61966-2-1 transfer functions, of [0, 1].
NEPHROID_FN float srgbFromLinear(float linear) {
  return linear <= 0.0031308f ? 12.92f * linear : 1.055f * pow(linear, 1.0f / 2.4f) - 0.055f;
}

NEPHROID_FN float linearFromSrgb(float coded) {
  return coded <= 0.04045f ? coded / 12.92f : pow((coded + 0.055f) / 1.055f, 2.4f);
}

NEPHROID_NAMESPACE_END

#endif
