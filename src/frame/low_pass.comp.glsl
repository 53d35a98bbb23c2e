// A Gaussian over a map of flux, along one axis: each texel's flux is spread over its neighbours that show the same
// surface. ([shah-caustics-mapping] §III-F.)
//
// The weights of those neighbours add up to one, at the picture's border and beside edges too, and whole numbers are
// shared out without a rest: so the flux of each surface stays what it is, to the last step.
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#extension GL_EXT_control_flow_attributes : require
#include "frame/deposit.shared.h"
#include "frame/frame.shared.h"
#include "frame/low_pass.shared.h"

layout(local_size_x = 8, local_size_y = 8) in;
layout(scalar, set = 0, binding = 0) uniform Views { ViewRecord views[kMostViews]; };
layout(constant_id = 0) const uint kViewCount = 1u;
#include "frame/texel_surface.glsl"
layout(set = 0, binding = 1, rgba32f) readonly uniform image2DArray surfaces;
layout(set = 0, binding = 2, r32i) readonly uniform iimage2DArray from_image;
layout(set = 0, binding = 3, r32i) uniform iimage2DArray to_image;
layout(set = 0, binding = 4, r32ui) uniform uimage2DArray tile_image;

layout(constant_id = 1) const uint kChannels = kFluxChannels;

layout(push_constant, scalar) uniform Push { LowPassPush push; };

/// Least cosine between the normals of neighbours on the same surface.
const float kSameNormal = 0.5;
/// Texels that a surface may bend away from its plane for each texel of the way.
const float kBend = 0.25;

TexelSurface fetchSurface(ivec2 texel, uint view) {
  return describeTexel(imageLoad(surfaces, ivec3(texel, view * push.layer_count)));
}

ivec2 stepAlong(int steps) { return push.axis == 0u ? ivec2(steps, 0) : ivec2(0, steps); }

/// What a texel so many steps away gets of one's flux, before the weights are made to add up to one.
float weightOf(ivec2 texel, uint view, int steps, TexelSurface own, float texel_size) {
  ivec2 at = texel + stepAlong(steps);
  if (any(lessThan(at, ivec2(0))) || at.x >= int(push.width) || at.y >= int(push.height)) return 0.0;
  float off = float(steps) / push.deviation;
  if (steps == 0) return 1.0;
  TexelSurface other = fetchSurface(at, view);
  float reach = texel_size * (1.0 + kBend * abs(float(steps)));
  bool is_same = liesOn(other, own.position, reach) && dot(other.lit_normal, own.lit_normal) >= kSameNormal;
  return is_same ? exp(-0.5 * off * off) : 0.0;
}

void main() {
  ivec2 texel = ivec2(gl_GlobalInvocationID.xy);
  uint view = gl_GlobalInvocationID.z;
  if (texel.x >= int(push.width) || texel.y >= int(push.height)) return;
  if (imageLoad(tile_image, ivec3(texel / int(kDepositTile), view)).x == 0u) return;
  int first_layer = int(view * kChannels);
  int flux[2u * kFluxChannels], given[2u * kFluxChannels];
  bool any_flux = false;
  for (uint c = 0u; c < kChannels; ++c) {
    flux[c] = imageLoad(from_image, ivec3(texel, first_layer + int(c))).x;
    given[c] = 0;
    any_flux = any_flux || flux[c] != 0;
  }
  if (!any_flux) return;
  TexelSurface own = fetchSurface(texel, view);
  float texel_size = texelSize(dot(projectionOf(view).w, vec4(own.position, 1.0)), vec2(push.width, push.height));
  float sum = 0.0;
  int last = 0;
  for (int steps = -push.reach; steps <= push.reach; ++steps) {
    float weight = weightOf(texel, view, steps, own, texel_size);
    sum += weight;
    if (weight > 0.0) last = steps;
  }
  float before = 0.0;
  for (int steps = -push.reach; steps <= last; ++steps) {
    float weight = weightOf(texel, view, steps, own, texel_size);
    if (weight <= 0.0) continue;
    before += weight;
    ivec2 at = texel + stepAlong(steps);
    for (uint c = 0u; c < kChannels; ++c) {
      // Up to here; the last one gets what is left.
      int upto = steps == last ? flux[c] : int(floor(float(flux[c]) * (before / sum)));
      imageAtomicAdd(to_image, ivec3(at, first_layer + int(c)), upto - given[c]);
      given[c] = upto;
    }
    imageStore(tile_image, ivec3(at / int(kDepositTile), view), uvec4(1u));
  }
}
