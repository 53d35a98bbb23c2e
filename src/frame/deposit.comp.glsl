// Photons of a grid into a picture of flux: cells between four of them as quads, or each as a splat.
//
// A quad is two triangles of half the flux each, and each texel gets the share of a triangle's area that lies in it,
// exactly: so neighbours that fill a plane evenly give an even picture, folded cells count on both sides of the fold, and
// no flux falls between texels however small a cell becomes ([shah-caustics-mapping] §III-B splats points; §III-F).
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#extension GL_EXT_control_flow_attributes : require
#define NEPHROID_PHOTON_BINDING 0
#include "frame/photons.glsl"
#include "frame/frame.shared.h"
#include "frame/deposit.shared.h"

layout(local_size_x = 8, local_size_y = 8) in;
layout(scalar, set = 0, binding = 1) readonly buffer Views { ViewRecord views[]; };
layout(constant_id = 2) const uint kViewCount = 1u;
#include "frame/texel_surface.glsl"
layout(set = 0, binding = 2) uniform sampler2DArray surfaces;
layout(set = 0, binding = 3, r32i) uniform iimage2DArray flux_image;
layout(set = 0, binding = 4, r32ui) writeonly uniform uimage2DArray tile_image;
layout(scalar, set = 0, binding = 5) buffer Lost { int lost_steps[]; };

layout(constant_id = 0) const bool kMakesQuads = true;
layout(constant_id = 1) const bool kKeepsDirections = false;

layout(push_constant, scalar) uniform Push { DepositPush push; };

const uint kChannels = kKeepsDirections ? 2u * kFluxChannels : kFluxChannels;

/// Cells whose corners' directions differ by more than this are torn: an edge of the glass lies between them.
const float kLeastCosine = 0.93;
/// Triangles smaller than this, in texels, are lines: their area has no digits left.
const float kLeastArea = 4e-3;
const float kMostLinePoints = 64.0;

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

void addToTexel(ivec2 texel, uint view, Light light, float share, bool is_kept) {
  uint random = mixBits(uint(texel.x) + (uint(texel.y) << 12) + gl_GlobalInvocationID.x * 0x9e3779b1u +
                        gl_GlobalInvocationID.y * 0x85ebca6bu);
  vec3 steps = light.flux * (share * push.steps_per_watt);
  ivec3 whole = ivec3(toSteps(steps.x, random), toSteps(steps.y, random), toSteps(steps.z, random));
  if (!is_kept) {
    for (uint c = 0u; c < 3u; ++c) atomicAdd(lost_steps[c], whole[c]);
    return;
  }
  int layer = int(view * kChannels);
  imageAtomicAdd(flux_image, ivec3(texel, layer), whole.x);
  imageAtomicAdd(flux_image, ivec3(texel, layer + 1), whole.y);
  imageAtomicAdd(flux_image, ivec3(texel, layer + 2), whole.z);
  if (kKeepsDirections) {
    vec3 along = light.direction * luminanceOf(steps);
    for (int c = 0; c < 3; ++c)
      imageAtomicAdd(flux_image, ivec3(texel, layer + 3 + c), toSteps(along[c], mixBits(random + uint(c))));
  }
  imageStore(tile_image, ivec3(texel / int(kDepositTile), view), uvec4(1u));
}

TexelSurface fetchTexel(ivec2 texel, uint view) {
  return describeTexel(texelFetch(surfaces, ivec3(texel, view * push.layer_count), 0));
}

/// All at one place.
void addPoint(ivec2 texel, uint view, Light light, float share, vec3 place, float reach) {
  TexelSurface s = fetchTexel(texel, view);
  addToTexel(texel, view, light, share, liesOn(s, place, reach) && dot(light.direction, s.lit_normal) < 0.0);
}

