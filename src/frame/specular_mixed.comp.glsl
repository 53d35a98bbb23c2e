// Lists those pixels of cells which show several things that show something specular: they are followed themselves.
//
// The order of the list differs between runs, what becomes of a pixel does not.
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#include "frame/specular_push.glsl"
#define NEPHROID_GRID_BINDINGS 7
#include "frame/specular_grid.glsl"

layout(local_size_x = 64) in;

/// Which of a cell's pixels have a lobe of class S, a bit each in the order of nextPixel.
uint findSpecular(Cell cell) {
  uvec2 pixel = cell.first;
  uint found = 0u, bit = 1u;
  do {
    uint seen = imageLoad(seen_image, ivec2(pixel)).x;
    if (seen != 0u && isSpecular(max(seen, 1u) - 1u)) found |= bit;
    bit <<= 1;
  } while (nextPixel(cell, pixel));
  return found;
}

/// One behind the other: threads that go in step find the same things there.
void listPixels(Cell cell, uint wanted) {
  uint next = extend(kFollowedPixels, uint(bitCount(wanted)));
  uvec2 pixel = cell.first;
  do {
    if ((wanted & 1u) != 0u) listed[next++] = packPlace(pixel);
    wanted >>= 1;
    nextPixel(cell, pixel);
  } while (wanted != 0u);
}

void main() {
  uint first = firstOf(kMixedCells), count = heads[kMixedCells].count, i = firstListed();
  if (i >= count) return;
  do {
    Cell cell = cellAt(unpackPlace(listed[first + i]));
    uint found = findSpecular(cell);
    if (found != 0u) listPixels(cell, found);
    i += listedThreads();
  } while (i < count);
}
