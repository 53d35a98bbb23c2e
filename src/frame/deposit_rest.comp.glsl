// What deposit_cells.comp.glsl leaves: large cells, cells on several pictures, quarters of cells beside which there is no
// photon that took the same way, and splats.
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#extension GL_EXT_control_flow_attributes : require
#include "frame/deposit.glsl"

layout(local_size_x = 64) in;

/// A Gaussian over the texels about a place that show its surface, which together get all of it; nothing if the texel
/// that it lies in shows another.
void splat(vec3 place, Light light, uint salt) {
  vec2 size = vec2(push.width, push.height);
  uint faced = kViewsShare ? searchViewFaced(place, light.direction) : kViewCount;
  if (kViewsShare && faced == kViewCount) addToLost(light, salt);
  for (uint v = kViewsShare ? faced : 0u; v < (kViewsShare ? min(faced + 1u, kViewCount) : kViewCount); ++v) {
    OnPicture on = onView(place, v);
    if (!isOnPicture(on, size)) continue;
    float reach = texelSize(on.w, size) * (1.0 + push.splat_radius);
    ivec2 first = ivec2(max(floor(on.texels - push.splat_radius), vec2(0.0)));
    ivec2 last = ivec2(min(floor(on.texels + push.splat_radius), size - 1.0));
    Span span = Span(place, place, reach, kViewsShare ? forwardOf(v) : vec3(0.0));
    if (litLayer(ivec2(on.texels), v, span, light.direction) == kFluxLayers) {
      // Beside an edge others must not get what it hides.
      addToLost(light, salt);
      return;
    }
    float inverse = 2.0 / (push.splat_radius * push.splat_radius);
    float sum = 0.0;
    for (uint round = 0u; round < 2u; ++round)
      for (int y = first.y; y <= last.y; ++y)
        for (int x = first.x; x <= last.x; ++x) {
          uint layer = litLayer(ivec2(x, y), v, span, light.direction);
          vec2 off = vec2(x, y) + 0.5 - on.texels;
          float weight = exp(-dot(off, off) * inverse);
          if (layer == kFluxLayers) continue;
          if (round == 0u) sum += weight;
          else addToTexel(ivec2(x, y), v * kFluxLayers + layer, light, weight / sum, salt, true);
        }
  }
}

/// Half the way to where the next photon ends in a direction of the grid: of that photon or, mirrored, of the one on the
/// other side, if either took the same way. @return  false if neither did
bool halfStep(ivec2 at, Photon own, ivec2 towards, out vec3 half_step) {
  bool found = false;
  for (int sign = 1; sign >= -1; sign -= 2) {
    ivec2 next = at + sign * towards;
    if (found || !isPhoton(next)) continue;
    Photon other = fetchPhoton(indexOf(next));
    if ((other.light_band_flags & kPhotonValid) == 0u || other.chain != own.chain) continue;
    if (dot(other.direction, own.direction) < kLeastCosine) continue;
    half_step = 0.5 * float(sign) * (other.position - own.position);
    found = true;
  }
  return found;
}

/// Where a row of texels meets an edge: least and most x.
vec2 spanInRow(vec2 span, Edge e, float y) {
  float lower = max(min(e.a.y, e.b.y), y), upper = min(max(e.a.y, e.b.y), y + 1.0);
  if (lower > upper) return span;
  float x_0 = e.a.x + (lower - e.a.y) * e.slope, x_1 = e.a.x + (upper - e.a.y) * e.slope;
  if (e.a.y == e.b.y) {
    x_0 = e.a.x;
    x_1 = e.b.x;
  }
  return vec2(min(span.x, min(x_0, x_1)), max(span.y, max(x_0, x_1)));
}

