// As visibility.frag and peel.frag, but only what faces a parallel view: of closed meshes the outward side, of others
// both.
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#include "frame/receiver_map.shared.h"
#include "frame/surface.glsl"

layout(scalar, set = 0, binding = 7) readonly buffer Views { ViewRecord views[]; };
layout(set = 0, binding = 8) uniform sampler2D depth_before;
layout(location = 0) flat in uint instance_index;
layout(location = 0) out uvec2 seen;

layout(constant_id = 8) const bool kPeels = false;

layout(push_constant, scalar) uniform Push { uint drawn_view; };

void main() {
  // Depths are reversed: what is farther has less.
  if (kPeels && gl_FragCoord.z >= texelFetch(depth_before, ivec2(gl_FragCoord.xy), 0).x) discard;
  InstanceRecord instance = fetchInstance(instance_index);
  vec3 normal = areaNormal(instance, toWorld(instance, fetchTriangle(instance.first_triangle + gl_PrimitiveID)));
  float facing = -dot(normal, views[drawn_view].forward);
  if ((instance.flags & kInstanceClosed) == 0u) facing = abs(facing);
  if (facing < kLeastFacing * length(normal)) discard;
  seen = uvec2(instance_index + 1u, gl_PrimitiveID);
}
