// Every function of lights.shared.h on one input, for the device and for C++. No include guard: its test compiles it
// twice.
#include "core/optics/lights.shared.h"

NEPHROID_NAMESPACE_BEGIN

struct LightsInput {
  vec3 intensity;
  vec3 axis;
  vec3 dir;
  float cos_angle;
  float cos_inner;
  float cos_outer;
  float distance_squared;
  float cos_theta_i;
};

struct LightsOutput {
  float falloff;
  vec3 spot;
  vec3 from_point;
  vec3 from_sun;
  float solid_angle;
};

NEPHROID_FN LightsOutput evaluateLights(LightsInput given) {
  LightsOutput result;
  result.falloff = spotFalloff(given.cos_angle, given.cos_inner, given.cos_outer);
  result.spot = spotIntensity(given.intensity, given.axis, given.cos_inner, given.cos_outer, given.dir);
  result.from_point = irradianceFromPoint(given.intensity, given.distance_squared, given.cos_theta_i);
  result.from_sun = irradianceFromSun(given.intensity, given.cos_theta_i);
  result.solid_angle = cellSolidAngle(3.0f * given.dir.x, given.cos_theta_i, 1.0f);
  return result;
}

NEPHROID_NAMESPACE_END
