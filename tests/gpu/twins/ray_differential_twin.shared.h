// Every function of ray_differential.shared.h on one input, for the device and for C++. No include guard: its test
// compiles it twice.
#include "core/optics/ray_differential.shared.h"

NEPHROID_NAMESPACE_BEGIN

struct RayDifferentialInput {
  vec3 dp_dx;
  vec3 dp_dy;
  vec3 dd_dx;
  vec3 dd_dy;
  vec3 dir;
  vec3 n;
  vec3 dn_dx;
  vec3 dn_dy;
  float path_length;
  float ior_ratio;
  vec3 p0;
  vec3 p1;
  vec3 p2;
  vec3 n0;
  vec3 n1;
  vec3 n2;
  vec3 barycentrics;
};

struct RayDifferentialOutput {
  vec3 normalized_change;
  vec3 transferred_x;
  vec3 transferred_y;
  uint transfer_valid;
  vec3 reflected_x;
  vec3 reflected_y;
  vec3 refracted_x;
  vec3 refracted_y;
  uint refraction_valid;
  vec3 gradient;
  vec3 triangle_normal_change;
  vec3 triangle_normal_x;
  vec3 triangle_normal_y;
};

NEPHROID_FN RayDifferentialOutput evaluateRayDifferential(RayDifferentialInput given) {
  RayDifferential r;
  r.dp_dx = given.dp_dx;
  r.dp_dy = given.dp_dy;
  r.dd_dx = given.dd_dx;
  r.dd_dy = given.dd_dy;
  r.valid = true;
  NormalDifferential dn;
  dn.dn_dx = given.dn_dx;
  dn.dn_dy = given.dn_dy;

  RayDifferentialOutput result;
  result.normalized_change = differentiateNormalized(given.n0 + given.n1, given.dp_dx);
  RayDifferential transferred = transferDifferential(r, given.dir, given.path_length, given.n);
  result.transferred_x = transferred.dp_dx;
  result.transferred_y = transferred.dp_dy;
  result.transfer_valid = transferred.valid ? 1u : 0u;
  RayDifferential reflected = reflectDifferential(r, given.dir, given.n, dn);
  result.reflected_x = reflected.dd_dx;
  result.reflected_y = reflected.dd_dy;
  RayDifferential refracted = refractDifferential(r, given.dir, given.n, dn, given.ior_ratio);
  result.refracted_x = refracted.dd_dx;
  result.refracted_y = refracted.dd_dy;
  result.refraction_valid = refracted.valid ? 1u : 0u;
  result.gradient = barycentricGradient(given.p0, given.p1, given.p2);
  result.triangle_normal_change = differentiateTriangleNormal(given.p0, given.p1, given.p2, given.n0, given.n1,
                                                              given.n2, given.barycentrics, given.dp_dy);
  NormalDifferential triangle =
      triangleNormalDifferential(r, given.p0, given.p1, given.p2, given.n0, given.n1, given.n2, given.barycentrics);
  result.triangle_normal_x = triangle.dn_dx;
  result.triangle_normal_y = triangle.dn_dy;
  return result;
}

NEPHROID_NAMESPACE_END
