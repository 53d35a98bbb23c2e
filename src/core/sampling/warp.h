// From the unit square to the shapes that light is sampled on: sample, density and inverse of each.
//
// Every sample… maps [0, 1)² continuously but for one cut and keeps areas up to a constant factor, so stratified points
// stay stratified. invert…(sample…(u)) is u up to rounding. The density's measure is in its name.
#pragma once

#include <algorithm>
#include <cmath>

#include "core/math.h"

namespace nephroid {

/// Unit disc, uniform by area; concentric squares become concentric circles [shirley-chiu-1997].
inline vec2 sampleConcentricDisc(vec2 u) {
  const float x = 2.0F * u.x - 1.0F, y = 2.0F * u.y - 1.0F;
  if (x == 0.0F && y == 0.0F) return {0, 0};
  if (std::abs(x) > std::abs(y)) {
    const float phi = kPi / 4.0F * (y / x);
    return {x * std::cos(phi), x * std::sin(phi)};
  }
  const float phi = kPi / 4.0F * (x / y);
  return {y * std::sin(phi), y * std::cos(phi)};
}
/// 1/π everywhere on the unit disc.
inline constexpr float pdfAreaConcentricDisc() { return 1.0F / kPi; }
inline vec2 invertConcentricDisc(vec2 p) {
  const float r = std::sqrt(p.x * p.x + p.y * p.y);
  float x, y;
  if (std::abs(p.x) > std::abs(p.y)) {
    x = std::copysign(r, p.x);
    y = x * std::atan(p.y / p.x) * (4.0F / kPi);
  } else {
    y = std::copysign(r, p.y);
    x = p.y == 0.0F ? 0.0F : y * std::atan(p.x / p.y) * (4.0F / kPi);
  }
  return {0.5F * (x + 1.0F), 0.5F * (y + 1.0F)};
}

/// Hemisphere about +z with density cos θ/π per solid angle [Malley's method]: the disc, lifted.
inline vec3 sampleCosineHemisphere(vec2 u) {
  const vec2 p = sampleConcentricDisc(u);
  return {p.x, p.y, std::sqrt(std::max(1.0F - p.x * p.x - p.y * p.y, 0.0F))};
}
/// @param cos_theta  0 below the horizon
inline constexpr float pdfSolidAngleCosineHemisphere(float cos_theta) {
  return cos_theta > 0.0F ? cos_theta / kPi : 0.0F;
}
inline vec2 invertCosineHemisphere(vec3 dir) { return invertConcentricDisc({dir.x, dir.y}); }

/// Whole sphere, uniform by solid angle: z = 1 − 2·u.x, angle 2π·u.y.
inline vec3 sampleUniformSphere(vec2 u) {
  const float phi = 2.0F * kPi * u.y;
  // sin² from u directly: 1 − z² would cancel at the poles.
  const float r = 2.0F * std::sqrt(std::max(u.x * (1.0F - u.x), 0.0F));
  return {r * std::cos(phi), r * std::sin(phi), 1.0F - 2.0F * u.x};
}
inline constexpr float pdfSolidAngleUniformSphere() { return 1.0F / (4.0F * kPi); }
inline vec2 invertUniformSphere(vec3 dir) {
  const float turn = std::atan2(dir.y, dir.x) / (2.0F * kPi);
  const float sin2 = dir.x * dir.x + dir.y * dir.y;
  // (1 − z)/2; near z = 1 from sin², which has the digits that 1 − z lost.
  const float u = dir.z > 0.0F ? 0.5F * sin2 / (1.0F + dir.z) : 0.5F * (1.0F - dir.z);
  return {std::min(u, kOneMinusEpsilon), std::min(turn < 0.0F ? turn + 1.0F : turn, kOneMinusEpsilon)};
}

/// 1 − cos(half_angle) without cancellation: 2 sin²(half_angle/2). The cone's solid angle is 2π times this.
inline float oneMinusCos(float half_angle) {
  const float s = std::sin(0.5F * half_angle);
  return 2.0F * s * s;
}

/// Cone about +z, uniform by solid angle; the half angle may be as small as one likes (the sun's is 0.0046).
/// @param one_minus_cos_max  1 − cos of the half angle, in [0, 2]; 0 gives +z
inline vec3 sampleUniformCone(vec2 u, float one_minus_cos_max) {
  const vec2 p = sampleConcentricDisc(u);
  const float one_minus_z = (p.x * p.x + p.y * p.y) * one_minus_cos_max;
  // The radius sin θ = sqrt((1 − z)(1 + z)) over that of p on the disc.
  const float scale = std::sqrt(std::max(one_minus_cos_max * (2.0F - one_minus_z), 0.0F));
  return {p.x * scale, p.y * scale, 1.0F - one_minus_z};
}
/// Inside the cone; infinite for an angle of 0 (a delta).
inline constexpr float pdfSolidAngleUniformCone(float one_minus_cos_max) {
  return 1.0F / (2.0F * kPi * one_minus_cos_max);
}
/// @param one_minus_cos_max  > 0
inline vec2 invertUniformCone(vec3 dir, float one_minus_cos_max) {
  const float sin2 = dir.x * dir.x + dir.y * dir.y;
  const float one_minus_z = dir.z > 0.0F ? sin2 / (1.0F + dir.z) : 1.0F - dir.z;
  const float scale = std::sqrt(one_minus_cos_max * std::max(2.0F - one_minus_z, 1e-12F));
  return invertConcentricDisc({dir.x / scale, dir.y / scale});
}

/// Barycentric weights, uniform on any triangle, with little distortion [heitz-2019]: the square is folded, not
/// squeezed into a corner.
inline vec3 sampleUniformTriangle(vec2 u) {
  float x, y;
  if (u.x < u.y) {
    x = 0.5F * u.x;
    y = u.y - x;
  } else {
    y = 0.5F * u.y;
    x = u.x - y;
  }
  return {x, y, 1.0F - x - y};
}
/// @param area  of the triangle, m², > 0
inline constexpr float pdfAreaUniformTriangle(float area) { return 1.0F / area; }
inline vec2 invertUniformTriangle(vec3 barycentrics) {
  const float x = barycentrics.x, y = barycentrics.y;
  return x < y ? vec2(2.0F * x, x + y) : vec2(x + y, 2.0F * y);
}

}  // namespace nephroid
