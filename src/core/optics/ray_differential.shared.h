// Ray differentials: how the end of a path moves when its start is moved a little, to first order [igehy-1999].
//
// A differential carries ∂P/∂x and ∂D/∂x for two parameters x, y of the emission (say, the grid of a light). Every
// event on the path has one function here that turns the differential before it into the one after it. The position
// differentials at the receiver, times half the spacing of the emission samples, are the half-axes of the photon's
// footprint. Equation numbers are those of [larsen-2006] §2.10, checked by derivation and finite differences:
//  - 2.58 has Δx where Δy is meant, 2.76 has ∂d where ∂x is meant: misprints without consequence.
//  - 2.65 is true only for a plane through the origin; in general t = (Q − P)·N / (D·N) with Q on the plane. Its
//    derivative 2.66 does hold in general.
//  - Below 2.65 the text says that any N gives the same ratio and that the surface normal may be taken. It may not be
//    an interpolated (shading) normal: N must be perpendicular to the plane that is hit, or the footprint is sheared
//    out of it. The derivatives of reflection and refraction, in contrast, take the shading normal.
//  - 2.82 to 2.84 are right only if P is homogeneous, (x, y, z, 1), as a plane's four numbers need; ∂P/∂x of 2.87 is
//    then (dx, dy, dz, 0). Here the barycentric weights of the hit are passed and only the gradients are needed.
//  - 2.73 to 2.79, 2.87, 2.88 hold as printed, with N on the side that D comes from and η = ior_from/ior_to.
//
// A first-order footprint is wrong where light does not move smoothly: across an edge of the mesh, or next to the
// critical angle, where the derivative of the refracted direction grows without bound. `valid` turns false there and
// stays false.
#ifndef NEPHROID_RAY_DIFFERENTIAL_SHARED_H
#define NEPHROID_RAY_DIFFERENTIAL_SHARED_H

#include "bridge.shared.h"

NEPHROID_NAMESPACE_BEGIN

struct RayDifferential {
  vec3 dp_dx;  // of the position, per unit of x
  vec3 dp_dy;
  vec3 dd_dx;  // of the unit direction, per unit of x; perpendicular to the direction
  vec3 dd_dy;
  bool valid;
};

/// Change of a unit shading normal along the two differentials of the position.
struct NormalDifferential {
  vec3 dn_dx;
  vec3 dn_dy;
};

/// Derivative of normalize(v) along dv: v of any length > 0. (Eqs. 2.60 and 2.88 are both this.)
NEPHROID_FN vec3 differentiateNormalized(vec3 v, vec3 dv) {
  float inverse_length = 1.0f / length(v);
  vec3 unit = v * inverse_length;
  return (dv - unit * dot(unit, dv)) * inverse_length;
}

/// After a straight flight of length t that ends on a plane (eqs. 2.63, 2.64, 2.66).
///
/// @param dir          unit direction of the flight
/// @param distance     t, m, >= 0
/// @param n_geometric  normal of the plane that is hit, any sign and length; not the interpolated normal
/// @return             not valid where the flight is parallel to the plane
NEPHROID_FN RayDifferential transferDifferential(RayDifferential r, vec3 dir, float distance, vec3 n_geometric) {
  float along = dot(dir, n_geometric);
  if (along == 0.0f) {
    r.valid = false;
    return r;
  }
  vec3 shift_x = r.dp_dx + r.dd_dx * distance;
  vec3 shift_y = r.dp_dy + r.dd_dy * distance;
  r.dp_dx = shift_x - dir * (dot(shift_x, n_geometric) / along);
  r.dp_dy = shift_y - dir * (dot(shift_y, n_geometric) / along);
  return r;
}

/// After a mirror (eqs. 2.69 to 2.71); dir is the direction before it. The sign of (n, dn) does not matter.
NEPHROID_FN RayDifferential reflectDifferential(RayDifferential r, vec3 dir, vec3 n, NormalDifferential dn) {
  float cos_dn = dot(dir, n);
  float change_x = dot(r.dd_dx, n) + dot(dir, dn.dn_dx);
  float change_y = dot(r.dd_dy, n) + dot(dir, dn.dn_dy);
  r.dd_dx = r.dd_dx - (dn.dn_dx * cos_dn + n * change_x) * 2.0f;
  r.dd_dy = r.dd_dy - (dn.dn_dy * cos_dn + n * change_y) * 2.0f;
  return r;
}

