// What panes take from the light of what is seen through them; multiplied into the target, in any order.
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#include "frame/passable.glsl"
#include "frame/passable_push.glsl"

layout(scalar, set = 0, binding = 7) readonly buffer Views { ViewRecord views[]; };
layout(location = 0) flat in uint instance_index;
layout(location = 0) out vec4 tint;

void main() {
  Ray ray = rayThroughPixel(views[0]);
  Surface s = surfaceSeen(ray, instance_index, gl_PrimitiveID);
  MaterialPoint m = materialAt(s.instance, s.triangle, s.u, s.v);
  s.shading = perturbedNormal(s);
  Passage passage = passageAt(s, m, ray.dir, uvec2(gl_FragCoord.xy), frame);
  if (passage.shown) discard;
  tint = vec4(passage.tint, 1.0);
}
