// One frame's sample of the pixels of each block that sees one triangle all over; lists the other blocks.
//
// Most of a pixel's time goes into fetching what it sees, and floors and walls are seen by many pixels: here that is
// fetched once a block. Shadows are asked for before anything is lit, of those pixels alone that have something before
// them: a device that runs a loop's body for all threads, or for none, pays for an empty list as for one triangle.
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#extension GL_EXT_control_flow_attributes : require
#include "frame/shade.glsl"
#include "frame/block_shadows.glsl"

layout(local_size_x = 64) in;
layout(constant_id = 17) const bool kOfShadowedBlocks = false;

struct Block {
  uvec2 first;
  uvec2 size;  // pixels of the picture
  uvec2 seen;  // by its first pixel
  bool sees_one_instance;
  bool sees_one_triangle;
};

Block blockAt(uvec2 place, uvec2 picture) {
  Block b;
  b.first = place * kBlock;
  b.size = min(kBlock, picture - b.first);
  b.seen = imageLoad(seen_image, ivec2(b.first)).xy;
  uvec2 differ = uvec2(0u);
  [[unroll]] for (uint y = 0u; y < kBlock.y; ++y)
    [[unroll]] for (uint x = 0u; x < kBlock.x; ++x)
      differ |= imageLoad(seen_image, ivec2(b.first + min(uvec2(x, y), b.size - 1u))).xy ^ b.seen;
  b.sees_one_instance = differ.x == 0u;
  b.sees_one_triangle = b.sees_one_instance && differ.y == 0u;
  return b;
}

/// How a block sees a triangle. The weights of the second and third corner and what both are divided by are linear over
/// the pixels: dot(plane, vec3(x, y, 1)), in pixels from the block's first.
struct Sight {
  vec3 u;
  vec3 v;
  vec3 size;
};

/// Weights of the second and third corner times the third number, of intersectPlaneOf for a direction of any length.
vec3 weightsTimesSize(Triangle t, Ray ray) {
  vec3 e1 = t.b - t.a, e2 = t.c - t.a, p = cross(ray.dir, e2), s = ray.origin - t.a;
  return vec3(dot(s, p), dot(ray.dir, cross(s, e1)), dot(e1, p));
}

Sight sightOf(Triangle t, uvec2 first) {
  vec3 at = weightsTimesSize(t, linearRayThrough(views[0], filmOf(first)));
  // From pixels that are far apart: the differences of near ones have few digits.
  const float step = 4.0;
  vec3 per_x = (weightsTimesSize(t, linearRayThrough(views[0], filmOf(first + uvec2(4u, 0u)))) - at) / step;
  vec3 per_y = (weightsTimesSize(t, linearRayThrough(views[0], filmOf(first + uvec2(0u, 4u)))) - at) / step;
  float turn = at.z < 0.0 ? -1.0 : 1.0;
  return Sight(turn * vec3(per_x.x, per_y.x, at.x), turn * vec3(per_x.y, per_y.y, at.y),
               turn * vec3(per_x.z, per_y.z, at.z));
}

/// Do the block's corners, and so all of its pixels, meet the triangle? A rasteriser rounds: it may show what is just
/// missed.
bool meetsAll(Sight sight, Block block) {
  bool met = true;
  [[unroll]] for (uint corner = 0u; corner < 4u; ++corner) {
    vec3 at = vec3(vec2(uvec2(corner & 1u, corner >> 1) * (block.size - 1u)), 1.0);
    float u = dot(sight.u, at), v = dot(sight.v, at), size = dot(sight.size, at);
    met = met && size > 0.0 && u >= 0.0 && v >= 0.0 && u + v <= size;
  }
  return met;
}

/// A pixel's ray and the surface that it meets, both normals on the ray's side.
struct Seen {
  uvec2 pixel;
  Ray ray;
  Surface surface;
  bool front;
};

uvec2 offOf(uint k) { return uvec2(k % kBlock.x, k / kBlock.x); }

/// Weights of the second and third corner where a pixel of the block meets the triangle.
vec2 weightsOf(Sight sight, uint k) {
  vec3 at = vec3(vec2(offOf(k)), 1.0);
  return vec2(dot(sight.u, at), dot(sight.v, at)) / dot(sight.size, at);
}

vec3 placeOn(Triangle t, vec2 weights) { return t.a + weights.x * (t.b - t.a) + weights.y * (t.c - t.a); }

Seen seenAt(Block block, TriangleSurface triangle, Sight sight, uint k) {
  vec2 weights = weightsOf(sight, k);
  Seen seen;
  seen.pixel = block.first + offOf(k);
  seen.ray = rayThrough(views[0], filmOf(seen.pixel));
  seen.surface = surfaceOn(triangle, placeOn(triangle.surface.corners, weights), weights.x, weights.y);
  if (kSceneHasTextures) seen.surface.shading = perturbedNormal(seen.surface);
  seen.front = turnTo(seen.surface, seen.ray.dir);
  return seen;
}

/// The pixels of a block that it has, a bit each.
uint pixelsOf(Block block) {
  uint row = (1u << block.size.x) - 1u, pixels = 0u;
  [[unroll]] for (uint y = 0u; y < kBlock.y; ++y) pixels |= y < block.size.y ? row << (y * kBlock.x) : 0u;
  return pixels;
}