/// A cell on all pictures that show some of it or, if they share surfaces, on the one that its surface faces: each thread
/// some of its rows.
/// @param lane  of `lanes` threads
void addByRows(vec3 places[4], Light light, uint salt, uint lane, uint lanes) {
  uint faced = kViewsShare ? viewFaced(places, light.direction) : kViewCount;
  if (kViewsShare && faced == kViewCount && lane == 0u) addToLost(light, salt);
  for (uint v = kViewsShare ? faced : 0u; v < (kViewsShare ? min(faced + 1u, kViewCount) : kViewCount); ++v) {
    CellOnPicture shown = cellOnPicture(places, v);
    if (!mayBeSeen(shown)) continue;
    Coverage k = coverageOf(shown);
    Span span = spanOf(shown, places, v);
    for (float y = k.first.y + float(lane); y < k.end.y; y += float(lanes)) {
      vec2 in_row = spanInRow(spanInRow(vec2(1e30, -1e30), k.ab, y), k.bc, y);
      in_row = spanInRow(spanInRow(in_row, k.cd, y), k.da, y);
      float end = min(k.end.x, in_row.y + 1.0);
      for (float x = max(k.first.x, floor(in_row.x)); x < end; x += 1.0)
        addShare(k, vec2(x, y), v, span, light, salt);
    }
  }
}

/// What a thread adds to: some rows of a cell.
struct Piece {
  vec3 places[4];
  Light light;
  uint salt;
  uint lane;  // of `lanes` threads
  uint lanes;
  bool is_cell;   // else
  bool is_splat;  // or nothing
};

/// A quarter of a corner's flux, on the side of its cell where it has no neighbours all around: over what its cell would
/// cover there if the light went on as on the other side.
Piece quarterOf(ivec2 first, Cell cell, uint corner) {
  Piece piece;
  ivec2 at = first + kCorners[corner], side = kCorners[corner ^ 2u] - kCorners[corner];
  // Each photon is the third corner of one cell.
  bool is_valid = (cell.valid & (1u << corner)) != 0u && (kMakesQuads || corner == 2u);
  Photon own = fetchPhoton(is_valid ? indexOf(at) : 0u);
  piece.light = Light(kMakesQuads ? 0.25 * own.flux : own.flux, own.direction);
  vec3 across = vec3(0.0), down = vec3(0.0);
  bool goes_across = halfStep(at, own, ivec2(side.x, 0), across), goes_down = halfStep(at, own, ivec2(0, side.y), down);
  // With neighbours along one direction of the grid alone it is as long across them.
  if (goes_across && !goes_down) down = cross(own.direction, across);
  if (goes_down && !goes_across) across = cross(own.direction, down);
  piece.is_cell = is_valid && kMakesQuads && (goes_across || goes_down);
  piece.is_splat = is_valid && !piece.is_cell;
  piece.places = vec3[4](own.position, own.position + across, own.position + across + down, own.position + down);
  return piece;
}

/// Threads for each cell: next to each other in the order in which devices let threads go in step.
const uint kThreadsEach = 16u;

Piece pieceOf(uint number, uint lane) {
  ivec2 first = ivec2(number % cellsAcross(), number / cellsAcross()) - 1;
  Cell cell = fetchCell(first);
  bool is_whole = kMakesQuads && cell.is_whole;
  uint lanes = is_whole ? kThreadsEach : kThreadsEach / 4u, corner = is_whole ? 0u : lane / lanes;
  Piece piece = quarterOf(first, cell, corner);
  if (is_whole) {
    piece.places = cell.places;
    piece.light = lightOf(cell);
    piece.is_cell = true;
    piece.is_splat = false;
  }
  piece.salt = 4u * number + corner;
  piece.lanes = lanes;
  piece.lane = lane % lanes;
  return piece;
}

void main() {
  uint threads = gl_NumWorkGroups.x * gl_WorkGroupSize.x;
  for (uint i = gl_GlobalInvocationID.x; i < kThreadsEach * rest_count; i += threads) {
    Piece piece = pieceOf(rest[i / kThreadsEach], i % kThreadsEach);
    if (piece.is_cell) addByRows(piece.places, piece.light, piece.salt, piece.lane, piece.lanes);
    if (piece.is_splat && piece.lane == 0u) splat(piece.places[0], piece.light, piece.salt);
  }
}
