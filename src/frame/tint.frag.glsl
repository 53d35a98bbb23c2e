// What panes take from the light of what is seen through them; multiplied into the target, in any order.
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#include "frame/passable_fragment.glsl"

layout(location = 0) out vec4 tint;

void main() {
  Passage passage = passageOf(makeFragment());
  if (passage.shown) discard;
  tint = vec4(passage.tint, 1.0);
}
