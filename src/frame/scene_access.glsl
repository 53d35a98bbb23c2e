// The scene's tables and what every pass asks of them. Bindings 0 to 4 of set 0.
#ifndef NEPHROID_SCENE_ACCESS_GLSL
#define NEPHROID_SCENE_ACCESS_GLSL

#include "frame/frame.shared.h"

layout(scalar, set = 0, binding = 0) readonly buffer Instances { InstanceRecord instances[]; };
layout(scalar, set = 0, binding = 1) readonly buffer Materials { MaterialRecord materials[]; };
layout(scalar, set = 0, binding = 2) readonly buffer Positions { vec3 positions[]; };  // object space
layout(scalar, set = 0, binding = 3) readonly buffer Normals { vec3 normals[]; };      // object space
layout(scalar, set = 0, binding = 4) readonly buffer Indices { uint indices[]; };

/// Rounding of an interpolated position, relative to the coordinates that it was computed from: 16 ulp.
const float kPositionErrorScale = 1.0 / 524288.0;

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

/// Unit, from a point to where the view sees it from.
vec3 dirToEye(ViewRecord view, vec3 position) {
  return view.is_orthographic != 0u ? -view.forward : normalize(view.eye - position);
}

struct Triangle {
  vec3 a;  // world
  vec3 b;
  vec3 c;
};

uvec3 triangleVertices(InstanceRecord instance, uint triangle) {
  uint first = instance.first_index + 3u * triangle;
  return uvec3(indices[first], indices[first + 1u], indices[first + 2u]) + uvec3(instance.first_vertex);
}

vec3 toWorld(InstanceRecord instance, vec3 position) {
  vec4 p = vec4(position, 1.0);
  return vec3(dot(instance.row_x, p), dot(instance.row_y, p), dot(instance.row_z, p));
}

/// Normals turn by the cofactors of the matrix, which need no inverse.
vec3 normalToWorld(InstanceRecord instance, vec3 normal) {
  vec3 x = instance.row_x.xyz, y = instance.row_y.xyz, z = instance.row_z.xyz;
  vec3 turned = vec3(dot(cross(y, z), normal), dot(cross(z, x), normal), dot(cross(x, y), normal));
  return (instance.flags & kInstanceMirrored) != 0u ? -turned : turned;
}

Triangle fetchTriangle(InstanceRecord instance, uvec3 vertices) {
  return Triangle(toWorld(instance, positions[vertices.x]), toWorld(instance, positions[vertices.y]),
                  toWorld(instance, positions[vertices.z]));
}

/// Twice the area along the normal that points out of the solid.
vec3 areaNormal(InstanceRecord instance, Triangle t) {
  vec3 normal = cross(t.b - t.a, t.c - t.a);
  return (instance.flags & kInstanceMirrored) != 0u ? -normal : normal;
}

/// Bound of the rounding error of a point of the triangle across it, m: new rays start off by so much.
float boundPositionError(Triangle t, vec3 normal) {
  vec3 magnitude = max(max(abs(t.a), abs(t.b)), abs(t.c));
  return kPositionErrorScale * dot(abs(normal), magnitude);
}

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

/// Unit vector to 2 × 16 bits and back (octahedral), error below 5e-5.
uint packUnit(vec3 n) {
  vec2 p = n.xy / (abs(n.x) + abs(n.y) + abs(n.z));
  if (n.z < 0.0) p = (1.0 - abs(p.yx)) * vec2(p.x >= 0.0 ? 1.0 : -1.0, p.y >= 0.0 ? 1.0 : -1.0);
  return packSnorm2x16(p);
}

vec3 unpackUnit(uint packed) {
  vec2 p = unpackSnorm2x16(packed);
  vec3 n = vec3(p, 1.0 - abs(p.x) - abs(p.y));
  if (n.z < 0.0) n.xy = (1.0 - abs(p.yx)) * vec2(p.x >= 0.0 ? 1.0 : -1.0, p.y >= 0.0 ? 1.0 : -1.0);
  return normalize(n);
}

#endif
