#version 460
#extension GL_EXT_scalar_block_layout : require
// Doubles every word: the smallest thing that tells whether a device computes.
layout(local_size_x = 64) in;
layout(scalar, set = 0, binding = 0) buffer Words { uint words[]; };
layout(push_constant, scalar) uniform Push { uint count; };
layout(constant_id = 0) const uint kFactor = 1u;

void main() {
  uint i = gl_GlobalInvocationID.x;
  if (i < count) words[i] *= kFactor;
}
