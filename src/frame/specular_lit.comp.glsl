// Shows what a chain ends on in all pixels of the cells whose corners agree on it: the place on its triangle, or the
// direction, and the weight lie between those of the corners. What the surface looks like there is asked in each pixel.
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#extension GL_EXT_control_flow_attributes : require
#define NEPHROID_LIGHT_BINDINGS 7
#include "frame/block_shadows.glsl"
#include "frame/triangle_surface.glsl"
#include "frame/specular_push.glsl"
#define NEPHROID_GRID_BINDINGS 11
#include "frame/specular_grid.glsl"
#define NEPHROID_ENDS_BINDING 13
#include "frame/specular_ends.glsl"
#include "frame/specular_others.glsl"
#define NEPHROID_SKY_BINDINGS 14
#include "frame/sky.glsl"
#define NEPHROID_RECEIVER_BINDINGS 18
#include "frame/receiver_map.glsl"

layout(local_size_x = 64) in;
layout(set = 0, binding = 17) uniform usamplerBuffer bends;
layout(set = 0, binding = 16, rgba32f) uniform image2D specular_image;  // sum over samples, W/m²/sr

/// The triangle that a cell's chain ends on.
struct LitTriangle {
  TriangleSurface triangle;
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
  vec4 bend_x;  // of place and of the weight's luminance
  vec4 bend_y;
};

/// What bending adds to a value that is interpolated linearly between the corners.
vec4 bentBy(CellEnd e, vec2 at) {
  vec2 share = -0.5 * at * (1.0 - at);
  return share.x * e.bend_x + share.y * e.bend_y;
}

vec3 placeAt(CellEnd e, vec2 at) { return valueAt(e.place, at).xyz + bentBy(e, at).xyz; }

/// Of what is seen; the fourth is what other ways carry.
vec4 weightAt(CellEnd e, vec2 at) {
  vec4 weight = valueAt(e.weight, at);
  float luminance = dot(weight.xyz, vec3(0.2126, 0.7152, 0.0722));
  float bent = luminance + bentBy(e, at).w;
  return vec4(luminance > 0.0 ? weight.xyz * (max(bent, 0.0) / luminance) : weight.xyz, weight.w);
}

vec4 dirAt(uvec2 point) { return vec4(unpackUnitVector(fetchEndSurface(point, chain).z), 0.0); }

CellEnd fetchCellEnd(uvec2 cell) {
  uvec2 right = cell + uvec2(1u, 0u), below = cell + uvec2(0u, 1u), opposite = cell + 1u;
  CellEnd e;
  e.is_sky = kSceneHasEnvironment && fetchEndSurface(cell, chain).x == kNowhere;
  e.place = bilinearOf(uintBitsToFloat(fetchEndPlace(cell, chain)), uintBitsToFloat(fetchEndPlace(right, chain)),
                       uintBitsToFloat(fetchEndPlace(below, chain)), uintBitsToFloat(fetchEndPlace(opposite, chain)));
  e.weight = bilinearOf(fetchEndWeight(cell, chain), fetchEndWeight(right, chain), fetchEndWeight(below, chain),
                        fetchEndWeight(opposite, chain));
  e.bend_x = uintBitsToFloat(texelFetch(bends, texelOfBend(cell, chain, 0u)));
  e.bend_y = uintBitsToFloat(texelFetch(bends, texelOfBend(cell, chain, 1u)));
  vec4 dir = dirAt(cell);
  e.dir = Bilinear(dir, vec4(0.0), vec4(0.0), vec4(0.0));
  if (kSceneHasMetal || kSceneHasGloss) e.dir = bilinearOf(dir, dirAt(right), dirAt(below), dirAt(opposite));
  return e;
}

LitTriangle fetchLitTriangle(uvec4 end) {
  LitTriangle lit;
  lit.triangle = fetchTriangleSurface(end.x == kNowhere ? 0u : end.x, end.x == kNowhere ? 0u : end.y);
  lit.ior_from = uintBitsToFloat(end.w);
  Surface s = lit.triangle.surface;
  vec3 e1 = s.corners.b - s.corners.a, e2 = s.corners.c - s.corners.a;
  vec3 u = cross(e2, s.geometric), v = cross(s.geometric, e1);
  float area = dot(e1, u);
  float inverse = area != 0.0 ? 1.0 / area : 0.0;
  lit.to_u = u * inverse;
  lit.to_v = v * inverse;
  return lit;
}

/// A pixel's end: what is seen there, both normals on the side that it is seen from.
struct Seen {
  Surface surface;
  vec3 dir;  // of the ray that meets it
  bool front;
};

Seen seenAt(CellEnd e, LitTriangle lit, vec2 at) {
  Seen seen;
  seen.dir = valueAt(e.dir, at).xyz;
  if (kSceneHasMetal || kSceneHasGloss) seen.dir = normalize(seen.dir);
  vec3 place = placeAt(e, at), off = place - lit.triangle.surface.corners.a;
  seen.surface = surfaceOn(lit.triangle, place, dot(off, lit.to_u), dot(off, lit.to_v));
  if (kSceneHasTextures) seen.surface.shading = perturbedNormal(seen.surface);
  seen.front = turnTo(seen.surface, seen.dir);
  return seen;
}

