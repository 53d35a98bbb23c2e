// Which cells of a grid of photons are whole: one thread a square of them.
//
// A square whose photons were interpolated, and that covers next to nothing of the picture, is deposited as one cell:
// at a focus many cells fall on each texel.
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#extension GL_EXT_control_flow_attributes : require
#include "frame/deposit.glsl"

layout(local_size_x = 8, local_size_y = 8) in;

const int kSide = int(kDepositSquare);
/// Texels that a square may span, and by how many its middle may lie beside that of its corners.
const float kMostSpan = 2.0;
const float kMostSag = 0.25;

vec3 placeOf(ivec2 at) { return uintBitsToFloat(texelFetch(photon_texels, int(4u * indexOf(at))).xyz); }

/// Whether a square spans few texels on a view's picture, and lies on it like a cell.
bool isSmallOn(uint view, vec3 places[4], vec3 middle) {
  CellOnPicture shown = cellOnPicture(places, view);
  vec2 corners = 0.25 * (shown.corners[0] + shown.corners[1] + shown.corners[2] + shown.corners[3]);
  vec2 span = shown.upper - shown.lower;
  return shown.least_w > 1e-6 * shown.most_w && max(span.x, span.y) <= kMostSpan &&
         distance(onView(middle, view).texels, corners) <= kMostSag;
}

/// Views that share surfaces have one scale.
bool isSmallInSpace(vec3 places[4], vec3 middle) {
  vec3 lower = min(min(places[0], places[1]), min(places[2], places[3])),
       upper = max(max(places[0], places[1]), max(places[2], places[3])), span = upper - lower;
  vec3 corners = 0.25 * (places[0] + places[1] + places[2] + places[3]);
  return max(span.x, max(span.y, span.z)) * push.texels_per_metre <= kMostSpan &&
         distance(middle, corners) * push.texels_per_metre <= kMostSag;
}

bool isOneCell(ivec2 first) {
  bool has_square = kMakesQuads && push.squares_across > 0u && min(first.x, first.y) >= 0;
  if (!has_square || squares[uint(first.y / kSide) * push.squares_across + uint(first.x / kSide)] == 0u) return false;
  vec3 places[4];
  for (uint k = 0u; k < 4u; ++k) places[k] = placeOf(first + kSide * kCorners[k]);
  vec3 middle = placeOf(first + kSide / 2);
  if (kViewsShare) return isSmallInSpace(places, middle);
  bool is_small = true;
  for (uint v = 0u; v < kViewCount; ++v) is_small = is_small && isSmallOn(v, places, middle);
  return is_small;
}

/// What of a photon says whether cells beside it are whole.
struct Told {
  bool is_valid;
  uint chain;
  vec3 direction;
};

/// A row of photons that bound the cells of a square.
struct ToldRow {
  Told told[kSide + 1];
};

ToldRow fetchTold(ivec2 first) {
  ToldRow row;
  [[unroll]] for (int x = 0; x <= kSide; ++x) {
    ivec2 at = first + ivec2(x, 0);
    bool is_photon = isPhoton(at);
    int i = int(4u * (is_photon ? indexOf(at) : 0u));
    uvec4 along = texelFetch(photon_texels, i + 1);
    row.told[x] = Told(is_photon && (along.w & kPhotonValid) != 0u, texelFetch(photon_texels, i + 3).x,
                       uintBitsToFloat(along.xyz));
  }
  return row;
}

bool isWhole(Told a, Told b, Told c, Told d) {
  bool same = a.is_valid && b.is_valid && c.is_valid && d.is_valid && a.chain == b.chain && a.chain == c.chain &&
              a.chain == d.chain;
  vec3 mean = normalize(a.direction + b.direction + c.direction + d.direction);
  return same && min(min(dot(a.direction, mean), dot(b.direction, mean)),
                     min(dot(c.direction, mean), dot(d.direction, mean))) >= kLeastCosine;
}

/// Lists the cells of a square one by one: a bit each.
void listCells(ivec2 first, uint whole) {
  uint next = whole != 0u ? atomicAdd(lists.whole_count, bitCount(whole)) : 0u;
  for (uint left = whole; left != 0u; left &= left - 1u) {
    uint k = uint(findLSB(left));
    listed[next++] = numberOf(first + ivec2(k % kDepositSquare, k / kDepositSquare));
  }
}

/// Which cells of a square are whole: a bit each.
uint wholeIn(ivec2 first) {
  uint whole = 0u;
  ToldRow above = fetchTold(first);
  for (int y = 0; y < kSide; ++y) {
    ToldRow below = fetchTold(first + ivec2(0, y + 1));
    [[unroll]] for (int x = 0; x < kSide; ++x)
      if (isWhole(above.told[x], above.told[x + 1], below.told[x + 1], below.told[x]))
        whole |= 1u << uint(y * kSide + x);
    above = below;
  }
  return kMakesQuads ? whole : 0u;
}

void main() {
  // The first row and column of cells lie before the first photons.
  ivec2 first = kSide * (ivec2(gl_GlobalInvocationID.xy) - 1);
  if (first.x >= int(push.grid_width) || first.y >= int(push.grid_height)) return;
  uint place = placeOfSquare(gl_GlobalInvocationID.xy);
  if (isOneCell(first)) {
    listed[place] = (1u << kDepositSquare * kDepositSquare) - 1u;
    listed[atomicAdd(lists.whole_count, 1u)] = numberOf(first) | kIsSquare;
    return;
  }
  uint whole = wholeIn(first);
  listed[place] = whole;
  listCells(first, whole);
}
