// Mirror and refracted directions at a smooth interface.
//
// `dir` travels with the light; `n` is the unit normal on the side that `dir` comes from, so dot(dir, n) <= 0.
#ifndef NEPHROID_REFRACTION_SHARED_H
#define NEPHROID_REFRACTION_SHARED_H

#include "bridge.shared.h"

NEPHROID_NAMESPACE_BEGIN

/// Mirror direction. Unit, up to rounding, if both arguments are; does not depend on the sign of `n`.
NEPHROID_FN vec3 reflectDir(vec3 dir, vec3 n) { return dir - n * (2.0f * dot(dir, n)); }

struct Refraction {
  vec3 dir;    // unit; zero where not valid
  bool valid;  // false beyond the critical angle
};

/// Snell's law.
///
/// @param dir        unit, dot(dir, n) <= 0
/// @param n          unit, on the side that dir comes from
/// @param ior_ratio  ior_from / ior_to, > 0; at exactly 1 the direction is kept
/// @note  The plain form is r·dir + (r·c − t)·n with c = −dot(dir, n), r = ior_ratio, t = sqrt(1 − r²(1 − c²)). At r
///        near 1 the bracket cancels; multiplied by its conjugate it is (r² − 1)/(r·c + t). The result is normalised
///        again because paths through many interfaces would else drift away from unit length.
NEPHROID_FN Refraction refractDir(vec3 dir, vec3 n, float ior_ratio) {
  Refraction result;
  float c = max(-dot(dir, n), 0.0f);
  float one_minus_r2 = (1.0f - ior_ratio) * (1.0f + ior_ratio);
  float t2 = one_minus_r2 + ior_ratio * ior_ratio * c * c;
  result.valid = t2 >= 0.0f;
  result.dir = vec3(0.0f);
  if (!result.valid) return result;
  // Zero only at grazing incidence with ior_ratio 1, where nothing bends.
  float sum = ior_ratio * c + sqrt(t2);
  float along_n = sum > 0.0f ? -one_minus_r2 / sum : 0.0f;
  result.dir = normalize(dir * ior_ratio + n * along_n);
  return result;
}

NEPHROID_NAMESPACE_END

#endif
