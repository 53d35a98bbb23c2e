// One frame's sample of each pixel, or of those in the blocks that shade_blocks.comp.glsl has left.
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#extension GL_EXT_control_flow_attributes : require
#include "frame/shade.glsl"

layout(local_size_x = 64) in;
layout(constant_id = 17) const bool kOfMixedBlocks = false;

Shaded shade(Surface s, MaterialPoint m, Ray ray, uvec2 pixel) {
  if (kSceneHasTextures) s.shading = perturbedNormal(s);
  float weight = kSceneHasPassable ? passageAt(s, m, ray.dir, pixel, push.frame).weight : 1.0;
  bool front = turnTo(s, ray.dir);
  Shaded result = Shaded(vec3(0.0), vec3(0.0));
  if (kSceneEmits && (front || m.double_sided)) result.emission = weight * m.emission;
  if (receives(m)) result.direct = weight * lightFromAll(push.light_count, s, m, -ray.dir, push.specular_alpha);
  return result;
}

void shadePixel(uvec2 pixel) {
  Ray ray = rayThrough(views[0], filmOf(pixel));
  uvec2 seen = imageLoad(seen_image, ivec2(pixel)).xy;
  Shaded shaded = Shaded(vec3(0.0), vec3(0.0));
  float t = kFarAway;
  if (seen.x != 0u) {
    Surface s = surfaceSeen(ray, seen.x - 1u, seen.y);
    t = dot(s.position - ray.origin, ray.dir);
    shaded = shade(s, materialAt(s.instance, s.triangle, s.u, s.v), ray, pixel);
  } else if (kSceneHasEnvironment) {
    shaded.emission = environmentFrom(ray.dir);
  }
  add(shaded, ray, t, ivec2(pixel));
}

void main() {
  fetchFewLights();
  uint i = gl_LocalInvocationID.x;
  uvec2 pixel = gl_WorkGroupID.xy * 8u + uvec2(i % 8u, i / 8u);
  if (kOfMixedBlocks) {
    uint number = groupIndex() * groupBlocks(kMixedBlocks) + i / (kBlock.x * kBlock.y), k = i % (kBlock.x * kBlock.y);
    if (number >= heads[kMixedBlocks].count) return;
    pixel = fetchListed(kMixedBlocks, number) * kBlock + uvec2(k % kBlock.x, k / kBlock.x);
  }
  if (any(greaterThanEqual(ivec2(pixel), imageSize(direct_image)))) return;
  shadePixel(pixel);
}
