// What surfaces of class D make of the irradiance that a technique found: `caustic`, added to its sum.
//
// Diffuse lobes see the irradiance alone; glossy ones are evaluated along its mean direction, which is exact where one
// fold of the caustic lights a pixel and blurred where several cross.
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#include "frame/passable.glsl"
#include "frame/response.glsl"

layout(local_size_x = 8, local_size_y = 8) in;
layout(scalar, set = 0, binding = 7) uniform Views { ViewRecord views[1]; };
layout(set = 0, binding = 8, rg32ui) readonly uniform uimage2D seen_image;
layout(set = 0, binding = 9) uniform sampler2D tint_image;  // of what lies before what is shown
layout(set = 0, binding = 10, rgba32f) readonly uniform image2D irradiance_image;
layout(set = 0, binding = 11, rgba32f) readonly uniform image2D direction_image;
layout(set = 0, binding = 12, rgba32f) uniform image2D caustic_image;     // sum over samples, W/m²/sr
layout(set = 0, binding = 13, rgba32f) uniform image2D irradiance_sum;  // likewise, W/m²

layout(push_constant, scalar) uniform Push {
  uint frame;
  float specular_alpha;
};

void main() {
  ivec2 pixel = ivec2(gl_GlobalInvocationID.xy);
  ivec2 size = imageSize(caustic_image);
  if (pixel.x >= size.x || pixel.y >= size.y) return;
  vec3 irradiance = imageLoad(irradiance_image, pixel).xyz;
  uvec2 seen = imageLoad(seen_image, pixel).xy;
  if (seen.x == 0u || irradiance == vec3(0.0)) return;
  ViewRecord view = views[0];
  Ray ray = rayThrough(view, (vec2(pixel) + vec2(view.film_x, view.film_y)) / vec2(size) * 2.0 - 1.0);
  Surface s = surfaceSeen(ray, seen.x - 1u, seen.y);
  MaterialPoint m = materialAt(s.instance, s.triangle, s.u, s.v);
  if (kSceneHasTextures) s.shading = perturbedNormal(s);
  vec3 weight = vec3(1.0);
  if (kSceneHasPassable)
    weight = passageAt(s, m, ray.dir, uvec2(pixel), frame).weight * texelFetch(tint_image, pixel, 0).xyz;
  if (dot(ray.dir, s.geometric) >= 0.0) s.shading = -s.shading;
  vec3 geometric = dot(ray.dir, s.geometric) >= 0.0 ? -s.geometric : s.geometric;
  if (dot(s.shading, -ray.dir) <= 1e-4) s.shading = geometric;
  bool has_interface = m.optics.alpha >= specular_alpha && (kSceneHasMetal || kSceneHasGloss);
  if (m.base_weight <= 0.0 && !has_interface) return;
  vec3 from = -imageLoad(direction_image, pixel).xyz;
  // Opposite directions cancel: then the light is taken to fall straight on.
  float squared = dot(from, from);
  vec3 wi = squared > 0.0 && dot(from, s.shading) > 0.0 ? from * inversesqrt(squared) : s.shading;
  imageStore(irradiance_sum, pixel, imageLoad(irradiance_sum, pixel) + vec4(irradiance, 0.0));
  vec3 radiance = weight * respond(s, m, -ray.dir, wi, specular_alpha) * irradiance;
  imageStore(caustic_image, pixel, imageLoad(caustic_image, pixel) + vec4(radiance, 0.0));
}