/// A Gaussian over the texels about a place that show its surface, which together get all of it; nothing if the texel that
/// it lies in shows another.
void splat(vec3 place, Light light) {
  vec2 size = vec2(push.width, push.height);
  for (uint v = 0u; v < kViewCount; ++v) {
    OnPicture on = onPicture(projectionOf(v), place, size);
    if (!isOnPicture(on, size)) continue;
    float reach = texelSize(on.w, size) * (1.0 + push.splat_radius);
    ivec2 first = ivec2(max(floor(on.texels - push.splat_radius), vec2(0.0)));
    ivec2 last = ivec2(min(floor(on.texels + push.splat_radius), size - 1.0));
    TexelSurface own = fetchTexel(ivec2(on.texels), v);
    if (!liesOn(own, place, reach) || dot(light.direction, own.lit_normal) >= 0.0) {
      // Beside an edge others must not get what it hides.
      addToTexel(ivec2(on.texels), v, light, 1.0, false);
      return;
    }
    float inverse = 2.0 / max(push.splat_radius * push.splat_radius, 1e-6);
    float sum = 0.0;
    for (uint round = 0u; round < 2u; ++round) {
      for (int y = first.y; y <= last.y; ++y)
        for (int x = first.x; x <= last.x; ++x) {
          TexelSurface s = fetchTexel(ivec2(x, y), v);
          vec2 off = vec2(x, y) + 0.5 - on.texels;
          float weight = exp(-dot(off, off) * inverse);
          bool is_on = liesOn(s, place, reach) && dot(light.direction, s.lit_normal) < 0.0;
          if (!is_on) continue;
          if (round == 0u) sum += weight;
          else addToTexel(ivec2(x, y), v, light, weight / sum, true);
        }
    }
  }
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

/// A cell on a picture: corners counter-clockwise from its first, in texels from `origin`.
struct Quad {
  vec2 corners[4];
  vec2 origin;
  uint view;
};

float crossOf(vec2 a, vec2 b) { return a.x * b.y - a.y * b.x; }

/// A triangle without area: along its longest side.
void addLine(Quad q, uint i, uint j, uint k, Light light, vec3 place, float reach) {
  vec2 a = q.corners[i], b = q.corners[j], c = q.corners[k];
  vec2 from = a, to = b;
  if (dot(c - b, c - b) > dot(to - from, to - from)) { from = b; to = c; }
  if (dot(a - c, a - c) > dot(to - from, to - from)) { from = c; to = a; }
  float count = clamp(ceil(length(to - from)), 1.0, kMostLinePoints);
  vec2 size = vec2(push.width, push.height);
  for (float n = 0.5; n < count; n += 1.0) {
    vec2 at = floor(q.origin + mix(from, to, n / count));
    if (all(greaterThanEqual(at, vec2(0.0))) && all(lessThan(at, size))) addPoint(ivec2(at), q.view, light, 0.5 / count, place, reach);
  }
}

/// Both triangles, texel by texel.
void addQuad(Quad q, Light light, vec3 first_place, vec3 third_place, float reach) {
  vec2 a = q.corners[0], b = q.corners[1], c = q.corners[2], d = q.corners[3];
  float area_1 = 0.5 * crossOf(b - a, c - a), area_2 = 0.5 * crossOf(c - a, d - a);
  bool is_line_1 = abs(area_1) < kLeastArea, is_line_2 = abs(area_2) < kLeastArea;
  if (is_line_1) addLine(q, 0u, 1u, 2u, light, first_place, reach);
  if (is_line_2) addLine(q, 0u, 2u, 3u, light, third_place, reach);
  float share_1 = is_line_1 ? 0.0 : 0.5 / area_1, share_2 = is_line_2 ? 0.0 : 0.5 / area_2;
  if (is_line_1 && is_line_2) return;
  Edge ab = makeEdge(a, b), bc = makeEdge(b, c), ca = makeEdge(c, a), cd = makeEdge(c, d), da = makeEdge(d, a);
  vec2 lower = min(min(a, b), min(c, d)), upper = max(max(a, b), max(c, d));
  lower = max(floor(lower), -q.origin);
  upper = min(upper, vec2(push.width, push.height) - q.origin);
  for (float y = lower.y; y < upper.y; y += 1.0)
    for (float x = lower.x; x < upper.x; x += 1.0) {
      vec2 corner = vec2(x, y);
      float diagonal = areaUnder(ca, corner);
      float in_1 = areaUnder(ab, corner) + areaUnder(bc, corner) + diagonal;
      float in_2 = areaUnder(cd, corner) + areaUnder(da, corner) - diagonal;
      float share = max(in_1 * share_1, 0.0) + max(in_2 * share_2, 0.0);
      if (share <= 0.0) continue;
      ivec2 texel = ivec2(q.origin + corner);
      TexelSurface s = fetchTexel(texel, q.view);
      bool is_on = liesOn(s, first_place, reach) || liesOn(s, third_place, reach);
      addToTexel(texel, q.view, light, share, is_on && dot(light.direction, s.lit_normal) < 0.0);
    }
}

/// Where a cell is on a view's picture.
struct CellOnPicture {
  vec2 corners[4];
  vec2 lower;  // of the box about it
  vec2 upper;
  float least_w;
  float most_w;
};

CellOnPicture cellOnPicture(vec3 places[4], Projection projection) {
  CellOnPicture cell;
  for (uint k = 0u; k < 4u; ++k) {
    OnPicture on = onPicture(projection, places[k], vec2(push.width, push.height));
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

/// A cell between four photons on all pictures that show some of it: nearly always one.
void addCell(vec3 places[4], Light light) {
  uint left = 0u;
  [[unroll]] for (uint v = 0u; v < kViewCount; ++v)
    if (mayBeSeen(cellOnPicture(places, projectionOf(v)))) left |= 1u << v;
  while (left != 0u) {
    Quad q;
    q.view = uint(findLSB(left));
    left &= left - 1u;
    CellOnPicture cell = cellOnPicture(places, projectionOf(q.view));
    // Near the origin floats have more digits.
    q.origin = floor(cell.lower);
    for (uint k = 0u; k < 4u; ++k) q.corners[k] = cell.corners[k] - q.origin;
    float reach = texelSize(cell.most_w, vec2(push.width, push.height)) + 0.25 * length(places[2] - places[0]);
    addQuad(q, light, places[0], places[2], reach);
  }
}

bool isPhoton(ivec2 at) {
  return min(at.x, at.y) >= 0 && at.x < int(push.grid_width) && at.y < int(push.grid_height);
}

uint indexOf(ivec2 at) { return uint(at.y) * push.grid_width + uint(at.x); }

/// Half the way to where the next photon ends in a direction of the grid: of that photon or, mirrored, of the one on the
/// other side, if either took the same way. @return  false if neither did
bool halfStep(ivec2 at, ivec2 towards, out vec3 half_step) {
  uint own = indexOf(at);
  for (int sign = 1; sign >= -1; sign -= 2) {
    ivec2 other = at + sign * towards;
    if (!isPhoton(other)) continue;
    uint i = indexOf(other);
    if ((photons[i].light_band_flags & kPhotonValid) == 0u || photons[i].chain != photons[own].chain) continue;
    if (dot(photons[i].direction, photons[own].direction) < kLeastCosine) continue;
    half_step = 0.5 * float(sign) * (photons[i].position - photons[own].position);
    return true;
  }
  return false;
}

/// The quarter of a photon's flux on the side of its cell where it has no neighbours all around: over what its cell would
/// cover there if the light went on as on the other side.
/// @param side  the quarter's, -1 or 1 each
void addQuarter(ivec2 at, ivec2 side) {
  uint own = indexOf(at);
  Light light = Light(0.25 * photons[own].flux, photons[own].direction);
  vec3 place = photons[own].position, across, down;
  if (halfStep(at, ivec2(side.x, 0), across) && halfStep(at, ivec2(0, side.y), down)) {
    vec3 places[4] = vec3[4](place, place + across, place + across + down, place + down);
    addCell(places, light);
  } else {
    splat(place, light);
  }
}

void main() {
  // The cell's upper left photon; the outermost cells have photons on one side only.
  ivec2 first = ivec2(gl_GlobalInvocationID.xy) - 1;
  if (first.x >= int(push.grid_width) || first.y >= int(push.grid_height)) return;
  const ivec2 kCorners[4] = ivec2[4](ivec2(0, 0), ivec2(1, 0), ivec2(1, 1), ivec2(0, 1));
  uint valid = 0u, chain = 0u;
  bool is_cell = true;
  vec3 places[4], flux[4], directions[4];
  for (uint k = 0u; k < 4u; ++k) {
    ivec2 at = first + kCorners[k];
    bool is_photon = isPhoton(at);
    uint i = is_photon ? uint(at.y) * push.grid_width + uint(at.x) : 0u;
    bool is_valid = is_photon && (photons[i].light_band_flags & kPhotonValid) != 0u;
    if (is_valid) {
      places[k] = photons[i].position;
      flux[k] = photons[i].flux;
      directions[k] = photons[i].direction;
      if (valid == 0u) chain = photons[i].chain;
      is_cell = is_cell && photons[i].chain == chain;
      valid |= 1u << k;
    } else {
      is_cell = false;
    }
  }
  if (valid == 0u) return;
  if (!kMakesQuads) {
    // One of the four cells about each photon has it as its third corner.
    if ((valid & 4u) != 0u) splat(places[2], Light(flux[2], directions[2]));
    return;
  }
  if (is_cell) {
    vec3 sum = directions[0] + directions[1] + directions[2] + directions[3];
    vec3 mean = normalize(sum);
    for (uint k = 0u; k < 4u; ++k) is_cell = is_cell && dot(directions[k], mean) >= kLeastCosine;
    if (is_cell) {
      addCell(places, Light(0.25 * (flux[0] + flux[1] + flux[2] + flux[3]), mean));
      return;
    }
  }
  for (uint k = 0u; k < 4u; ++k)
    if ((valid & (1u << k)) != 0u) addQuarter(first + kCorners[k], kCorners[k ^ 2u] - kCorners[k]);
}
