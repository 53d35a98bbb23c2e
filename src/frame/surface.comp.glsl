// From the triangle that a pixel sees to the surface there: the g-buffer.
//
// The point is where the pixel's ray meets the triangle, not what the rasteriser interpolated: the same arithmetic as
// a ray tracer's, so that both agree to rounding.
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#include "frame/scene_access.glsl"

layout(local_size_x = 8, local_size_y = 8) in;
layout(scalar, set = 0, binding = 5) readonly buffer Views { ViewRecord views[]; };
layout(set = 0, binding = 6) uniform usampler2D seen_image;
layout(set = 0, binding = 7, rgba32f) writeonly uniform image2D position_image;  // xyz, error across the surface
layout(set = 0, binding = 8, rgba32ui) writeonly uniform uimage2D surface_image;  // instance + 1, triangle, normals

layout(push_constant, scalar) uniform Push {
  vec2 film_offset;  // of the sample in the pixel, in [0, 1)
};

/// The point of a triangle that is nearest to a ray which misses it. The rasteriser rounds corners to a fraction of a
/// pixel, so it may show what the ray just passes by; at grazing angles the plane is met far from there.
RayTriangle nearestToRay(Triangle t, Ray ray) {
  vec3 corners[3] = vec3[3](t.a, t.b, t.c);
  RayTriangle best = RayTriangle(0.0, 0.0, 0.0, true);
  float least = 3.4e38;
  for (int k = 0; k < 3; ++k) {
    // Across the ray, where only distance from it is left.
    vec3 from = corners[k] - ray.origin, edge = corners[(k + 1) % 3] - corners[k];
    vec3 from_across = from - dot(from, ray.dir) * ray.dir, edge_across = edge - dot(edge, ray.dir) * ray.dir;
    float squared = dot(edge_across, edge_across);
    float s = squared > 0.0 ? clamp(-dot(from_across, edge_across) / squared, 0.0, 1.0) : 0.0;
    vec3 off = from_across + s * edge_across;
    if (dot(off, off) >= least) continue;
    least = dot(off, off);
    vec3 weights = k == 0 ? vec3(1.0 - s, s, 0.0) : k == 1 ? vec3(0.0, 1.0 - s, s) : vec3(s, 0.0, 1.0 - s);
    best.u = weights.y;
    best.v = weights.z;
  }
  return best;
}

void main() {
  ivec2 pixel = ivec2(gl_GlobalInvocationID.xy);
  ivec2 size = imageSize(position_image);
  if (pixel.x >= size.x || pixel.y >= size.y) return;
  uvec2 seen = texelFetch(seen_image, pixel, 0).xy;
  if (seen.x == 0u) {
    imageStore(surface_image, pixel, uvec4(0u));
    imageStore(position_image, pixel, vec4(0.0));
    return;
  }
  Ray ray = rayThrough(views[0], (vec2(pixel) + film_offset) / vec2(size) * 2.0 - 1.0);

  InstanceRecord instance = instances[seen.x - 1u];
  uvec3 vertices = triangleVertices(instance, seen.y);
  Triangle triangle = fetchTriangle(instance, vertices);
  RayTriangle hit = intersectPlaneOf(triangle, ray.origin, ray.dir);
  if (!isInside(hit)) hit = nearestToRay(triangle, ray);
  float u = hit.u, v = hit.v;
  vec3 position = triangle.a + u * (triangle.b - triangle.a) + v * (triangle.c - triangle.a);
  vec3 area = areaNormal(instance, triangle);
  float doubled_area = length(area);
  vec3 geometric = doubled_area > 0.0 ? area / doubled_area : -ray.dir;
  vec3 shading = geometric;
  if ((instance.flags & kInstanceHasNormals) != 0u) {
    vec3 interpolated = (1.0 - u - v) * normals[vertices.x] + u * normals[vertices.y] + v * normals[vertices.z];
    interpolated = normalToWorld(instance, interpolated);
    float squared = dot(interpolated, interpolated);
    if (squared > 0.0) interpolated *= inversesqrt(squared);
    if (dot(interpolated, geometric) > 0.0) shading = interpolated;
  }
  imageStore(position_image, pixel, vec4(position, boundPositionError(triangle, geometric)));
  imageStore(surface_image, pixel, uvec4(seen.x, seen.y, packUnit(geometric), packUnit(shading)));
}
