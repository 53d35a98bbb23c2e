// The photon record, 64 bytes, that every emitter writes and every deposit reads, on the CPU and on the GPU.
//
// Scalar block layout: GLM's vec3 of 12 bytes is then GLSL's. The footprint is an ellipse on the receiver, kept as its
// two principal half-axes: two lengths in full precision and the direction of the longer one in world space,
// octahedrally packed into 2 × 16 bits (error below 1e-4 rad). That is 12 bytes; two packed vectors would need as many
// and lose what matters most near a fold, where one half-axis is thousands of times the other and the area is a small
// difference. A direction in world space needs no tangent frame, which would have to be the same to the last bit where
// it is written and where it is read, and every frame made from a normal is discontinuous somewhere.
#ifndef NEPHROID_PHOTON_SHARED_H
#define NEPHROID_PHOTON_SHARED_H

#include "bridge.shared.h"

NEPHROID_NAMESPACE_BEGIN

NEPHROID_CONST uint kPhotonValid = 1u;           // ended on a receiver after an event; else only flags and index count
NEPHROID_CONST uint kPhotonFootprintValid = 2u;  // the three footprint fields say something
NEPHROID_CONST uint kPhotonLeftScene = 4u;       // ended on nothing: position is where it was last, direction counts
NEPHROID_CONST uint kPhotonMaxLights = 65536u;
NEPHROID_CONST uint kPhotonMaxBands = 256u;

struct Photon {
  vec3 position;               // world, m: where it ends
  float path_length;           // m, since the last specular event
  vec3 direction;              // unit, world, along the travel of light
  uint light_band_flags;       // light << 16 | band << 8 | flags; see packLightBandFlags
  vec3 flux;                   // W, linear Rec. 709, signed (a band's weight may be negative)
  uint index;                  // of the emission sample; grid emitters: row · grid_width + column
  uint chain;                  // hash of the surfaces met, by hashChain
  float footprint_major;       // m, >= 0: longer half-axis
  float footprint_minor;       // m, |minor| <= major; negative where the map from emission to receiver is mirrored
  uint footprint_orientation;  // direction of the longer half-axis, packed by packUnitVector
};

/// What holds for all photons of a batch. A grid of width × height 0 means that the order says nothing.
struct PhotonBatch {
  uint light;          // index into the scene's lights
  uint emitted_count;  // photons emitted, also those that left no record; the flux of each is not yet divided by it
  uint batch;          // number of the batch, from 0
  uint grid_width;     // photons per row of the emission grid, or 0
  uint grid_height;
  uint band_count;  // >= 1
};

/// A footprint on the receiver: orthogonal half-axes of an ellipse, m; `b` is cross(n, a) scaled, with the sign of the
/// map's determinant, so its signed area is π·dot(cross(a, b), n).
struct Footprint {
  vec3 axis_a;
  vec3 axis_b;
};

NEPHROID_FN uint packLightBandFlags(uint light, uint band, uint flags) {
  return (light << 16) | ((band & 255u) << 8) | (flags & 255u);
}
NEPHROID_FN uint photonLight(Photon p) { return p.light_band_flags >> 16; }
NEPHROID_FN uint photonBand(Photon p) { return (p.light_band_flags >> 8) & 255u; }
NEPHROID_FN uint photonFlags(Photon p) { return p.light_band_flags & 255u; }
NEPHROID_FN bool hasPhotonFlag(Photon p, uint flag) { return (p.light_band_flags & flag) != 0u; }

/// A bijection of 32-bit integers in which every input bit reaches every output bit (two rounds of multiply and
/// shift, after the finaliser of MurmurHash3).
NEPHROID_FN uint mixBits(uint x) {
  x = (x ^ (x >> 16)) * 0x85ebca6bu;
  x = (x ^ (x >> 13)) * 0xc2b2ae35u;
  return x ^ (x >> 16);
}

/// The chain after one more surface. Depends on the order; start with 0. Two photons with equal chains met the same
/// surfaces in the same order, but for a chance of 2⁻³².
///
/// @param surface  any number that tells surfaces (and the kind of event) apart
NEPHROID_FN uint hashChain(uint chain, uint surface) { return mixBits(chain * 0x9e3779b1u + mixBits(surface + 1u)); }

/// Unit vector to 32 bits: folded onto an octahedron, whose faces fill a square ([meyer-2010]); error below 1e-4 rad.
NEPHROID_FN uint packUnitVector(vec3 v) {
  float scale = 1.0f / (abs(v.x) + abs(v.y) + abs(v.z));
  float x = v.x * scale;
  float y = v.y * scale;
  if (v.z < 0.0f) {
    float folded_x = (1.0f - abs(y)) * (x >= 0.0f ? 1.0f : -1.0f);
    y = (1.0f - abs(x)) * (y >= 0.0f ? 1.0f : -1.0f);
    x = folded_x;
  }
  return packSnorm2x16(vec2(x, y));
}

NEPHROID_FN vec3 unpackUnitVector(uint packed_vector) {
  vec2 p = unpackSnorm2x16(packed_vector);
  float z = 1.0f - abs(p.x) - abs(p.y);
  float fold = max(-z, 0.0f);
  return normalize(vec3(p.x - (p.x >= 0.0f ? fold : -fold), p.y - (p.y >= 0.0f ? fold : -fold), z));
}

