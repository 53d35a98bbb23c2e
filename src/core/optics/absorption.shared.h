// Light lost on a straight path inside a homogeneous absorber.
#ifndef NEPHROID_ABSORPTION_SHARED_H
#define NEPHROID_ABSORPTION_SHARED_H

#include "bridge.shared.h"

NEPHROID_NAMESPACE_BEGIN

/// Transmittance of one channel; see transmittance().
///
/// The zeros are asked for by name because an opaque medium has sigma_a = infinity and a path that leaves the scene
/// has distance = infinity, and infinity·0 is not a number. The optical depth is bounded because GLSL's exp() is not
/// defined at −infinity; exp(−1000) is already 0 in single precision.
NEPHROID_FN float transmittanceChannel(float sigma_a, float distance) {
  if (sigma_a == 0.0f || distance == 0.0f) return 1.0f;
  return exp(-min(sigma_a * distance, 1000.0f));
}

/// Fraction of light that survives a straight path through a homogeneous absorber (Beer–Lambert).
///
/// @param sigma_a   absorption coefficient per channel, 1/m, >= 0, may be infinite
/// @param distance  geometric path length, m, >= 0 (the path inside, after refraction), may be infinite
/// @return          per channel, in [0, 1]; exactly 1 at distance 0; 0, not NaN, when it underflows
/// @see             [shah-caustics-mapping] eq. 7, where it is K_a and d.
NEPHROID_FN vec3 transmittance(vec3 sigma_a, float distance) {
  return vec3(transmittanceChannel(sigma_a.x, distance), transmittanceChannel(sigma_a.y, distance),
              transmittanceChannel(sigma_a.z, distance));
}

NEPHROID_NAMESPACE_END

#endif
