// Sorts the cells of the grid by what they show: of a cell that shows one specular thing all over the chains are followed
// at its corners; one that shows several things is left to specular_mixed.comp.glsl.
//
// The order of lists differs between runs, what becomes of a pixel does not.
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#include "frame/specular_push.glsl"
#define NEPHROID_GRID_BINDINGS 7
#include "frame/specular_grid.glsl"

layout(local_size_x = 8, local_size_y = 8) in;

/// Do all pixels of a cell and its corners show one instance?
bool showsOne(Cell cell, uint first) {
  bool one = true;
  for (uint y = 0u; y <= kSpacing; ++y)
    for (uint x = 0u; x <= kSpacing; ++x)
      one = one && imageLoad(seen_image, ivec2(min(cell.first + uvec2(x, y), cell.last))).x == first;
  return one;
}

void main() {
  uvec2 point = gl_GlobalInvocationID.xy, points = pointCount();
  if (any(greaterThanEqual(point, points))) return;
  Cell cell = cellAt(point);
  // A point's own pixel is the first of its cell, also of one without pixels.
  uint first = imageLoad(seen_image, ivec2(cell.first)).x;
  bool is_specular = first != 0u && isSpecular(max(first, 1u) - 1u);
  if (is_specular) listed[extend(kPoints, 1u)] = packPlace(point);
  // Beyond the picture's edges nothing is left.
  if (any(greaterThanEqual(point + 1u, points)) || any(greaterThanEqual(cell.first, cell.last))) return;
  bool is_one = showsOne(cell, first);
  if (is_one && is_specular) listed[extend(kCells, 1u)] = packPlace(point);
  if (!is_one) listed[extend(kMixedCells, 1u)] = packPlace(point);
}
