// Pieces that the passes before leave, a few threads each. What of them falls on texels of levels that show several
// surfaces is left to deposit_mixed.comp.glsl.
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#extension GL_EXT_control_flow_attributes : require
#include "frame/deposit_pieces.glsl"

layout(local_size_x = 64) in;

/// In one loop, so that threads that go in step do not wait for each other's rows.
void addAtLevel(Deposited d, uint lane, uint lanes) {
  float y = d.coverage.first.y + float(lane);
  vec2 row = rowOf(d.coverage, y);
  bool meets_mixed = false;
  while (y < d.coverage.end.y) {
    vec2 at = vec2(row.x, y);
    float share = row.x < row.y ? shareIn(d.coverage, at) : 0.0;
    ivec2 node = ivec2(d.coverage.origin + at);
    if (share > 0.0 && !addToNode(node, d.level, d, d.light, share)) meets_mixed = true;
    row.x += 1.0;
    if (row.x < row.y) continue;
    y += float(lanes);
    row = rowOf(d.coverage, y);
  }
  if (kAtLevels && meets_mixed) atomicOr(listed[d.place], kMeetsMixed);
}

/// Threads for each that is deposited texel by texel, or at its level: next to each other in the order in which devices
/// let threads go in step.
const uint kThreadsEach = 16u;
const uint kThreadsEachAtLevels = 2u;

void main() {
  uint threads = gl_NumWorkGroups.x * gl_WorkGroupSize.x, count = min(lists.large_count, cellCount());
  uint each = kAtLevels ? kThreadsEachAtLevels : kThreadsEach;
  for (uint i = gl_GlobalInvocationID.x; i < each * count; i += threads) {
    uint place = cellCount() + i / each;
    addPiece(fetchPiece(listed[place]), place, i % each, each);
  }
  addLostByThread();
}
