// Rays, and triangles that they meet.
#ifndef NEPHROID_RAY_GLSL
#define NEPHROID_RAY_GLSL

#include "frame/frame.shared.h"

struct Ray {
  vec3 origin;
  vec3 dir;  // unit
};

/// Through a place of a view's picture. @param film  in [-1, 1]², y down
Ray rayThrough(ViewRecord view, vec2 film) {
  vec3 across = film.x * view.right - film.y * view.up;
  if (view.is_orthographic != 0u) return Ray(view.eye + across, view.forward);
  return Ray(view.eye, normalize(view.forward + across));
}

struct Triangle {
  vec3 a;  // world
  vec3 b;
  vec3 c;
};

struct RayTriangle {
  float t;  // along the ray; of the plane where the triangle is missed
  float u;  // weights of the second and third corner
  float v;
  bool valid;  // the ray is not parallel to the plane
};

/// Möller and Trumbore's test, without its verdict: callers ask for what they need.
RayTriangle intersectPlaneOf(Triangle triangle, vec3 origin, vec3 dir) {
  vec3 e1 = triangle.b - triangle.a, e2 = triangle.c - triangle.a;
  vec3 p = cross(dir, e2);
  float determinant = dot(e1, p);
  RayTriangle result = RayTriangle(0.0, 0.0, 0.0, determinant != 0.0);
  if (!result.valid) return result;
  float inverse = 1.0 / determinant;
  vec3 s = origin - triangle.a;
  vec3 q = cross(s, e1);
  result.u = dot(s, p) * inverse;
  result.v = dot(dir, q) * inverse;
  result.t = dot(e2, q) * inverse;
  return result;
}

bool isInside(RayTriangle hit) { return hit.valid && hit.u >= 0.0 && hit.v >= 0.0 && hit.u + hit.v <= 1.0; }

#endif
