// Photons of a grid into a picture of flux: what the passes over its cells share.
//
// A cell between four photons is two triangles of half the flux each, and each texel gets the share of a triangle's area
// that lies in it, exactly: so neighbours that fill a plane evenly give an even picture, folded cells count on both sides
// of the fold, and no flux falls between texels however small a cell becomes. ([shah-caustics-mapping] §III-B splats
// points; §III-F.)
#ifndef NEPHROID_DEPOSIT_GLSL
#define NEPHROID_DEPOSIT_GLSL

#define NEPHROID_PHOTON_BINDING 0
#include "frame/fetch_photon.glsl"
#include "frame/deposit.shared.h"
#include "frame/frame.shared.h"
#include "frame/receiver_map.shared.h"

layout(scalar, set = 0, binding = 1) uniform Views { ViewRecord views[kMostViews]; };
layout(constant_id = 2) const uint kViewCount = 1u;
#include "frame/texel_surface.glsl"
layout(set = 0, binding = 2, rgba32f) readonly uniform image2DArray surfaces;
layout(set = 0, binding = 3, r32i) uniform iimage2DArray flux_image;
layout(set = 0, binding = 4, r32ui) writeonly uniform uimage2DArray tile_image;
layout(scalar, set = 0, binding = 5) buffer Lost { int lost_steps[]; };
layout(scalar, set = 0, binding = 6) buffer Lists {
  DepositListsHead lists;
  /// By number, from the first place on: cells between photons that took the same way, or squares of them (kIsSquare).
  /// From place cellCount() backwards: photons beside cells that are torn. From there on: pieces that are left to the
  /// last pass. Behind these: wholeCells.
  uint listed[];
};
layout(scalar, set = 0, binding = 7) readonly buffer Squares { uint squares[]; };  // PhotonBuffer::squares

layout(constant_id = 0) const bool kMakesQuads = true;
layout(constant_id = 1) const bool kKeepsDirections = false;
/// 0: views are parts of one picture, whose first layer has flux. Else they show the same surfaces from several sides,
/// and so many layers of each have flux of their own.
layout(constant_id = 3) const uint kSharedLayers = 0u;

layout(push_constant, scalar) uniform Push { DepositPush push; };

const bool kViewsShare = kSharedLayers > 0u;
const uint kFluxLayers = kViewsShare ? kSharedLayers : 1u;
const uint kChannels = kKeepsDirections ? 2u * kFluxChannels : kFluxChannels;

/// Cells whose corners' directions differ from their mean by more than this are torn: an edge of the glass lies between.
const float kLeastCosine = 0.93;
/// Triangles smaller than this, in texels, are points: their area has no digits left.
const float kLeastArea = 1e-3;
/// Corners of a cell from its first photon on, once around.
const ivec2 kCorners[4] = ivec2[4](ivec2(0, 0), ivec2(1, 0), ivec2(1, 1), ivec2(0, 1));

float luminanceOf(vec3 rgb) { return dot(rgb, vec3(0.2126, 0.7152, 0.0722)); }

/// What is deposited.
struct Light {
  vec3 flux;       // W
  vec3 direction;  // unit, of travel
};

/// Rounds up or down by chance, so that the mean is kept where a texel gets less than a step.
int toSteps(float steps, uint random) {
  return int(floor(steps + float(random >> 8) * (1.0 / 16777216.0)));
}

/// Of a thread, until it has deposited all: a device that runs both branches for all threads would pay for every texel.
ivec3 lost_by_thread = ivec3(0);

void addLostByThread() {
  if (lost_by_thread == ivec3(0)) return;
  for (uint c = 0u; c < 3u; ++c) atomicAdd(lost_steps[c], lost_by_thread[c]);
}

