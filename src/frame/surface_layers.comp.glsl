// Places and normals of the surfaces in each texel and layer of the views' pictures.
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#include "frame/surface.glsl"

layout(local_size_x = 8, local_size_y = 8) in;
layout(scalar, set = 0, binding = 7) readonly buffer Views { ViewRecord views[]; };
layout(set = 0, binding = 8) uniform usampler2DArray seen_layers;
layout(set = 0, binding = 9, rgba32f) writeonly uniform image2DArray surface_layers;

layout(push_constant, scalar) uniform Push { uint layer_count; };  // of each view

void main() {
  ivec3 texel = ivec3(gl_GlobalInvocationID);
  ivec3 size = imageSize(surface_layers);
  if (texel.x >= size.x || texel.y >= size.y) return;
  uvec2 seen = texelFetch(seen_layers, texel, 0).xy;
  vec4 value = vec4(uintBitsToFloat(0x7F800000u));  // infinitely far away
  if (seen.x != 0u) {
    Ray ray = rayThrough(views[uint(texel.z) / layer_count], (vec2(texel.xy) + 0.5) / vec2(size.xy) * 2.0 - 1.0);
    Surface s = surfaceSeen(ray, seen.x - 1u, seen.y);
    value = vec4(s.position, uintBitsToFloat(packUnitVector(s.geometric)));
  }
  imageStore(surface_layers, texel, value);
}
