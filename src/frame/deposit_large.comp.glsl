// What the passes before leave: large cells and quarters, and those on several pictures. Many threads share each.
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#extension GL_EXT_control_flow_attributes : require
#include "frame/deposit_quarters.glsl"

layout(local_size_x = 64) in;

/// Where large cells lie thicker than so many layers over the picture, some count by chance for all. They come from
/// light that curved or bumpy glass scatters, and none of them is seen by itself. Means are kept, and so is the time,
/// however far light is spread.
const float kMostLayers = 64.0;
/// Cells of no more texels always count.
const float kCertainTexels = 256.0;

/// @param texels  of the cell  @param count  of large cells
float chanceToCount(float texels, uint count) {
  float fair = kMostLayers * float(push.width) * float(push.height) / float(count);
  return min(max(fair, kCertainTexels) / texels, 1.0);
}

/// In [0, 1), by where a cell lies: another one for each sample, for its photons are elsewhere.
float chanceOf(vec3 place, uint salt) {
  uvec3 bits = floatBitsToUint(place);
  return float(mixBits(mixBits(mixBits(bits.x ^ salt) ^ bits.y) ^ bits.z) >> 8) * (1.0 / 16777216.0);
}

/// A cell on all pictures that show some of it or, if they share surfaces, on the one that its surface faces: each
/// thread some of its rows.
/// @param lane  of `lanes` threads
/// @param count  of large cells
void addByRows(vec3 places[4], Light light, uint salt, uint lane, uint lanes, uint count) {
  uint faced = kViewsShare ? viewFaced(places, light.direction) : kViewCount;
  if (kViewsShare && faced == kViewCount && lane == 0u) addToLost(light, salt);
  for (uint v = kViewsShare ? faced : 0u; v < (kViewsShare ? min(faced + 1u, kViewCount) : kViewCount); ++v) {
    CellOnPicture shown = cellOnPicture(places, v);
    if (!mayBeSeen(shown)) continue;
    Coverage k = coverageOf(shown);
    float chance = chanceToCount(countTexels(k), count);
    if (chanceOf(places[0], salt) >= chance) continue;
    Light all = Light(light.flux / chance, light.direction);
    Span span = spanOf(shown, places, v);
    for (float y = k.first.y + float(lane); y < k.end.y; y += float(lanes)) {
      vec2 row = rowOf(k, y);
      for (float x = row.x; x < row.y; x += 1.0)
        addShare(k, vec2(x, y), v, span, all, salt);
    }
  }
}

/// Threads for each: next to each other in the order in which devices let threads go in step.
const uint kThreadsEach = 16u;

void main() {
  uint threads = gl_NumWorkGroups.x * gl_WorkGroupSize.x, count = min(large_count, cellCount());
  for (uint i = gl_GlobalInvocationID.x; i < kThreadsEach * count; i += threads) {
    uint item = listed[cellCount() + i / kThreadsEach];
    uint number = item & ((1u << kPartShift) - 1u), part = item >> kPartShift;
    ivec2 first = firstOf(number);
    Cell cell = fetchCell(first, 1);
    bool is_whole = part == kWholePart;
    Piece piece = quarterOf(first, cell, is_whole ? 0u : part);
    if (is_whole) {
      piece.places = cell.places;
      piece.light = lightOf(cell);
    }
    addByRows(piece.places, piece.light, 4u * number + (is_whole ? 0u : part), i % kThreadsEach, kThreadsEach, count);
  }
}