/// @param picture  of flux: view · kFluxLayers + layer
/// @param salt     of what is deposited
void addToTexel(ivec2 texel, uint picture, Light light, float share, uint salt, bool is_kept) {
  uint random = mixBits(uint(texel.x) + (uint(texel.y) << 12) + salt * 0x9e3779b1u);
  vec3 steps = light.flux * (share * push.steps_per_watt);
  ivec3 whole = ivec3(toSteps(steps.x, random), toSteps(steps.y, random), toSteps(steps.z, random));
  if (!is_kept) {
    lost_by_thread += whole;
    return;
  }
  int layer = int(picture * kChannels);
  imageAtomicAdd(flux_image, ivec3(texel, layer), whole.x);
  imageAtomicAdd(flux_image, ivec3(texel, layer + 1), whole.y);
  imageAtomicAdd(flux_image, ivec3(texel, layer + 2), whole.z);
  if (kKeepsDirections) {
    vec3 along = light.direction * luminanceOf(steps);
    for (int c = 0; c < 3; ++c)
      imageAtomicAdd(flux_image, ivec3(texel, layer + 3 + c), toSteps(along[c], mixBits(random + uint(c))));
  }
  imageStore(tile_image, ivec3(texel / int(kDepositTile), picture), uvec4(1u));
}

/// Of views that share surfaces: which axis one looks against (frame/receiver_map.shared.h), and where it looks to.
uint axisOf(uint view) { return push.axes >> (4u * view) & 15u; }
vec3 forwardOf(uint view) {
  uint axis = axisOf(view);
  return vec3(equal(uvec3(axis >> 1), uvec3(0u, 1u, 2u))) * ((axis & 1u) != 0u ? 1.0 : -1.0);
}

OnPicture onView(vec3 place, uint view) {
  vec2 size = vec2(push.width, push.height);
  if (!kViewsShare) return onPicture(projectionOf(view), place, size);
  vec3 off = (place - push.centre) * push.texels_per_metre;
  return OnPicture(seenAlong(axisOf(view) >> 1, off).xy + 0.5 * size, 1.0);
}

/// @param forward  of the view, where views share surfaces
TexelSurface fetchTexel(ivec2 texel, uint view, uint layer, vec3 forward) {
  vec4 surface = imageLoad(surfaces, ivec3(texel, view * push.layer_count + layer));
  return kViewsShare ? describeTexel(surface, forward) : describeTexel(surface);
}

/// Places that something spans in a view, and how far off their planes its texels may lie.
struct Span {
  vec3 first;
  vec3 third;
  float reach;
  vec3 forward;  // of the view
};

/// Does light from a direction that falls on the places fall on the texel's surface?
bool isLit(ivec2 texel, uint view, uint layer, Span span, vec3 direction) {
  vec4 surface = imageLoad(surfaces, ivec3(texel, view * push.layer_count + layer));
  return isLitAt(surface, kViewsShare ? span.forward : views[0].forward, span.first, span.third, span.reach, direction);
}

/// The first layer of a texel that is lit; kFluxLayers: none.
uint litLayer(ivec2 texel, uint view, Span span, vec3 direction) {
  uint layer = 0u;
  bool is_lit = isLit(texel, view, 0u, span, direction);
  [[unroll]] for (uint k = 1u; k < kFluxLayers; ++k)
    if (!is_lit) {
      is_lit = isLit(texel, view, k, span, direction);
      layer = k;
    }
  return is_lit ? layer : kFluxLayers;
}

/// Of views that share surfaces the one that is faced most by the surface on which light falls at a place; kViewCount:
/// none shows it. Where surfaces meet, that of the nearest plane counts.
uint searchViewFaced(vec3 place, vec3 direction) {
  vec2 size = vec2(push.width, push.height);
  uint faced = kViewCount;
  float most = 0.0;
  for (uint v = 0u; v < kViewCount; ++v) {
    OnPicture on = onView(place, v);
    if (!isOnPicture(on, size)) continue;
    Span span = Span(place, place, texelSize(on.w, size), forwardOf(v));
    for (uint k = 0u; k < kFluxLayers; ++k) {
      TexelSurface s = fetchTexel(ivec2(on.texels), v, k, span.forward);
      float off = abs(dot(s.lit_normal, place - s.position));
      float facing = s.cos_view * (1.0 - off / span.reach);
      if (facing <= most || !isLit(ivec2(on.texels), v, k, span, direction)) continue;
      most = facing;
      faced = v;
    }
  }
  return faced;
}

