// Every function of floats of tonemap.shared.h on one input, for the device and for C++. No include guard: its test compiles it
// twice.
#include "core/image/tonemap.shared.h"

NEPHROID_NAMESPACE_BEGIN

struct TonemapInput {
  float value;  // >= 0
};

struct TonemapOutput {
  float filmic;
  float coded;
  float decoded;
};

NEPHROID_FN TonemapOutput evaluateTonemap(TonemapInput given) {
  TonemapOutput result;
  result.filmic = applyFilmicCurve(given.value);
  result.coded = srgbFromLinear(min(given.value, 1.0f));
  result.decoded = linearFromSrgb(min(given.value, 1.0f));
  return result;
}

NEPHROID_NAMESPACE_END
