// Rays, and triangles that they meet.
#ifndef NEPHROID_RAY_GLSL
#define NEPHROID_RAY_GLSL

#include "frame/frame.shared.h"

/// Length of a ray that meets nothing.
const float kFarAway = 3.4e38;

struct Ray {
  vec3 origin;
  vec3 dir;  // unit
};

/// Through a place of a view's picture, its direction of any length: origin and direction are linear over the picture.
/// @param film  in [-1, 1]², y down
Ray linearRayThrough(ViewRecord view, vec2 film) {
  vec3 across = film.x * view.right - film.y * view.up;
  // No branch: see lookAt of frame/texel_surface.glsl.
  bvec3 is_parallel = bvec3(view.is_orthographic != 0u);
  return Ray(mix(view.eye, view.eye + across, is_parallel), mix(view.forward + across, view.forward, is_parallel));
}

/// Through a place of a view's picture. @param film  in [-1, 1]², y down
Ray rayThrough(ViewRecord view, vec2 film) {
  Ray ray = linearRayThrough(view, film);
  return Ray(ray.origin, normalize(ray.dir));
}

struct Triangle {
  vec3 a;  // world
  vec3 b;
  vec3 c;
};

/// Where a ray meets the plane of a triangle, everything times `size`: a division costs a software device as much as ten
/// products, and whoever only asks whether the triangle is met needs none.
struct RayTriangle {
  float t;  // along the ray
  float u;  // weights of the second and third corner
  float v;
  float size;  // >= 0; 0 if the ray is parallel to the plane
};

/// Möller and Trumbore's test, without its verdict: callers ask for what they need.
RayTriangle intersectPlaneOf(Triangle triangle, vec3 origin, vec3 dir) {
  vec3 e1 = triangle.b - triangle.a, e2 = triangle.c - triangle.a;
  vec3 p = cross(dir, e2);
  float determinant = dot(e1, p);
  float turn = determinant < 0.0 ? -1.0 : 1.0;
  vec3 s = origin - triangle.a;
  vec3 q = cross(s, e1);
  return RayTriangle(turn * dot(e2, q), turn * dot(s, p), turn * dot(dir, q), turn * determinant);
}

bool isInside(RayTriangle hit) { return hit.size > 0.0 && hit.u >= 0.0 && hit.v >= 0.0 && hit.u + hit.v <= hit.size; }

#endif