/// After a refraction (eqs. 2.73 to 2.79).
///
/// @param dir        unit direction before it
/// @param n          unit shading normal on the side that dir comes from; dn is the derivative of this very n
/// @param ior_ratio  ior_from / ior_to
/// @return           not valid at and beyond the critical angle
NEPHROID_FN RayDifferential refractDifferential(RayDifferential r, vec3 dir, vec3 n, NormalDifferential dn,
                                                float ior_ratio) {
  float cos_dn = dot(dir, n);
  float t2 = (1.0f - ior_ratio) * (1.0f + ior_ratio) + ior_ratio * ior_ratio * cos_dn * cos_dn;
  if (t2 <= 0.0f) {
    r.valid = false;
    return r;
  }
  float cos_refracted = -sqrt(t2);  // D'·N
  float mu = ior_ratio * cos_dn - cos_refracted;
  float dmu = ior_ratio - ior_ratio * ior_ratio * cos_dn / cos_refracted;
  float change_x = dot(r.dd_dx, n) + dot(dir, dn.dn_dx);
  float change_y = dot(r.dd_dy, n) + dot(dir, dn.dn_dy);
  r.dd_dx = r.dd_dx * ior_ratio - (dn.dn_dx * mu + n * (dmu * change_x));
  r.dd_dy = r.dd_dy * ior_ratio - (dn.dn_dy * mu + n * (dmu * change_y));
  return r;
}

/// Gradient of the weight of corner p0 over the triangle: perpendicular to the opposite edge, in the plane, 1/m.
/// Zero for a triangle without area.
NEPHROID_FN vec3 barycentricGradient(vec3 p0, vec3 p1, vec3 p2) {
  vec3 edge = p2 - p1;
  vec3 side = p0 - p1;
  float edge2 = dot(edge, edge);
  if (edge2 == 0.0f) return vec3(0.0f);
  vec3 height = side - edge * (dot(side, edge) / edge2);
  float height2 = dot(height, height);
  return height2 > 0.0f ? height / height2 : vec3(0.0f);
}

/// Change of the interpolated, normalised normal of a triangle along a change dp of the point (eqs. 2.85 to 2.88).
///
/// @param p0 p1 p2      corners, m
/// @param n0 n1 n2      normals at the corners; unit or not, as they are interpolated
/// @param barycentrics  weights of the corners at the hit
/// @param dp            change of the point, in the plane of the triangle
/// @return              derivative of normalize(Σ bᵢ·nᵢ). Where the caller flips that normal he flips this.
NEPHROID_FN vec3 differentiateTriangleNormal(vec3 p0, vec3 p1, vec3 p2, vec3 n0, vec3 n1, vec3 n2, vec3 barycentrics,
                                             vec3 dp) {
  float db0 = dot(barycentricGradient(p0, p1, p2), dp);
  float db1 = dot(barycentricGradient(p1, p2, p0), dp);
  float db2 = dot(barycentricGradient(p2, p0, p1), dp);
  vec3 n = n0 * barycentrics.x + n1 * barycentrics.y + n2 * barycentrics.z;
  return differentiateNormalized(n, n0 * db0 + n1 * db1 + n2 * db2);
}

/// differentiateTriangleNormal along both position differentials of a ray that ends on the triangle.
NEPHROID_FN NormalDifferential triangleNormalDifferential(RayDifferential r, vec3 p0, vec3 p1, vec3 p2, vec3 n0,
                                                          vec3 n1, vec3 n2, vec3 barycentrics) {
  NormalDifferential dn;
  dn.dn_dx = differentiateTriangleNormal(p0, p1, p2, n0, n1, n2, barycentrics, r.dp_dx);
  dn.dn_dy = differentiateTriangleNormal(p0, p1, p2, n0, n1, n2, barycentrics, r.dp_dy);
  return dn;
}

NEPHROID_NAMESPACE_END

#endif
