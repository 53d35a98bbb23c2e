// Places and normals of the surfaces in each texel and layer of the views' pictures.
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#extension GL_EXT_control_flow_attributes : require
#include "frame/surface.glsl"

layout(local_size_x = 8, local_size_y = 8) in;
layout(scalar, set = 0, binding = 7) uniform Views { ViewRecord views[kMostViews]; };
layout(set = 0, binding = 8, rg32ui) readonly uniform uimage2DArray seen_layers;
layout(set = 0, binding = 9, rgba32f) writeonly uniform image2DArray surface_layers;
layout(set = 0, binding = 10, rgba32f) writeonly uniform image2DArray depth_layers;  // four layers to a texel

layout(push_constant, scalar) uniform Push { uint layer_count; };  // of each view

/// Chosen among all, each at a constant place: see makeUniforms.
ViewRecord viewOf(uint v) {
  ViewRecord view = views[0];
  [[unroll]] for (uint i = 1u; i < kMostViews; ++i)
    if (i == v) view = views[i];
  return view;
}

void main() {
  ivec3 texel = ivec3(gl_GlobalInvocationID);
  ivec3 size = imageSize(surface_layers);
  if (texel.x >= size.x || texel.y >= size.y) return;
  ViewRecord view = viewOf(uint(texel.z));
  Ray ray = rayThrough(view, (vec2(texel.xy) + 0.5) / vec2(size.xy) * 2.0 - 1.0);
  const float infinity = uintBitsToFloat(0x7F800000u);
  int depth_count = int(layer_count + 3u) / 4;
  vec4 depths = vec4(infinity);
  for (int i = 0; i < int(layer_count); ++i) {
    ivec3 place = ivec3(texel.xy, texel.z * int(layer_count) + i);
    uvec2 seen = imageLoad(seen_layers, place).xy;
    vec4 value = vec4(infinity);
    if (seen.x != 0u) {
      Surface s = surfaceSeen(ray, seen.x - 1u, seen.y);
      value = vec4(s.position, uintBitsToFloat(packUnitVector(s.geometric)));
    }
    imageStore(surface_layers, place, value);
    float depth = seen.x != 0u ? dot(value.xyz, view.forward) : infinity;
    depths = mix(depths, vec4(depth), equal(ivec4(i & 3), ivec4(0, 1, 2, 3)));
    if ((i & 3) == 3 || i + 1 == int(layer_count)) {
      imageStore(depth_layers, ivec3(texel.xy, texel.z * depth_count + i / 4), depths);
      depths = vec4(infinity);
    }
  }
}
