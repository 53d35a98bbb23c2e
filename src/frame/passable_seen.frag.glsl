// As visibility.frag, of surfaces that may be passed straight through: shows them where they do not let pass.
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#include "frame/passable_fragment.glsl"

layout(location = 0) out uvec2 seen;

void main() {
  Fragment f = makeFragment();
  // For the layers of geometry a pane is a surface like others, and what is half there is there.
  bool shown = geometry_only != 0u ? f.material.coverage >= 0.5 : passageOf(f).shown;
  if (!shown) discard;
  seen = uvec2(instance_index + 1u, gl_PrimitiveID);
}
