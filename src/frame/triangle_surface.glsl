// What all points of one triangle have in common, fetched and computed once for several of them.
//
// A texel of a table costs a device that is a CPU about as much as thirty sums, and it moves nothing out of loops by
// itself: whoever lights several pixels of one triangle asks for it here, before the loop.
#ifndef NEPHROID_TRIANGLE_SURFACE_GLSL
#define NEPHROID_TRIANGLE_SURFACE_GLSL

#include "frame/material.glsl"

struct TriangleSurface {
  Surface surface;  // at its first corner, its normals as they are
  vec3 normal_a;    // of its vertices, world, of any length
  vec3 normal_b;
  vec3 normal_c;
  MaterialRecord material;
};

TriangleSurface fetchTriangleSurface(uint instance_index, uint triangle) {
  TriangleSurface t;
  InstanceRecord instance = fetchInstance(instance_index);
  TriangleRecord record = fetchTriangle(instance.first_triangle + triangle);
  t.surface = surfaceAt(instance_index, triangle, instance, record, toWorld(instance, record), 0.0, 0.0);
  t.normal_a = normalToWorld(instance, unpackUnitVector(record.normal_a));
  t.normal_b = normalToWorld(instance, unpackUnitVector(record.normal_b));
  t.normal_c = normalToWorld(instance, unpackUnitVector(record.normal_c));
  t.material = fetchMaterial(instance.material);
  return t;
}

/// Its surface at a place on it, as surfaceAt gives it.
/// @param u, v  weights of the second and third corner
Surface surfaceOn(TriangleSurface t, vec3 place, float u, float v) {
  Surface s = t.surface;
  s.position = place;
  s.u = u;
  s.v = v;
  vec3 normal = (1.0 - u - v) * t.normal_a + u * t.normal_b + v * t.normal_c;
  float squared = dot(normal, normal);
  normal *= squared > 0.0 ? inversesqrt(squared) : 0.0;
  bool smooth_shaded = (s.instance.flags & kInstanceHasNormals) != 0u && dot(normal, s.geometric) > 0.0;
  s.shading = smooth_shaded ? normal : s.geometric;
  return s;
}

/// Its material there; normal maps are perturbedNormal's.
MaterialPoint materialOn(TriangleSurface t, float u, float v) {
  Coordinates at = Coordinates(vec2[2](vec2(0.0), vec2(0.0)), vec4(1.0));
  if (kSceneHasTextures) at = coordinatesAt(t.surface.instance, t.surface.triangle, u, v);
  return resolveMaterial(t.material, at);
}

#endif
