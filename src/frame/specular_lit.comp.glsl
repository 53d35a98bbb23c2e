// Shows what a chain ends on in all pixels of the cells whose corners agree on it: the place on its triangle, or the
// direction, and the weight lie between those of the corners. What the surface looks like there is asked in each pixel.
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#extension GL_EXT_control_flow_attributes : require
#define NEPHROID_LIGHT_BINDINGS 7
#include "frame/lights.glsl"
#include "frame/specular_push.glsl"
#define NEPHROID_GRID_BINDINGS 11
#include "frame/specular_grid.glsl"
#define NEPHROID_ENDS_BINDING 13
#include "frame/specular_ends.glsl"
#include "frame/specular_others.glsl"
#define NEPHROID_SKY_BINDINGS 14
#include "frame/sky.glsl"
#define NEPHROID_RECEIVER_BINDINGS 17
#include "frame/receiver_map.glsl"

layout(local_size_x = 64) in;
layout(set = 0, binding = 16, rgba32f) uniform image2D specular_image;  // sum over samples, W/m²/sr

/// The triangle that a cell's chain ends on.
struct LitTriangle {
  Surface surface;  // at its first corner, its normals as they are
  TriangleRecord record;
  MaterialRecord material;
  float ior_from;
  vec3 to_u;  // from what a place is off the first corner to the weights of the second and third
  vec3 to_v;
};

/// What lies between the corners of a cell.
struct CellEnd {
  bool is_sky;
  Bilinear place;
  Bilinear weight;
  Bilinear dir;
};

vec4 dirAt(uvec2 point) { return vec4(unpackUnitVector(fetchEndSurface(point, chain).z), 0.0); }

CellEnd fetchCellEnd(uvec2 cell) {
  uvec2 right = cell + uvec2(1u, 0u), below = cell + uvec2(0u, 1u), opposite = cell + 1u;
  CellEnd e;
  e.is_sky = kSceneHasEnvironment && fetchEndSurface(cell, chain).x == kNowhere;
  e.place = bilinearOf(uintBitsToFloat(fetchEndPlace(cell, chain)), uintBitsToFloat(fetchEndPlace(right, chain)),
                       uintBitsToFloat(fetchEndPlace(below, chain)), uintBitsToFloat(fetchEndPlace(opposite, chain)));
  e.weight = bilinearOf(fetchEndWeight(cell, chain), fetchEndWeight(right, chain), fetchEndWeight(below, chain),
                        fetchEndWeight(opposite, chain));
  vec4 dir = dirAt(cell);
  e.dir = Bilinear(dir, vec4(0.0), vec4(0.0), vec4(0.0));
  if (kSceneHasMetal || kSceneHasGloss) e.dir = bilinearOf(dir, dirAt(right), dirAt(below), dirAt(opposite));
  return e;
}

LitTriangle fetchLitTriangle(uvec4 end) {
  uint instance = end.x == kNowhere ? 0u : end.x, triangle = end.x == kNowhere ? 0u : end.y;
  LitTriangle lit;
  InstanceRecord placed = fetchInstance(instance);
  lit.record = fetchTriangle(placed.first_triangle + triangle);
  lit.surface = surfaceAt(instance, triangle, placed, lit.record, toWorld(placed, lit.record), 0.0, 0.0);
  lit.material = fetchMaterial(placed.material);
  lit.ior_from = uintBitsToFloat(end.w);
  vec3 e1 = lit.surface.corners.b - lit.surface.corners.a, e2 = lit.surface.corners.c - lit.surface.corners.a;
  vec3 u = cross(e2, lit.surface.geometric), v = cross(lit.surface.geometric, e1);
  float area = dot(e1, u);
  float inverse = area != 0.0 ? 1.0 / area : 0.0;
  lit.to_u = u * inverse;
  lit.to_v = v * inverse;
  return lit;
}

Surface surfaceOf(LitTriangle lit, vec3 place) {
  Surface s = lit.surface;
  vec3 off = place - s.corners.a;
  s.position = place;
  s.u = dot(off, lit.to_u);
  s.v = dot(off, lit.to_v);
  if ((s.instance.flags & kInstanceHasNormals) == 0u) return s;
  vec3 normal = (1.0 - s.u - s.v) * unpackUnitVector(lit.record.normal_a) + s.u * unpackUnitVector(lit.record.normal_b) +
                s.v * unpackUnitVector(lit.record.normal_c);
  normal = normalToWorld(s.instance, normal);
  float squared = dot(normal, normal);
  normal *= squared > 0.0 ? inversesqrt(squared) : 0.0;
  s.shading = dot(normal, s.geometric) > 0.0 ? normal : s.geometric;
  return s;
}

/// What a surface sends back along the ray that meets it.
/// @param weight  times which the pixel shows it
vec3 radianceOf(LitTriangle lit, vec3 place, vec3 dir, uvec2 pixel, vec3 weight) {
  Surface s = surfaceOf(lit, place);
  Coordinates at = Coordinates(vec2[2](vec2(0.0), vec2(0.0)), vec4(1.0));
  if (kSceneHasTextures) {
    at = coordinatesAt(s.instance, s.triangle, s.u, s.v);
    s.shading = perturbedNormal(s);
  }
  MaterialPoint m = resolveMaterial(lit.material, at);
  m.optics.ior_from = lit.ior_from;
  bool front = dot(dir, s.geometric) < 0.0;
  vec3 radiance = kSceneEmits && (front || m.double_sided) ? m.emission : vec3(0.0);
  if (!front) {
    s.geometric = -s.geometric;
    s.shading = -s.shading;
  }
  // Near a silhouette the interpolated normal may look away from the path: the true one cannot.
  if (dot(s.shading, -dir) <= 1e-4) s.shading = s.geometric;
  vec3 caustic = causticFrom(s, m, -dir, push.specular_alpha);
  addToSpecularCaustic(ivec2(pixel), weight * caustic);
  return radiance + caustic + lightFromAll(push.light_count, s, m, -dir, push.specular_alpha);
}

void showCell(uvec2 cell) {
  Cell pixels = cellAt(cell);
  CellEnd e = fetchCellEnd(cell);
  LitTriangle lit = fetchLitTriangle(fetchEndSurface(cell, chain));
  vec2 inverse_size = 1.0 / vec2(pixels.last - pixels.first);
  uvec2 pixel = pixels.first;
  do {
    vec2 at = vec2(pixel - pixels.first) * inverse_size;
    vec3 place = valueAt(e.place, at).xyz;
    vec4 weight = valueAt(e.weight, at);
    // In the other pixels another chain is shown.
    if (drawOther(pixel, push.frame, chain) < weight.w) weight = vec4(0.0);
    vec3 radiance = vec3(0.0);
    if (e.is_sky) {
      radiance = environmentFrom(normalize(place));
    } else {
      vec3 dir = valueAt(e.dir, at).xyz;
      if (kSceneHasMetal || kSceneHasGloss) dir = normalize(dir);
      radiance = radianceOf(lit, place, dir, pixel, weight.xyz);
    }
    imageStore(specular_image, ivec2(pixel), imageLoad(specular_image, ivec2(pixel)) + vec4(weight.xyz * radiance, 0.0));
  } while (nextPixel(pixels, pixel));
}

void main() {
  uint first = firstOf(kLitCells + chain), count = heads[kLitCells + chain].count, i = firstListed();
  if (i >= count) return;
  do {
    showCell(unpackPlace(listed[first + i]));
    i += listedThreads();
  } while (i < count);
}
