// What a pixel shows of the light that comes straight to it: `direct` and `emission`, added to their sums.
#ifndef NEPHROID_SHADE_GLSL
#define NEPHROID_SHADE_GLSL

#define NEPHROID_LIGHT_BINDINGS 7
#include "frame/lights.glsl"
#include "frame/passable.glsl"
#include "frame/sample_push.shared.h"
#include "frame/triangle_surface.glsl"

layout(scalar, set = 0, binding = 11) uniform Views { ViewRecord views[1]; };
layout(set = 0, binding = 12, rg32ui) readonly uniform uimage2D seen_image;
layout(set = 0, binding = 13) uniform sampler2D tint_image;  // of what lies before what is shown
layout(set = 0, binding = 16, rgba32f) uniform image2D direct_image;    // sum over samples, W/m²/sr
layout(set = 0, binding = 17, rgba32f) uniform image2D emission_image;  // likewise

layout(push_constant, scalar) uniform Push { SamplePush push; };

#define NEPHROID_SKY_BINDINGS 14
#include "frame/sky.glsl"

/// Blocks of pixels that are lit together if they see one triangle.
const uvec2 kBlock = uvec2(4u, 4u);

struct ListHead {
  uint groups_x;  // of the pass that goes through the list
  uint groups_y;
  uint groups_z;
  uint count;
};

// Lists of blocks.
const uint kMixedBlocks = 0u;     // whose pixels are lit one by one, by shade.comp.glsl
const uint kShadowedBlocks = 1u;  // that may be shadowed, by shade_blocks.comp.glsl

layout(scalar, set = 0, binding = 18) buffer Lists { ListHead heads[2]; uint listed[]; };

uvec2 blockCount() { return (uvec2(imageSize(direct_image)) + kBlock - 1u) / kBlock; }
uint firstOf(uint list) { return list * blockCount().x * blockCount().y; }

/// So many blocks of a list are lit by a group, and so many groups are in a row of its dispatch.
uint groupBlocks(uint list) { return list == kMixedBlocks ? 64u / (kBlock.x * kBlock.y) : 64u; }
const uint kMostGroups = 32768u;

uint groupIndex() { return gl_WorkGroupID.y * gl_NumWorkGroups.x + gl_WorkGroupID.x; }

void addToList(uint list, uvec2 block) {
  uint number = atomicAdd(heads[list].count, 1u);
  listed[firstOf(list) + number] = block.x | (block.y << 16);
  if (number % groupBlocks(list) != 0u) return;
  uint group = number / groupBlocks(list);
  atomicMax(heads[list].groups_x, min(group + 1u, kMostGroups));
  atomicMax(heads[list].groups_y, group / kMostGroups + 1u);
}

uvec2 fetchListed(uint list, uint number) {
  uint block = listed[firstOf(list) + number];
  return uvec2(block & 0xFFFFu, block >> 16);
}

struct Shaded {
  vec3 direct;
  vec3 emission;
};

/// Of a pixel, in [-1, 1]².
vec2 filmOf(uvec2 pixel) { return (vec2(pixel) + push.film_offset) / vec2(imageSize(direct_image)) * 2.0 - 1.0; }

/// Does a surface send out any of the light that it receives, by a lobe of class D?
bool receives(MaterialPoint m) {
  return m.base_weight > 0.0 || (m.optics.alpha >= push.specular_alpha && (kSceneHasMetal || kSceneHasGloss));
}

/// Adds what a pixel shows to the sums.
/// @param t  where its ray meets that; kFarAway: nowhere
void add(Shaded shaded, Ray ray, float t, ivec2 pixel) {
  if (kSceneHasLamps) shaded.emission += lampsSeen(ray, t);
  if (kSceneHasPassable) {
    vec3 tint = texelFetch(tint_image, pixel, 0).xyz;
    shaded.direct *= tint;
    shaded.emission *= tint;
  }
  if (shaded.direct != vec3(0.0))
    imageStore(direct_image, pixel, imageLoad(direct_image, pixel) + vec4(shaded.direct, 0.0));
  if ((kSceneHasEnvironment || kSceneHasLamps || kSceneEmits) && shaded.emission != vec3(0.0))
    imageStore(emission_image, pixel, imageLoad(emission_image, pixel) + vec4(shaded.emission, 0.0));
}

#endif
