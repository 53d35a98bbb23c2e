// Parts of the triangles of one instance that were put off.
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#include "frame/raster.glsl"

layout(local_size_x = 64) in;

/// Parts of a triangle whose corners are not all projected.
const int kUncutParts = 64;

void addParts(uint triangle, int first_row, int row_count, int rows_each) {
  RasterPart part = RasterPart(push.instance, triangle, push.first_number + triangle, 0u);
  uint count = uint((row_count + rows_each - 1) / rows_each);
  uint counter = countOf(push.part_list, kCountPutOff);
  uint first = counts[counter] < push.part_capacity ? atomicAdd(counts[counter], count) : push.part_capacity;
  bool fits = first + count <= push.part_capacity;
  for (uint i = 0u; i < count && first + i < push.part_capacity; ++i) {
    // What does not fit leaves no holes: parts of no rows.
    part.rows = fits ? uint(first_row) + i * uint(rows_each) | uint(rows_each) << 16u : 0u;
    parts[first + i] = part;
  }
  part.rows = kAllRows;
  if (!fits) parts[push.part_capacity + atomicAdd(counts[countOf(push.part_list, kCountWholes)], 1u)] = part;
}

void main() {
  InstanceRecord instance = fetchInstance(push.instance);
  uint count = counts[countOf(push.list, kCountPutOff)];
  uint threads = gl_NumWorkGroups.x * gl_WorkGroupSize.x;
  for (uint i = gl_GlobalInvocationID.x; i < count; i += threads) {
    uint triangle = items[push.first_number + i];
    Corners corners = fetchCorners(instance, triangle);
    FilmTriangle t = projectTriangle(corners);
    ivec2 extent = t.last - t.first + 1;
    bool beyond = isBeyond(corners);
    int rows_each = beyond ? (push.size_y + kUncutParts - 1) / kUncutParts : max(kPartPixels / extent.x, 1);
    addParts(triangle, beyond ? 0 : t.first.y, beyond ? push.size_y : extent.y, rows_each);
  }
}
