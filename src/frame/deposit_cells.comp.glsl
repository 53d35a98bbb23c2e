// Cells between four photons that took the same way, and squares of them that do for one. Large ones are left to
// deposit_large.comp.glsl, so that threads that go in step do not all wait for a few.
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#extension GL_EXT_control_flow_attributes : require
#include "frame/deposit.glsl"

layout(local_size_x = 64) in;

/// The flux of all cells of a square, by photons at its corners, sides and middle: along each side what the trapezoidal
/// rule over four cells says of a cubic polynomial.
vec3 fluxOfSquare(ivec2 first) {
  int half_side = int(kDepositSquare) / 2;
  vec3 sum = vec3(0.0);
  for (int i = 0; i < 9; ++i) {
    ivec2 step = ivec2(i % 3, i / 3);
    float weight = (step.x == 1 ? 10.0 : 3.0) * (step.y == 1 ? 10.0 : 3.0);
    sum += weight * uintBitsToFloat(texelFetch(photon_texels, int(4u * indexOf(first + half_side * step) + 2u)).xyz);
  }
  return sum * float(kDepositSquare * kDepositSquare) / 256.0;
}

void depositItem(uint item) {
  bool is_square = (item & kIsSquare) != 0u;
  uint number = item & ~kIsSquare;
  ivec2 first = firstOf(number);
  Cell cell = fetchCell(first, is_square ? int(kDepositSquare) : 1);
  Light light = lightOf(cell);
  if (is_square) light.flux = fluxOfSquare(first);
  uint faced = kViewsShare ? viewFaced(cell.places, light.direction) : kViewCount;
  if (kViewsShare && faced == kViewCount) addToLost(light, saltOf(number, kWholePart));
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
  if (view == kViewCount) return;
  Coverage coverage = coverageOf(shown);
  // A square never lies on several pictures, or only with a texel or two.
  bool is_large = crosses || texelsOfBox(shown) > kLargeBox;
  if (!is_square && is_large && leave(number, kWholePart, countTexels(coverage))) return;
  Span span = spanOf(shown, cell.places, view);
  // One loop, so that threads that go in step do not wait for each other's rows.
  addRows(coverage, view, span, light, saltOf(number, kWholePart));
}

void main() {
  uint threads = gl_NumWorkGroups.x * gl_WorkGroupSize.x, count = lists.whole_count;
  for (uint i = gl_GlobalInvocationID.x; i < count; i += threads) depositItem(listed[i]);
  addLostByThread();
}
