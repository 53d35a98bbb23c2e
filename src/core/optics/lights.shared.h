// Lights without a size, as glTF's KHR_lights_punctual defines them, in radiometric units.
#ifndef NEPHROID_LIGHTS_SHARED_H
#define NEPHROID_LIGHTS_SHARED_H

#include "bridge.shared.h"

NEPHROID_NAMESPACE_BEGIN

/// Share of a spot's intensity that is left at an angle off its axis: the squared linear ramp between the cosines of
/// its two cones (KHR_lights_punctual, "Inner and Outer Cone Angles").
///
/// @param cos_angle  cosine of the angle between the spot's axis and the direction of travel
/// @param cos_inner  cosine of the inner half-angle; full intensity inside
/// @param cos_outer  cosine of the outer half-angle, <= cos_inner; nothing outside
/// @return           in [0, 1]
/// @note  Cones that coincide would divide by zero. Their edge is given a width of 1e-7 in the cosine, which is about
///        its rounding error in single precision.
NEPHROID_FN float spotFalloff(float cos_angle, float cos_inner, float cos_outer) {
  float ramp = clamp((cos_angle - cos_outer) / max(cos_inner - cos_outer, 1e-7f), 0.0f, 1.0f);
  return ramp * ramp;
}

/// Radiant intensity of a spot along a direction, W/sr.
///
/// @param intensity  on the axis, W/sr
/// @param axis       unit, along the travel of light
/// @param cos_inner  as for spotFalloff
/// @param cos_outer  as for spotFalloff
/// @param dir        unit, along the travel of light
NEPHROID_FN vec3 spotIntensity(vec3 intensity, vec3 axis, float cos_inner, float cos_outer, vec3 dir) {
  return intensity * spotFalloff(dot(dir, axis), cos_inner, cos_outer);
}

/// Irradiance from a point or spot light: E = I·cosθ/d², W/m².
///
/// @param intensity         along the direction to the receiver, W/sr
/// @param distance_squared  d², m², > 0; at 0 the result is infinite or not a number
/// @param cos_theta_i       between the receiver's normal and the direction to the light; below 0 counts as 0
NEPHROID_FN vec3 irradianceFromPoint(vec3 intensity, float distance_squared, float cos_theta_i) {
  return intensity * max(cos_theta_i, 0.0f) / distance_squared;
}

/// Irradiance from a sun: E = E⊥·cosθ, W/m².
///
/// @param irradiance_perpendicular  E⊥, on a surface that faces the sun, W/m²
/// @param cos_theta_i               as for irradianceFromPoint
NEPHROID_FN vec3 irradianceFromSun(vec3 irradiance_perpendicular, float cos_theta_i) {
  return irradiance_perpendicular * max(cos_theta_i, 0.0f);
}

/// Solid angle of a small cell on the plane at distance 1 from a point: ω = A·cos³, sr. (Of the texel (u, v) of a cube
/// map's face, A = 4/N²; over six faces it sums to 4π, but for the midpoint rule's error of order 1/N².)
///
/// @param u, v  of the cell's middle, from the foot of the perpendicular
/// @param area  of the cell on that plane
NEPHROID_FN float cellSolidAngle(float u, float v, float area) {
  float squared = 1.0f + u * u + v * v;
  return area / (squared * sqrt(squared));
}

NEPHROID_NAMESPACE_END

#endif
