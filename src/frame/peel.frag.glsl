// As visibility.frag, of what lies behind what was seen before.
#version 460
layout(set = 0, binding = 8) uniform sampler2D depth_before;
layout(location = 0) flat in uint instance_index;
layout(location = 0) out uvec2 seen;

void main() {
  // Depths are reversed: what is farther has less.
  if (gl_FragCoord.z >= texelFetch(depth_before, ivec2(gl_FragCoord.xy), 0).x) discard;
  seen = uvec2(instance_index + 1u, gl_PrimitiveID);
}
