// Of pieces that the pass before has found to meet texels of levels that show several surfaces: what falls on these, in
// the finer ones below them.
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#extension GL_EXT_control_flow_attributes : require
#include "frame/deposit_pieces.glsl"

layout(local_size_x = 64) in;

/// Where large cells lie thicker than so many layers over the picture, some count by chance for all where they meet
/// texels of levels that show several surfaces. Means are kept, and so is the time, however broken a picture is.
const float kMostLayers = 64.0;

/// In [0, 1), by where a cell lies: another one for each sample, for its photons are elsewhere.
float chanceOf(vec3 place, uint salt) {
  uvec3 bits = floatBitsToUint(place);
  return float(mixBits(mixBits(mixBits(bits.x ^ salt) ^ bits.y) ^ bits.z) >> 8) * (1.0 / 16777216.0);
}

/// Share of the cell's flux in a texel of the level that is so many below the cell's.
/// @param at  its corner, in texels of that level, from the coverage's origin on
float shareBelow(Coverage k, vec2 at, uint below) {
  float scale = float(1u << below);
  k.ab.a *= scale, k.ab.b *= scale;
  k.bc.a *= scale, k.bc.b *= scale;
  k.ca.a *= scale, k.ca.b *= scale;
  k.cd.a *= scale, k.cd.b *= scale;
  k.da.a *= scale, k.da.b *= scale;
  k.point_1 *= scale;
  k.point_2 *= scale;
  // Of areas that much larger.
  k.share_1 /= scale * scale;
  k.share_2 /= scale * scale;
  return shareIn(k, at);
}

/// Places along x of those in a square that are numbered in the order of a quadtree.
uint everyOther(uint number) {
  uint x = number & 0x5555u;
  x = (x | x >> 1) & 0x3333u;
  x = (x | x >> 2) & 0x0F0Fu;
  return (x | x >> 4) & 0x00FFu;
}

/// What lies below a texel of the piece's level, depth first, down to texels that show one surface.
/// @param at  its corner, from the coverage's origin on
void addBelow(Deposited d, vec2 at) {
  uint below = 1u, number = 0u;
  do {
    vec2 corner = at * float(1u << below) + vec2(everyOther(number), everyOther(number >> 1));
    float share = shareBelow(d.coverage, corner, below);
    ivec2 node = ivec2(d.coverage.origin) * (1 << below) + ivec2(corner);
    bool is_done = share <= 0.0;
    if (!is_done) is_done = addToNode(node, d.level - below, d, d.light, share);
    if (!is_done) {
      ++below;
      number <<= 2u;
      continue;
    }
    while (below > 0u && (number & 3u) == 3u) {
      number >>= 2u;
      --below;
    }
    ++number;
  } while (below > 0u);
}

/// Whether the pass before has left a texel of the piece's level to this one.
bool isMixed(Deposited d, ivec2 node) {
  bool is_mixed;
  litLayerOf(node, d, d.level, levelOriginOf(d.level), is_mixed);
  return is_mixed;
}

void addAtLevel(Deposited d, uint lane, uint lanes) {
  float layers = float(lists.large_parts) / float(kLayerParts), chance = min(kMostLayers / layers, 1.0);
  if (d.level == 0u || chanceOf(d.span.first + d.span.third, d.salt) >= chance) return;
  d.light.flux /= chance;
  float y = d.coverage.first.y + float(lane);
  vec2 row = rowOf(d.coverage, y) - vec2(1.0, 0.0);
  bool goes_on = true;
  do {
    // To the next one, so that threads that go in step wait for each other where most of the work is.
    bool is_mixed = false;
    do {
      row.x += 1.0;
      if (row.x >= row.y) {
        y += float(lanes);
        row = rowOf(d.coverage, y);
      }
      goes_on = y < d.coverage.end.y;
      if (goes_on && row.x < row.y) is_mixed = isMixed(d, ivec2(d.coverage.origin + vec2(row.x, y)));
    } while (goes_on && !is_mixed);
    if (is_mixed) addBelow(d, vec2(row.x, y));
  } while (goes_on);
}

void main() {
  uint threads = gl_NumWorkGroups.x * gl_WorkGroupSize.x, count = min(lists.large_count, cellCount());
  for (uint i = gl_GlobalInvocationID.x; i < count; i += threads) {
    uint place = cellCount() + i, item = listed[place];
    if ((item & kMeetsMixed) != 0u) addPiece(fetchPiece(item), place, 0u, 1u);
  }
  addLostByThread();
}