/// Likewise of a cell. Nearly always it lies on a plane, which tells the view; else its first corner decides or, where
/// that is beside all texels of its surface, the opposite one.
uint viewFaced(vec3 places[4], vec3 direction) {
  vec3 normal = cross(places[2] - places[0], places[3] - places[1]);
  normal = dot(normal, direction) > 0.0 ? -normal : normal;
  vec3 along = abs(normal);
  uint axis = along.y > along.x ? 1u : 0u;
  if (along.z > max(along.x, along.y)) axis = 2u;
  bool is_negative = (axis == 0u ? normal.x : axis == 1u ? normal.y : normal.z) < 0.0;
  uint faced = push.views_by_axis >> (8u * axis + (is_negative ? 4u : 0u)) & 15u;
  bool is_known = faced != kNoView;
  faced = is_known ? faced : 0u;
  vec2 size = vec2(push.width, push.height);
  OnPicture on = onView(places[0], faced);
  Span span = Span(places[0], places[0], texelSize(on.w, size), forwardOf(faced));
  if (is_known && isOnPicture(on, size) && litLayer(ivec2(on.texels), faced, span, direction) < kFluxLayers)
    return faced;
  faced = searchViewFaced(places[0], direction);
  if (faced == kViewCount) faced = searchViewFaced(places[2], direction);
  return faced;
}

/// An edge of a polygon, from a to b, and how x changes with y along it.
struct Edge {
  vec2 a;
  vec2 b;
  float slope;
};

Edge makeEdge(vec2 a, vec2 b) {
  float dy = b.y - a.y;
  return Edge(a, b, dy != 0.0 ? (b.x - a.x) / dy : 0.0);
}

/// ∫ clamp(x, 0, 1) dy along the part of an edge with y in [0, 1], seen from a texel's corner: by Green's theorem the sum
/// over a polygon's edges is the signed area of the polygon in that texel.
float areaUnder(Edge e, vec2 corner) {
  float y0 = clamp(e.a.y - corner.y, 0.0, 1.0), y1 = clamp(e.b.y - corner.y, 0.0, 1.0);
  float ax = e.a.x - corner.x, ay = e.a.y - corner.y;
  float x0 = ax + (y0 - ay) * e.slope, x1 = ax + (y1 - ay) * e.slope;
  float c0 = clamp(x0, 0.0, 1.0), c1 = clamp(x1, 0.0, 1.0), dx = x1 - x0;
  // ∫ clamp over a stretch of x is c (x − c/2).
  float mean = abs(dx) > 4e-3 ? (c1 * (x1 - 0.5 * c1) - c0 * (x0 - 0.5 * c0)) / dx : clamp(0.5 * (x0 + x1), 0.0, 1.0);
  return mean * (y1 - y0);
}

float crossOf(vec2 a, vec2 b) { return a.x * b.y - a.y * b.x; }

/// Where a cell is on a view's picture.
struct CellOnPicture {
  vec2 corners[4];
  vec2 lower;  // of the box about it
  vec2 upper;
  float least_w;
  float most_w;
};

CellOnPicture cellOnPicture(vec3 places[4], uint view) {
  CellOnPicture cell;
  for (uint k = 0u; k < 4u; ++k) {
    OnPicture on = onView(places[k], view);
    cell.corners[k] = on.texels;
    cell.lower = k == 0u ? on.texels : min(cell.lower, on.texels);
    cell.upper = k == 0u ? on.texels : max(cell.upper, on.texels);
    cell.least_w = k == 0u ? on.w : min(cell.least_w, on.w);
    cell.most_w = k == 0u ? on.w : max(cell.most_w, on.w);
  }
  return cell;
}

/// Whether some of it may be shown.
bool mayBeSeen(CellOnPicture cell) {
  return cell.least_w > 1e-6 * cell.most_w && all(greaterThan(cell.upper, vec2(0.0))) &&
         all(lessThan(cell.lower, vec2(push.width, push.height)));
}

/// Boxes of more texels are left to the second pass, where many threads share a cell. What of them lies beside the
/// picture counts too, so that cells across its border are deposited as their neighbours are.
const float kLargeBox = 100.0;
float texelsOfBox(CellOnPicture cell) {
  vec2 size = cell.upper - cell.lower + 1.0;
  return size.x * size.y;
}

/// What of a cell lies in which texel.
struct Coverage {
  vec2 origin;  // all other places are seen from there: near it floats have more digits
  vec2 first;   // of the texels
  vec2 end;
  Edge ab;
  Edge bc;
  Edge ca;
  Edge cd;
  Edge da;
  float share_1;  // over the signed area of each triangle; 0 of a point
  float share_2;
  vec2 point_1;
  vec2 point_2;
  float point_share_1;
  float point_share_2;
};

