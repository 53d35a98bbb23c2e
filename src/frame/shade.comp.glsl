// One frame's sample of each pixel: `direct` and `emission` of what it shows, added to their sums.
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#extension GL_EXT_control_flow_attributes : require
#define NEPHROID_LIGHT_BINDINGS 7
#include "frame/lights.glsl"
#include "frame/passable.glsl"
#include "frame/sample_push.shared.h"

layout(local_size_x = 8, local_size_y = 8) in;
layout(scalar, set = 0, binding = 11) readonly buffer Views { ViewRecord views[]; };
layout(set = 0, binding = 12) uniform usampler2D seen_image;
layout(set = 0, binding = 13) uniform sampler2D tint_image;  // of what lies before what is shown
layout(set = 0, binding = 16, rgba32f) uniform image2D direct_image;    // sum over samples, W/m²/sr
layout(set = 0, binding = 17, rgba32f) uniform image2D emission_image;  // likewise

layout(push_constant, scalar) uniform Push { SamplePush push; };

#define NEPHROID_SKY_BINDINGS 14
#include "frame/sky.glsl"

struct Shaded {
  vec3 direct;
  vec3 emission;
  float t;
};

Shaded shade(Ray ray, uvec2 seen, uvec2 pixel) {
  Surface s = surfaceSeen(ray, seen.x - 1u, seen.y);
  MaterialPoint m = materialAt(s.instance, s.triangle, s.u, s.v);
  if (kSceneHasTextures) s.shading = perturbedNormal(s);
  float weight = kSceneHasPassable ? passageAt(s, m, ray.dir, pixel, push.frame).weight : 1.0;
  Shaded result = Shaded(vec3(0.0), vec3(0.0), dot(s.position - ray.origin, ray.dir));
  bool front = dot(ray.dir, s.geometric) < 0.0;
  if (kSceneEmits && (front || m.double_sided)) result.emission = weight * m.emission;
  if (!front) {
    s.geometric = -s.geometric;
    s.shading = -s.shading;
  }
  // Near a silhouette the interpolated normal may look away from the eye: the true one cannot.
  if (dot(s.shading, -ray.dir) <= 1e-4) s.shading = s.geometric;
  bool has_interface = m.optics.alpha >= push.specular_alpha && (kSceneHasMetal || kSceneHasGloss);
  if (m.base_weight <= 0.0 && !has_interface) return result;
  result.direct = weight * lightFromAll(push.light_count, s, m, -ray.dir, push.specular_alpha);
  return result;
}

void main() {
  ivec2 pixel = ivec2(gl_GlobalInvocationID.xy);
  ivec2 size = imageSize(direct_image);
  if (pixel.x >= size.x || pixel.y >= size.y) return;
  Ray ray = rayThrough(views[0], (vec2(pixel) + push.film_offset) / vec2(size) * 2.0 - 1.0);
  uvec2 seen = texelFetch(seen_image, pixel, 0).xy;
  Shaded shaded = Shaded(vec3(0.0), vec3(0.0), kFarAway);
  if (seen.x != 0u) {
    shaded = shade(ray, seen, uvec2(pixel));
  } else if (kSceneHasEnvironment) {
    shaded.emission = environmentFrom(ray.dir);
  }
  if (kSceneHasLamps) shaded.emission += lampsSeen(ray, shaded.t);
  if (kSceneHasPassable) {
    vec3 tint = texelFetch(tint_image, pixel, 0).xyz;
    shaded.direct *= tint;
    shaded.emission *= tint;
  }
  if (shaded.direct != vec3(0.0)) imageStore(direct_image, pixel, imageLoad(direct_image, pixel) + vec4(shaded.direct, 0.0));
  if ((kSceneHasEnvironment || kSceneHasLamps || kSceneEmits) && shaded.emission != vec3(0.0))
    imageStore(emission_image, pixel, imageLoad(emission_image, pixel) + vec4(shaded.emission, 0.0));
}
