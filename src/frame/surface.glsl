// From the triangle that a ray meets to the surface there: place, normals, coordinates.
//
// The point is where the ray meets the triangle, not what a rasteriser interpolated: the same arithmetic as a ray
// tracer's, so that both agree to rounding.
#ifndef NEPHROID_SURFACE_GLSL
#define NEPHROID_SURFACE_GLSL

#include "frame/tables.glsl"
#include "frame/ray.glsl"

/// Rounding of an interpolated position, relative to the coordinates that it was computed from: 16 ulp.
const float kPositionErrorScale = 1.0 / 524288.0;

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

Triangle toWorld(InstanceRecord instance, TriangleRecord t) {
  return Triangle(toWorld(instance, t.a), toWorld(instance, t.b), toWorld(instance, t.c));
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

/// Weights of the corners where a ray meets a triangle or passes it by: a rasteriser rounds corners to a fraction of a
/// pixel, so it may show what the ray just misses. Then it is the nearest point to the ray of the edge that it misses
/// most by; where the plane is met may be far from there, if it is seen edge-on.
vec3 weightsOn(Triangle t, Ray ray) {
  RayTriangle hit = intersectPlaneOf(t, ray.origin, ray.dir);
  vec3 weights = vec3(hit.size - hit.u - hit.v, hit.u, hit.v);
  if (isInside(hit)) return weights / hit.size;
  bool misses_a = weights.x <= min(weights.y, weights.z), misses_b = !misses_a && weights.y <= weights.z;
  vec3 first = misses_a ? t.b : misses_b ? t.c : t.a, second = misses_a ? t.c : misses_b ? t.a : t.b;
  // Across the ray, where only the distance from it is left.
  vec3 from = first - ray.origin, edge = second - first;
  vec3 from_across = from - dot(from, ray.dir) * ray.dir, edge_across = edge - dot(edge, ray.dir) * ray.dir;
  float squared = dot(edge_across, edge_across);
  float s = squared > 0.0 ? clamp(-dot(from_across, edge_across) / squared, 0.0, 1.0) : 0.0;
  return misses_a ? vec3(0.0, 1.0 - s, s) : misses_b ? vec3(s, 0.0, 1.0 - s) : vec3(1.0 - s, s, 0.0);
}

struct Surface {
  InstanceRecord instance;
  uint instance_index;
  uint triangle;     // of the mesh
  Triangle corners;  // world
  float u;           // weights of the second and third corner
  float v;
  vec3 position;         // world
  float position_error;  // across the surface, m
  vec3 geometric;        // unit, out of the solid
  vec3 shading;          // unit, of the vertices' normals; textures not yet
};

/// @param u, v  weights of the second and third corner
Surface surfaceAt(uint instance_index, uint triangle, InstanceRecord instance, TriangleRecord record, Triangle corners,
                  float u, float v) {
  Surface s;
  s.instance = instance;
  s.instance_index = instance_index;
  s.triangle = triangle;
  s.corners = corners;
  s.u = u;
  s.v = v;
  s.position = corners.a + u * (corners.b - corners.a) + v * (corners.c - corners.a);
  vec3 area = areaNormal(instance, corners);
  float squared_area = dot(area, area);
  s.geometric = squared_area > 0.0 ? area * inversesqrt(squared_area) : vec3(0.0, 0.0, 1.0);
  s.position_error = boundPositionError(corners, s.geometric);
  vec3 interpolated = (1.0 - u - v) * unpackUnitVector(record.normal_a) + u * unpackUnitVector(record.normal_b) +
                      v * unpackUnitVector(record.normal_c);
  interpolated = normalToWorld(instance, interpolated);
  float squared = dot(interpolated, interpolated);
  if (squared > 0.0) interpolated *= inversesqrt(squared);
  bool smooth_shaded = (instance.flags & kInstanceHasNormals) != 0u && dot(interpolated, s.geometric) > 0.0;
  s.shading = smooth_shaded ? interpolated : s.geometric;
  return s;
}

/// Turns both normals to the side that a ray along `dir` comes from.
/// @return  whether that is the outer side
bool turnTo(inout Surface s, vec3 dir) {
  bool front = dot(dir, s.geometric) < 0.0;
  if (!front) {
    s.geometric = -s.geometric;
    s.shading = -s.shading;
  }
  // Near a silhouette the interpolated normal may look away from the eye: the true one cannot.
  if (dot(s.shading, -dir) <= 1e-4) s.shading = s.geometric;
  return front;
}

/// Where a ray of the camera meets the triangle that its pixel shows.
Surface surfaceSeen(Ray ray, uint instance_index, uint triangle) {
  InstanceRecord instance = fetchInstance(instance_index);
  TriangleRecord record = fetchTriangle(instance.first_triangle + triangle);
  Triangle corners = toWorld(instance, record);
  vec3 weights = weightsOn(corners, ray);
  return surfaceAt(instance_index, triangle, instance, record, corners, weights.y, weights.z);
}

#endif