/// @param size  of the picture, in texels
Coverage coverageOf(CellOnPicture cell, vec2 size) {
  Coverage k;
  k.origin = floor(cell.lower);
  k.first = max(vec2(0.0), -k.origin);
  // A point on a texel's border is in the texel after it.
  k.end = min(floor(cell.upper) + 1.0, size) - k.origin;
  vec2 a = cell.corners[0] - k.origin, b = cell.corners[1] - k.origin, c = cell.corners[2] - k.origin,
       d = cell.corners[3] - k.origin;
  k.ab = makeEdge(a, b);
  k.bc = makeEdge(b, c);
  k.ca = makeEdge(c, a);
  k.cd = makeEdge(c, d);
  k.da = makeEdge(d, a);
  float area_1 = 0.5 * crossOf(b - a, c - a), area_2 = 0.5 * crossOf(c - a, d - a);
  bool is_point_1 = abs(area_1) < kLeastArea, is_point_2 = abs(area_2) < kLeastArea;
  k.point_1 = (a + b + c) / 3.0;
  k.point_2 = (a + c + d) / 3.0;
  k.share_1 = is_point_1 ? 0.0 : 0.5 / area_1;
  k.share_2 = is_point_2 ? 0.0 : 0.5 / area_2;
  k.point_share_1 = is_point_1 ? 0.5 : 0.0;
  k.point_share_2 = is_point_2 ? 0.5 : 0.0;
  return k;
}

Coverage coverageOf(CellOnPicture cell) { return coverageOf(cell, vec2(push.width, push.height)); }

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

/// Texels of a row in which some of the cell may lie: the first one, and where they end.
vec2 rowOf(Coverage k, float y) {
  vec2 span = spanInRow(spanInRow(vec2(1e30, -1e30), k.ab, y), k.bc, y);
  span = spanInRow(spanInRow(span, k.cd, y), k.da, y);
  // Of a folded cell both triangles lie on one side of the diagonal, which then bounds it.
  span = spanInRow(span, k.ca, y);
  if (k.point_share_1 > 0.0 && floor(k.point_1.y) == y)
    span = vec2(min(span.x, k.point_1.x), max(span.y, k.point_1.x));
  if (k.point_share_2 > 0.0 && floor(k.point_2.y) == y)
    span = vec2(min(span.x, k.point_2.x), max(span.y, k.point_2.x));
  return vec2(max(k.first.x, floor(span.x)), min(k.end.x, span.y + 1.0));
}

float countTexels(Coverage k) {
  vec2 size = ceil(k.end - k.first);
  return size.x * size.y;
}

/// Share of the cell's flux in the texel whose corner lies at `at`.
float shareIn(Coverage k, vec2 at) {
  float diagonal = areaUnder(k.ca, at);
  float in_1 = areaUnder(k.ab, at) + areaUnder(k.bc, at) + diagonal;
  float in_2 = areaUnder(k.cd, at) + areaUnder(k.da, at) - diagonal;
  return max(in_1 * k.share_1, 0.0) + max(in_2 * k.share_2, 0.0) + (at == floor(k.point_1) ? k.point_share_1 : 0.0) +
         (at == floor(k.point_2) ? k.point_share_2 : 0.0);
}

Span spanOf(CellOnPicture cell, vec3 places[4], uint view) {
  return Span(places[0], places[2],
              texelSize(cell.most_w, vec2(push.width, push.height)) + 0.25 * length(places[2] - places[0]),
              kViewsShare ? forwardOf(view) : vec3(0.0));
}

/// What no picture shows.
void addToLost(Light light, uint salt) { addToTexel(ivec2(0), 0u, light, 1.0, salt, false); }

void addShare(Coverage k, vec2 at, uint view, Span span, Light light, uint salt) {
  float share = shareIn(k, at);
  if (share <= 0.0) return;
  ivec2 texel = ivec2(k.origin + at);
  uint layer = litLayer(texel, view, span, light.direction);
  bool is_lit = layer < kFluxLayers;
  addToTexel(texel, view * kFluxLayers + (is_lit ? layer : 0u), light, share, salt, is_lit);
}

