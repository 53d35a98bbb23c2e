// As visibility.frag, of surfaces that may be passed straight through: shows them where they do not let pass.
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#include "frame/passable.glsl"
#include "frame/passable_push.glsl"

layout(scalar, set = 0, binding = 7) readonly buffer Views { ViewRecord views[]; };
layout(location = 0) flat in uint instance_index;
layout(location = 0) out uvec2 seen;

void main() {
  Ray ray = rayThroughPixel(views[0]);
  Surface s = surfaceSeen(ray, instance_index, gl_PrimitiveID);
  MaterialPoint m = materialAt(s.instance, s.triangle, s.u, s.v);
  s.shading = perturbedNormal(s);
  // For the layers of geometry a pane is a surface like others, and what is half there is there.
  bool shown = geometry_only != 0u ? m.coverage >= 0.5 : passageAt(s, m, ray.dir, uvec2(gl_FragCoord.xy), frame).shown;
  if (!shown) discard;
  seen = uvec2(instance_index + 1u, gl_PrimitiveID);
}
