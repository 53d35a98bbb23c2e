// Cells between four photons that took the same way. Large ones, and those at the edges of what glass and mirrors do, are
// listed for deposit_rest.comp.glsl, so that threads that go in step do not all wait for a few.
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#extension GL_EXT_control_flow_attributes : require
#include "frame/deposit.glsl"

layout(local_size_x = 8, local_size_y = 8) in;

void main() {
  ivec2 first = ivec2(gl_GlobalInvocationID.xy) - 1;
  if (first.x >= int(push.grid_width) || first.y >= int(push.grid_height)) return;
  Cell cell = fetchCell(first);
  uint number = gl_GlobalInvocationID.y * cellsAcross() + gl_GlobalInvocationID.x;
  bool is_whole = kMakesQuads && cell.is_whole;
  Light light = lightOf(cell);
  uint faced = kViewsShare && is_whole ? viewFaced(cell.places, light.direction) : kViewCount;
  if (kViewsShare && is_whole && faced == kViewCount) addToLost(light, number);
  // Nearly always one picture shows all of it.
  uint view = kViewCount;
  bool crosses = false;
  CellOnPicture shown;
  if (faced < kViewCount) {
    shown = cellOnPicture(cell.places, faced);
    if (mayBeSeen(shown)) view = faced;
  }
  [[unroll]] for (uint v = 0u; v < (kViewsShare ? 0u : kViewCount); ++v) {
    CellOnPicture here = cellOnPicture(cell.places, v);
    if (!mayBeSeen(here)) continue;
    crosses = crosses || view != kViewCount;
    view = v;
    shown = here;
  }
  bool is_seen = is_whole && view != kViewCount;
  Coverage coverage = coverageOf(shown);
  bool is_small = is_seen && !crosses && countTexels(coverage) <= kLargeBox;
  if (cell.valid != 0u && !is_small && (is_seen || !is_whole))
    rest[atomicAdd(rest_count, 1u)] = number;
  if (!is_small) return;
  Span span = spanOf(shown, cell.places, view);
  // One loop, so that threads that go in step do not wait for each other's rows.
  vec2 at = coverage.first;
  while (at.y < coverage.end.y) {
    addShare(coverage, at, view, span, light, number);
    at.x += 1.0;
    if (at.x >= coverage.end.x) at = vec2(coverage.first.x, at.y + 1.0);
  }
}
