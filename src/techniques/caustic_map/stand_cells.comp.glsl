// Tells of each cell of an emission grid whether its light meets something that bends it.
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#include "frame/tables.glsl"
#include "techniques/caustic_map/transport.shared.h"
#define NEPHROID_STANDINGS_BINDING 8
#include "techniques/caustic_map/standings.glsl"

layout(push_constant, scalar) uniform Push { TransportPush push; };
layout(set = 0, binding = 7) uniform usampler2DArray first_seen;
layout(local_size_x = 8, local_size_y = 8) in;
#include "techniques/caustic_map/first_met.glsl"

void main() {
  uvec2 cell = gl_GlobalInvocationID.xy;
  if (cell.x >= push.grid || cell.y >= push.grid) return;
  uint seen = firstSeen(filmOf(cell)).x;
  bool goes_on = false;
  if (seen != 0u) goes_on = !isBlocker(seen - 1u);
  standings[cell.y * push.grid + cell.x] = goes_on ? waitsFor(0u, false) : kIsDone;
}