/// Some of a cell's pixels, row by row.
struct Pixels {
  uvec2 first;  // of the cell
  uint width;
  vec2 inverse_size;  // to where they lie between the cell's corners
  uint begin;         // counted from the cell's first
  uint count;
};

uvec2 offOf(Pixels pixels, uint k) {
  uint i = pixels.begin + k;
  // A quotient of whole numbers takes a software device as long as a hundred products.
  uint y = uint((float(i) + 0.5) / float(pixels.width));
  return uvec2(i - y * pixels.width, y);
}

vec2 placeInCell(Pixels pixels, uint k) { return vec2(offOf(pixels, k)) * pixels.inverse_size; }

/// Which of the pixels' ends a light would reach but for what lies before them.
uint findShadowedEnds(uint light_index, LightRecord light, CellEnd e, LitTriangle lit, Pixels pixels) {
  BlockPoints points;
  uint reached = 0u;
  Surface s = lit.triangle.surface;
  // No more than shadows need: what is done here is compiled once for each point.
  [[unroll]] for (uint k = 0u; k < kBlockPoints; ++k) {
    vec2 at = placeInCell(pixels, k);
    vec3 place = placeAt(e, at), normal = s.geometric;
    if (dot(valueAt(e.dir, at).xyz, normal) >= 0.0) normal = -normal;
    points.starts[k] = place + s.position_error * normal;
    points.cells[k] = cellOnGrid(light, place);
    bool wanted = !e.is_sky && k < pixels.count && points.cells[k] != kNowhere;
    if (wanted && mayReach(light, normal, arriveFrom(light, place))) reached |= 1u << k;
  }
  return findShadowed(light_index, light, s.instance_index, s.triangle, points,
                      findDoubtful(light_index, light, points, reached));
}

/// What a surface sends back along the ray that meets it.
/// @param shadowed  by light, of few: whether the place lies in its shadow
/// @param weight    times which the pixel shows it
vec3 radianceOf(LitTriangle lit, Seen seen, bool shadowed[2], ivec2 pixel, vec3 weight) {
  Surface s = seen.surface;
  MaterialPoint m = materialOn(lit.triangle, s.u, s.v);
  m.optics.ior_from = lit.ior_from;
  vec3 radiance = kSceneEmits && (seen.front || m.double_sided) ? m.emission : vec3(0.0);
  vec3 caustic = causticFrom(s, m, -seen.dir, push.specular_alpha);
  addToSpecularCaustic(pixel, weight * caustic);
  radiance += caustic;
  if (!kHasBlockShadows) return radiance + lightFromAll(push.light_count, s, m, -seen.dir, push.specular_alpha);
  [[unroll]] for (uint i = 0u; i < kFewLights; ++i) {
    Arriving arriving = arriveFrom(lights[i], s.position);
    if (isReached(lights[i], s, arriving) && !shadowed[i])
      radiance += radianceUnshadowed(s, m, -seen.dir, arriving, push.specular_alpha);
  }
  return radiance;
}

void showPixels(CellEnd e, LitTriangle lit, Pixels pixels) {
  uint shadowed[2] = uint[2](0u, 0u);
  if (kHasBlockShadows) {
    [[unroll]] for (uint i = 0u; i < kFewLights; ++i)
      shadowed[i] = findShadowedEnds(i, lights[i], e, lit, pixels);
  }
  uint k = 0u;
  do {
    ivec2 pixel = ivec2(pixels.first + offOf(pixels, k));
    vec2 at = placeInCell(pixels, k);
    vec4 weight = weightAt(e, at);
    // In the other pixels another chain is shown.
    if (drawOther(uvec2(pixel), push.frame, chain) < weight.w) weight = vec4(0.0);
    vec3 radiance = vec3(0.0);
    if (e.is_sky) {
      radiance = environmentFrom(normalize(placeAt(e, at)));
    } else {
      bool of_pixel[2] = bool[2]((shadowed[0] >> k & 1u) != 0u, (shadowed[1] >> k & 1u) != 0u);
      radiance = radianceOf(lit, seenAt(e, lit, at), of_pixel, pixel, weight.xyz);
    }
    imageStore(specular_image, pixel, imageLoad(specular_image, pixel) + vec4(weight.xyz * radiance, 0.0));
    ++k;
  } while (k < pixels.count);
}

void showCell(uvec2 cell) {
  Cell area = cellAt(cell);
  CellEnd e = fetchCellEnd(cell);
  LitTriangle lit = fetchLitTriangle(fetchEndSurface(cell, chain));
  uvec2 size = area.end - area.first;
  Pixels pixels = Pixels(area.first, size.x, 1.0 / vec2(area.last - area.first), 0u, 0u);
  uint left = size.x * size.y;
  // A cell at the picture's edge has a few more.
  do {
    pixels.begin += pixels.count;
    pixels.count = min(left, kBlockPoints);
    left -= pixels.count;
    showPixels(e, lit, pixels);
  } while (left > 0u);
}

void main() {
  fetchFewLights();
  uint first = firstOf(kLitCells + chain), count = heads[kLitCells + chain].count, i = firstListed();
  if (i >= count) return;
  do {
    showCell(unpackPlace(listed[first + i]));
    i += listedThreads();
  } while (i < count);
}
