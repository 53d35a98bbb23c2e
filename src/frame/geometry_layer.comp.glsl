// One of the layers that show geometry, at the centres of the pixels.
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#include "frame/material.glsl"

layout(local_size_x = 8, local_size_y = 8) in;
layout(scalar, set = 0, binding = 7) uniform Views { ViewRecord views[1]; };
layout(set = 0, binding = 8, rg32ui) readonly uniform uimage2D seen_image;
layout(set = 0, binding = 9, rgba32f) writeonly uniform image2D layer_image;

layout(push_constant, scalar) uniform Push { uint kind; };  // 0 albedo, 1 normal, 2 position, 3 depth, 4 id

void main() {
  ivec2 pixel = ivec2(gl_GlobalInvocationID.xy);
  ivec2 size = imageSize(layer_image);
  if (pixel.x >= size.x || pixel.y >= size.y) return;
  uvec2 seen = imageLoad(seen_image, pixel).xy;
  vec3 value = vec3(0.0);
  if (seen.x == 0u) {
    // Depth of nothing is infinite; 1/0 is undefined in shaders, the bits are not.
    if (kind == 3u) value = vec3(uintBitsToFloat(0x7F800000u));
  } else {
    ViewRecord view = views[0];
    Ray ray = rayThrough(view, (vec2(pixel) + 0.5) / vec2(size) * 2.0 - 1.0);
    Surface s = surfaceSeen(ray, seen.x - 1u, seen.y);
    if (kind == 0u) value = materialAt(s.instance, s.triangle, s.u, s.v).optics.base;
    if (kind == 1u) value = dot(ray.dir, s.geometric) < 0.0 ? perturbedNormal(s) : -perturbedNormal(s);
    if (kind == 2u) value = s.position;
    if (kind == 3u) value = vec3(dot(s.position - view.eye, view.forward));
    if (kind == 4u) value = vec3(float(seen.x));
  }
  imageStore(layer_image, pixel, vec4(value, 1.0));
}