/// All of a small cell, in one loop, so that threads that go in step do not wait for each other's rows.
void addRows(Coverage k, uint view, Span span, Light light, uint salt) {
  float y = k.first.y;
  vec2 row = rowOf(k, y);
  while (y < k.end.y) {
    if (row.x < row.y) addShare(k, vec2(row.x, y), view, span, light, salt);
    row.x += 1.0;
    if (row.x < row.y) continue;
    y += 1.0;
    row = rowOf(k, y);
  }
}

bool isPhoton(ivec2 at) {
  return min(at.x, at.y) >= 0 && at.x < int(push.grid_width) && at.y < int(push.grid_height);
}
uint indexOf(ivec2 at) { return uint(at.y) * push.grid_width + uint(at.x); }

/// The photons about a cell; the outermost cells have some on one side only.
struct Cell {
  vec3 places[4];
  vec3 flux[4];
  vec3 directions[4];
  uint valid;     // bit k: corner k is a photon that ended on a receiver
  bool is_whole;  // and all four took the same way
};

/// @param first  of its corners; from (-1, -1) on
/// @param size   photons from one corner to the next: more than one of a square of cells
Cell fetchCell(ivec2 first, int size) {
  Cell cell;
  cell.valid = 0u;
  cell.is_whole = true;
  uint chain = 0u;
  vec3 sum = vec3(0.0);
  for (uint k = 0u; k < 4u; ++k) {
    ivec2 at = first + size * kCorners[k];
    bool is_photon = isPhoton(at);
    Photon photon = fetchPhoton(is_photon ? indexOf(at) : 0u);
    bool is_valid = is_photon && (photon.light_band_flags & kPhotonValid) != 0u;
    if (k == 0u) chain = photon.chain;
    cell.is_whole = cell.is_whole && is_valid && photon.chain == chain;
    cell.valid |= is_valid ? 1u << k : 0u;
    cell.places[k] = photon.position;
    cell.flux[k] = photon.flux;
    cell.directions[k] = photon.direction;
    sum += photon.direction;
  }
  vec3 mean = normalize(sum);
  for (uint k = 0u; k < 4u; ++k) cell.is_whole = cell.is_whole && dot(cell.directions[k], mean) >= kLeastCosine;
  return cell;
}

/// A quarter of each corner's flux.
Light lightOf(Cell cell) {
  vec3 flux = 0.25 * (cell.flux[0] + cell.flux[1] + cell.flux[2] + cell.flux[3]);
  return Light(flux,
               normalize(cell.directions[0] + cell.directions[1] + cell.directions[2] + cell.directions[3]));
}

/// Cells along a side of the grid: one more than photons.
uint cellsAcross() { return push.grid_width + 1u; }
uint cellCount() { return cellsAcross() * (push.grid_height + 1u); }
uint numberOf(ivec2 first) { return uint(first.y + 1) * cellsAcross() + uint(first.x + 1); }
ivec2 firstOf(uint number) { return ivec2(number % cellsAcross(), number / cellsAcross()) - 1; }

/// Of what is listed: not a cell but the square that begins with it.
const uint kIsSquare = 0x80000000u;
/// Of what else is listed: where it says which part of a cell or of a photon it is.
const uint kPartShift = 28u;
/// A cell; a photon; parts before are quarters of one (deposit_torn.glsl).
const uint kWholePart = 4u;
const uint kPhotonPart = 5u;

uint numberIn(uint item) { return item & ((1u << kPartShift) - 1u); }
uint saltOf(uint number, uint part) { return 8u * number + part; }

/// Squares of cells, from the one before the first photons on: bits of those of its cells that are whole.
uint placeOfSquare(uvec2 square) {
  uint across = (push.grid_width + kDepositSquare - 1u) / kDepositSquare + 1u;
  return 2u * cellCount() + square.y * across + square.x;
}
uint wholeCells(uvec2 square) { return listed[placeOfSquare(square)]; }

/// Leaves a piece to the last pass. @return  false: there is no room
/// @param texels  that it covers at the most
bool leave(uint number, uint part, float texels) {
  uint place = atomicAdd(lists.large_count, 1u);
  if (place >= cellCount()) return false;
  float parts = texels * float(kLayerParts) / (float(push.width) * float(push.height));
  atomicAdd(lists.large_parts, uint(toSteps(parts, mixBits(saltOf(number, part)))));
  listed[cellCount() + place] = number | part << kPartShift;
  return true;
}

#endif
