// Photons between those that were followed: one thread a square of cells, whose corners were.
//
// Where the sixteen photons about a square took the same way and where they end bends slowly, those between end where
// cubic polynomials through them lead, with the flux that these say. Elsewhere the cells stay as they are, for the next
// pass, at half the spacing.
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#extension GL_EXT_control_flow_attributes : require
#include "frame/tables.glsl"
#include "frame/deposit.shared.h"
#include "techniques/caustic_map/transport.shared.h"
#define NEPHROID_PHOTON_BINDING 7
#include "frame/fetch_photon.glsl"
layout(scalar, set = 0, binding = 10) writeonly buffer Photons { Photon photons[]; };
#define NEPHROID_STANDINGS_BINDING 8
#include "techniques/caustic_map/standings.glsl"

layout(push_constant, scalar) uniform Push { TransportPush push; };
layout(set = 0, binding = 9) uniform usampler2DArray first_seen;
layout(scalar, set = 0, binding = 11) writeonly buffer Squares { uint squares[]; };
layout(local_size_x = 8, local_size_y = 8) in;
#include "techniques/caustic_map/first_met.glsl"

/// Third differences of places, over the distance between two photons that were followed, and of flux, over the flux.
/// What cubic polynomials are off by is a fourth difference times 0.023.
const float kMostBend = 0.25;
const float kMostChange = 0.1;
/// Cosines of what lies between directions of light, and between normals of the surfaces that it ends on.
const float kLeastAlong = 0.99;
const float kLeastAlongLost = 0.9;  // of light that ends nowhere
const float kLeastFacing = 0.95;

uint indexOf(uvec2 cell) { return cell.y * push.grid + cell.x; }

/// What is known of four photons in a row.
struct Row {
  vec3 position[4];
  vec3 flux[4];
};

Row fetchRow(uvec2 first) {
  Row row;
  [[unroll]] for (uint k = 0u; k < 4u; ++k) {
    Photon photon = fetchPhoton(indexOf(first + uvec2(k * push.spacing, 0u)));
    row.position[k] = photon.position;
    row.flux[k] = photon.flux;
  }
  return row;
}

vec3 thirdDifference(vec3 a, vec3 b, vec3 c, vec3 d) { return (d - a) - 3.0 * (c - b); }

/// Of the cubic polynomial through values at -1, 0, 1, 2.
vec4 weightsAt(float t) {
  return vec4(-t * (t - 1.0) * (t - 2.0) / 6.0, (t + 1.0) * (t - 1.0) * (t - 2.0) * 0.5,
              -(t + 1.0) * t * (t - 2.0) * 0.5, (t + 1.0) * t * (t - 1.0) / 6.0);
}

vec3 weighed(vec3 v[4], vec4 w) { return w.x * v[0] + w.y * v[1] + w.z * v[2] + w.w * v[3]; }

/// Do all cells of the square wait for this branch, and does their light meet the same thing first?
bool isWhole(uvec2 first) {
  uint seen = firstSeen(filmOf(first)).x;
  bool whole = true;
  for (uint i = 1u; i < push.spacing * push.spacing && whole; ++i) {
    uvec2 cell = first + uvec2(i % push.spacing, i / push.spacing);
    whole = isWaitingFor(standings[indexOf(cell)], push.branch) && firstSeen(filmOf(cell)).x == seen;
  }
  return whole;
}

/// Did the sixteen photons about the square take the same way to surfaces of the same slope, and do those at its
/// corners go on alike?
bool tookSameWay(uvec2 first) {
  Photon own = fetchPhoton(indexOf(first));
  vec3 facing = unpackUnitVector(own.footprint_orientation);
  uint standing = standings[indexOf(first)] >> 1;
  bool valid = hasPhotonFlag(own, kPhotonValid);
  // A cell that was not followed has no flags at all.
  bool same = photonFlags(own) != 0u && !hasPhotonFlag(own, kPhotonVaries);
  for (uint i = 0u; i < 16u && same; ++i) {
    uvec2 at = uvec2(i & 3u, i >> 2);
    uint index = indexOf(first + at * push.spacing - push.spacing);
    bool is_corner = at.x == 1u || at.x == 2u ? at.y == 1u || at.y == 2u : false;
    Photon other = fetchPhoton(index);
    same = other.chain == own.chain && other.light_band_flags == own.light_band_flags &&
           dot(other.direction, own.direction) >= (valid ? kLeastAlong : kLeastAlongLost) &&
           (!valid || dot(unpackUnitVector(other.footprint_orientation), facing) >= kLeastFacing) &&
           (!is_corner || standings[index] >> 1 == standing);
  }
  return same;
}

/// The sixteen photons about a square, row by row.
struct Around {
  Row rows[4];
};

