// Lists those cells of an emission grid, at every so many along both axes, that wait for a branch.
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#include "techniques/caustic_map/transport.shared.h"
#define NEPHROID_STANDINGS_BINDING 0
#include "techniques/caustic_map/standings.glsl"
#define NEPHROID_CELL_LISTS_BINDING 1
#include "techniques/caustic_map/cell_lists.glsl"

layout(push_constant, scalar) uniform Push { TransportPush push; };
layout(local_size_x = 8, local_size_y = 8) in;

void main() {
  uvec2 cell = gl_GlobalInvocationID.xy * push.spacing;
  if (cell.x >= push.grid || cell.y >= push.grid) return;
  uint index = cell.y * push.grid + cell.x;
  if (isWaitingFor(standings[index], push.branch)) addToList(push.list, push.grid * push.grid, index);
}