/// Which of the pixels a light would reach but for what lies before them, or may lie there.
struct Shadows {
  uint doubtful;
  uint shadowed;  // of kShadowedBlocks alone
};

Shadows findShadows(uint light_index, LightRecord light, Block block, TriangleSurface triangle, Sight sight) {
  BlockPoints points;
  uint reached = 0u;
  // The eye is on one side of the triangle's plane.
  vec3 normal = triangle.surface.geometric;
  if (dot(rayThrough(views[0], filmOf(block.first)).dir, normal) >= 0.0) normal = -normal;
  // No more than shadows need: what is done here is compiled once for each point.
  [[unroll]] for (uint k = 0u; k < kBlockPoints; ++k) {
    vec3 place = placeOn(triangle.surface.corners, weightsOf(sight, k));
    points.starts[k] = place + triangle.surface.position_error * normal;
    points.cells[k] = cellOnGrid(light, place);
    if (points.cells[k] != kNowhere && mayReach(light, normal, arriveFrom(light, place))) reached |= 1u << k;
  }
  Shadows shadows = Shadows(findDoubtful(light_index, light, points, reached & pixelsOf(block)), 0u);
  if (kOfShadowedBlocks)
    shadows.shadowed = findShadowed(light_index, light, triangle.surface.instance_index, triangle.surface.triangle,
                                    points, shadows.doubtful);
  return shadows;
}

/// What a pixel shows. @param shadowed  by light, whether it lies in its shadow
Shaded shade(Seen seen, MaterialPoint m, bool shadowed[2]) {
  Shaded result = Shaded(vec3(0.0), vec3(0.0));
  if (kSceneEmits && (seen.front || m.double_sided)) result.emission = m.emission;
  if (!receives(m)) return result;
  [[unroll]] for (uint i = 0u; i < kFewLights; ++i) {
    Arriving arriving = arriveFrom(lights[i], seen.surface.position);
    if (isReached(lights[i], seen.surface, arriving) && !shadowed[i])
      result.direct += radianceUnshadowed(seen.surface, m, -seen.ray.dir, arriving, push.specular_alpha);
  }
  return result;
}

/// @return  false: it may be shadowed, and nothing was done
bool shadeBlock(Block block, TriangleSurface triangle, Sight sight) {
  uint shadowed[2] = uint[2](0u, 0u), doubtful = 0u;
  [[unroll]] for (uint i = 0u; i < kFewLights; ++i) {
    Shadows shadows = findShadows(i, lights[i], block, triangle, sight);
    doubtful |= shadows.doubtful;
    shadowed[i] = shadows.shadowed;
  }
  if (!kOfShadowedBlocks && doubtful != 0u) return false;
  MaterialPoint m = materialOn(triangle, 0.0, 0.0);
  uint pixels = pixelsOf(block);
  do {
    uint k = uint(findLSB(pixels));
    Seen seen = seenAt(block, triangle, sight, k);
    if (kSceneHasTextures) m = materialOn(triangle, seen.surface.u, seen.surface.v);
    float t = dot(seen.surface.position - seen.ray.origin, seen.ray.dir);
    bool of_pixel[2] = bool[2]((shadowed[0] >> k & 1u) != 0u, (shadowed[1] >> k & 1u) != 0u);
    add(shade(seen, m, of_pixel), seen.ray, t, ivec2(seen.pixel));
    pixels &= pixels - 1u;
  } while (pixels != 0u);
  return true;
}

/// Of all blocks: lights those that see one triangle and that nothing may shadow, lists the others.
void shadeOrList(uvec2 place, uvec2 picture) {
  Block block = blockAt(place, picture);
  bool sees = block.seen.x != 0u;
  TriangleSurface triangle = fetchTriangleSurface(sees ? block.seen.x - 1u : 0u, sees ? block.seen.y : 0u);
  // Mirrors, glass and the dark have nothing to show here.
  bool shows = sees ? (triangle.surface.instance.flags & kInstanceIsLit) != 0u : kSceneHasEnvironment;
  if (block.sees_one_instance && !shows && !kSceneHasLamps) return;
  Sight sight = sightOf(triangle.surface.corners, block.first);
  if (!sees || !block.sees_one_triangle || !meetsAll(sight, block)) {
    addToList(kMixedBlocks, place);
    return;
  }
  if (!shadeBlock(block, triangle, sight)) addToList(kShadowedBlocks, place);
}

void main() {
  fetchFewLights();
  uvec2 picture = uvec2(imageSize(direct_image));
  if (kOfShadowedBlocks) {
    uint number = groupIndex() * groupBlocks(kShadowedBlocks) + gl_LocalInvocationID.x;
    if (number >= heads[kShadowedBlocks].count) return;
    Block block = blockAt(fetchListed(kShadowedBlocks, number), picture);
    TriangleSurface triangle = fetchTriangleSurface(block.seen.x - 1u, block.seen.y);
    shadeBlock(block, triangle, sightOf(triangle.surface.corners, block.first));
  } else {
    uvec2 place = 8u * gl_WorkGroupID.xy + uvec2(gl_LocalInvocationID.x % 8u, gl_LocalInvocationID.x / 8u);
    if (all(lessThan(place * kBlock, picture))) shadeOrList(place, picture);
  }
}
