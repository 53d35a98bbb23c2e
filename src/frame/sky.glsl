// What shines without being a surface, as it is seen: the environment, spheres, suns.
//
// The including shader gives the two bindings from NEPHROID_SKY_BINDINGS on, and declares before, among what is pushed
// to it: SamplePush push.
#ifndef NEPHROID_SKY_GLSL
#define NEPHROID_SKY_GLSL

#include "frame/ray.glsl"
#include "core/optics/lights.shared.h"

layout(set = 0, binding = NEPHROID_SKY_BINDINGS) uniform usamplerBuffer lamp_table;
layout(set = 0, binding = NEPHROID_SKY_BINDINGS + 1) uniform sampler2D environment;

layout(constant_id = 5) const bool kSceneHasEnvironment = true;
layout(constant_id = 6) const bool kSceneHasLamps = true;  // lights with a size, which are seen
layout(constant_id = 7) const bool kSceneEmits = true;     // any of its materials

const float kPi = 3.14159265358979;

vec3 environmentFrom(vec3 dir) {
  float x = dir.x * push.cos_rotation - dir.z * push.sin_rotation;
  float z = dir.x * push.sin_rotation + dir.z * push.cos_rotation;
  float u = x == 0.0 && z == 0.0 ? 0.5 : 0.5 + atan(x, -z) * (0.5 / kPi);
  float v = acos(clamp(dir.y, -1.0, 1.0)) / kPi;
  return push.environment_scale * textureLod(environment, vec2(u, v), 0.0).xyz;
}

LampRecord fetchLamp(uint i) {
  vec4 position = uintBitsToFloat(texelFetch(lamp_table, int(4u * i)));
  vec4 radiance = uintBitsToFloat(texelFetch(lamp_table, int(4u * i + 1u)));
  vec4 direction = uintBitsToFloat(texelFetch(lamp_table, int(4u * i + 2u)));
  uvec4 rest = texelFetch(lamp_table, int(4u * i + 3u));
  return LampRecord(position.xyz, position.w, radiance.xyz, radiance.w, direction.xyz, direction.w,
                    uintBitsToFloat(rest.x), rest.y, 0u, 0u);
}

/// A sphere that the ray enters before `t_max`: it shines but hides nothing.
vec3 sphereSeen(LampRecord lamp, Ray ray, float t_max) {
  vec3 to_centre = lamp.position - ray.origin;
  float along = dot(to_centre, ray.dir), squared_radius = lamp.radius * lamp.radius;
  vec3 beside = to_centre - along * ray.dir;
  float room = squared_radius - dot(beside, beside);
  if (along <= 0.0 || dot(to_centre, to_centre) <= squared_radius || room < 0.0) return vec3(0.0);
  if (along - sqrt(room) >= t_max) return vec3(0.0);
  float falloff = lamp.is_spot != 0u ? spotFalloff(-dot(ray.dir, lamp.direction), lamp.cos_inner, lamp.cos_outer) : 1.0;
  return lamp.radiance * falloff;
}

/// @param t_max  kFarAway where the ray meets nothing
vec3 lampsSeen(Ray ray, float t_max) {
  vec3 sum = vec3(0.0);
  for (uint i = 0u; i < push.lamp_count; ++i) {
    LampRecord lamp = fetchLamp(i);
    if (lamp.radius > 0.0) {
      sum += sphereSeen(lamp, ray, t_max);
    } else {
      // 1 − cos of the angle from half the squared chord: exact for the small angles of a sun.
      vec3 chord = ray.dir + lamp.direction;
      if (t_max == kFarAway && 0.5 * dot(chord, chord) <= lamp.one_minus_cos) sum += lamp.radiance;
    }
  }
  return sum;
}

#endif