bool bendsSlowly(Around around) {
  float bend = 0.0, change = 0.0, flux = 0.0;
  [[unroll]] for (uint k = 0u; k < 4u; ++k) {
    Row r = around.rows[k];
    bend = max(bend, length(thirdDifference(r.position[0], r.position[1], r.position[2], r.position[3])));
    bend = max(bend, length(thirdDifference(around.rows[0].position[k], around.rows[1].position[k],
                                            around.rows[2].position[k], around.rows[3].position[k])));
    vec3 across = abs(thirdDifference(r.flux[0], r.flux[1], r.flux[2], r.flux[3]));
    vec3 down = abs(thirdDifference(around.rows[0].flux[k], around.rows[1].flux[k], around.rows[2].flux[k],
                                    around.rows[3].flux[k]));
    vec3 most = max(across, down), own = abs(r.flux[1]);
    change = max(change, max(most.x, max(most.y, most.z)));
    flux = max(flux, max(own.x, max(own.y, own.z)));
  }
  float step = max(length(around.rows[1].position[2] - around.rows[1].position[1]) +
                       length(around.rows[2].position[2] - around.rows[2].position[1]),
                   length(around.rows[2].position[1] - around.rows[1].position[1]) +
                       length(around.rows[2].position[2] - around.rows[1].position[2]));
  return bend <= kMostBend * 0.5 * step && change <= kMostChange * flux;
}

/// Where the cells between stand: nothing was kept of their ways.
uint standingWithin(uvec2 first) {
  return standings[indexOf(first)] != kIsDone ? waitsFor(push.branch + 1u, false) : kIsDone;
}

/// Light that ends nowhere leaves no photons.
void passOver(uvec2 first) {
  uint standing = standingWithin(first);
  for (uint i = 1u; i < push.spacing * push.spacing; ++i)
    standings[indexOf(first + uvec2(i % push.spacing, i / push.spacing))] = standing;
}

void interpolate(uvec2 first, Around around) {
  Photon corners[4];
  [[unroll]] for (uint k = 0u; k < 4u; ++k)
    corners[k] = fetchPhoton(indexOf(first + uvec2((k & 1u) * push.spacing, (k >> 1) * push.spacing)));
  uint standing = standingWithin(first);
  for (uint x = 0u; x < push.spacing; ++x) {
    float s = float(x) / float(push.spacing);
    vec4 across = weightsAt(s);
    vec3 position[4], flux[4];
    [[unroll]] for (uint k = 0u; k < 4u; ++k) {
      position[k] = weighed(around.rows[k].position, across);
      flux[k] = weighed(around.rows[k].flux, across);
    }
    for (uint y = x == 0u ? 1u : 0u; y < push.spacing; ++y) {
      float t = float(y) / float(push.spacing);
      vec4 down = weightsAt(t);
      vec4 shares = vec4((1.0 - s) * (1.0 - t), s * (1.0 - t), (1.0 - s) * t, s * t);
      uint index = indexOf(first + uvec2(x, y));
      Photon photon = corners[0];
      photon.index = index;
      photon.position = weighed(position, down);
      photon.flux = weighed(flux, down);
      photon.direction = normalize(shares.x * corners[0].direction + shares.y * corners[1].direction +
                                   shares.z * corners[2].direction + shares.w * corners[3].direction);
      photon.path_length = dot(shares, vec4(corners[0].path_length, corners[1].path_length, corners[2].path_length,
                                            corners[3].path_length));
      photons[index] = photon;
      standings[index] = standing;
    }
  }
}

void main() {
  uvec2 first = gl_GlobalInvocationID.xy * push.spacing;
  // Those at the grid's edge have no photons around.
  bool is_inside = min(first.x, first.y) > 0u && max(first.x, first.y) + 2u * push.spacing < push.grid;
  // Most squares are done, or have nothing in this branch.
  if (!is_inside || !isWaitingFor(standings[indexOf(first) + 1u], push.branch)) return;
  if (!tookSameWay(first)) return;
  bool is_lost = !hasPhotonFlag(fetchPhoton(indexOf(first)), kPhotonValid);
  Around around;
  [[unroll]] for (uint k = 0u; k < 4u; ++k)
    around.rows[k] = fetchRow(uvec2(first.x - push.spacing, first.y + k * push.spacing - push.spacing));
  if (!(is_lost || bendsSlowly(around)) || !isWhole(first)) return;
  if (is_lost) passOver(first);
  else interpolate(first, around);
  if (!is_lost && push.squares_across > 0u && push.spacing == kDepositSquare)
    squares[first.y / kDepositSquare * push.squares_across + first.x / kDepositSquare] = 1u;
}