/// Any unit vector perpendicular to unit n.
NEPHROID_FN vec3 perpendicularTo(vec3 n) {
  // Crossed with the axis that n is farthest from, so the product is at least sqrt(2/3) long.
  vec3 m = vec3(abs(n.x), abs(n.y), abs(n.z));
  vec3 axis = m.x <= m.y && m.x <= m.z ? vec3(1.0f, 0.0f, 0.0f)
                                       : (m.y <= m.z ? vec3(0.0f, 1.0f, 0.0f) : vec3(0.0f, 0.0f, 1.0f));
  return normalize(cross(n, axis));
}

/// Direction of the longer half-axis of the ellipse { M·u : |u| <= 1 } in the plane; the columns of M are a and b.
/// M is the sum of a rotation-scaling Q and a mirrored one R; as complex numbers the major direction bisects them.
NEPHROID_FN vec2 majorDirection(vec2 a, vec2 b) {
  vec2 q = vec2(a.x + b.y, a.y - b.x);
  vec2 r = vec2(a.x - b.y, a.y + b.x);
  vec2 z = vec2(q.x * r.x - q.y * r.y, q.x * r.y + q.y * r.x);
  float z_length = length(z);
  // A circle, to within rounding: every direction is one of its axes.
  if (z_length < 1e-12f) return vec2(1.0f, 0.0f);
  z = z / z_length;
  // Half the angle of z, from the larger of its half-angle functions so that nothing cancels.
  if (z.x >= 0.0f) {
    float c = sqrt(0.5f * (1.0f + z.x));
    return vec2(c, 0.5f * z.y / c);
  }
  float s = sqrt(0.5f * (1.0f - z.x));
  return vec2(0.5f * z.y / s, s);
}

/// Writes the ellipse spanned by two half-axes into the photon and sets kPhotonFootprintValid.
///
/// @param axis_a axis_b  conjugate half-axes, m: the images of the half-axes of the emission's cell. They need not be
///                       orthogonal; what is off the receiver's plane is dropped.
/// @param n              unit normal of the receiver
NEPHROID_FN Photon setPhotonFootprint(Photon p, vec3 axis_a, vec3 axis_b, vec3 n) {
  vec3 x = perpendicularTo(n);
  vec3 y = cross(n, x);
  vec2 a = vec2(dot(axis_a, x), dot(axis_a, y));
  vec2 b = vec2(dot(axis_b, x), dot(axis_b, y));
  // To unit size first: squares of micrometres squared would underflow.
  float size = max(max(abs(a.x), abs(a.y)), max(abs(b.x), abs(b.y)));
  p.light_band_flags = p.light_band_flags | kPhotonFootprintValid;
  if (size == 0.0f) {
    p.footprint_major = 0.0f;
    p.footprint_minor = 0.0f;
    p.footprint_orientation = packUnitVector(x);
    return p;
  }
  a = a / size;
  b = b / size;
  vec2 major = majorDirection(a, b);
  // Projections of both half-axes on the major direction: their norm is the larger singular value of (a b). The smaller
  // one follows from the determinant, which keeps the area exact however thin the ellipse is.
  float larger = length(vec2(dot(a, major), dot(b, major)));
  p.footprint_major = size * larger;
  p.footprint_minor = size * ((a.x * b.y - a.y * b.x) / larger);
  p.footprint_orientation = packUnitVector(x * major.x + y * major.y);
  return p;
}

/// The ellipse of a photon whose kPhotonFootprintValid is set; n is the receiver's unit normal.
NEPHROID_FN Footprint photonFootprint(Photon p, vec3 n) {
  vec3 stored = unpackUnitVector(p.footprint_orientation);
  vec3 side = normalize(cross(n, stored));
  Footprint footprint;
  footprint.axis_a = cross(side, n) * p.footprint_major;
  footprint.axis_b = side * p.footprint_minor;
  return footprint;
}

NEPHROID_NAMESPACE_END

#ifdef __cplusplus
#include <cstddef>
#include <type_traits>

static_assert(std::is_standard_layout_v<nephroid::Photon> && std::is_trivially_copyable_v<nephroid::Photon>);
static_assert(sizeof(nephroid::Photon) == 64);
static_assert(offsetof(nephroid::Photon, position) == 0);
static_assert(offsetof(nephroid::Photon, path_length) == 12);
static_assert(offsetof(nephroid::Photon, direction) == 16);
static_assert(offsetof(nephroid::Photon, light_band_flags) == 28);
static_assert(offsetof(nephroid::Photon, flux) == 32);
static_assert(offsetof(nephroid::Photon, index) == 44);
static_assert(offsetof(nephroid::Photon, chain) == 48);
static_assert(offsetof(nephroid::Photon, footprint_major) == 52);
static_assert(offsetof(nephroid::Photon, footprint_minor) == 56);
static_assert(offsetof(nephroid::Photon, footprint_orientation) == 60);
static_assert(sizeof(nephroid::PhotonBatch) == 24);
static_assert(offsetof(nephroid::PhotonBatch, light) == 0);
static_assert(offsetof(nephroid::PhotonBatch, emitted_count) == 4);
static_assert(offsetof(nephroid::PhotonBatch, batch) == 8);
static_assert(offsetof(nephroid::PhotonBatch, grid_width) == 12);
static_assert(offsetof(nephroid::PhotonBatch, grid_height) == 16);
static_assert(offsetof(nephroid::PhotonBatch, band_count) == 20);
#endif

#endif
