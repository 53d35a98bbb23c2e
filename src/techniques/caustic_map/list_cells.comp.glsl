// Lists the cells of an emission grid whose light meets something that bends it, for the first branch.
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#include "frame/tables.glsl"
#define NEPHROID_CELL_LISTS_BINDING 8
#include "techniques/caustic_map/cell_lists.glsl"

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
  if (goes_on) addToList(0u, push.grid * push.grid, cell.y * push.grid + cell.x);
}
