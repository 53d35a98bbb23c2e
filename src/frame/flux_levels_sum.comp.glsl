// Adds a level of flux to the next finer one: one thread a texel of the latter.
//
// A texel gets what a tent over the four coarser ones about it gives. Of those that do not show the same surface as its
// own one, the latter has the share: what two texels give each other's is the same part of what they have.
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#include "frame/flux_levels.glsl"
#include "core/optics/photon.shared.h"

layout(local_size_x = 8, local_size_y = 8) in;
layout(set = 0, binding = 0, r32i) uniform iimage2DArray level_flux;
layout(set = 0, binding = 1, r32ui) readonly uniform uimage2DArray level_links;
layout(set = 0, binding = 2, r32i) uniform iimage2DArray flux_image;
layout(set = 0, binding = 3, r32ui) writeonly uniform uimage2DArray tile_image;
layout(constant_id = 0) const uint kChannels = kFluxChannels;
layout(push_constant, scalar) uniform Push { FluxLevelsPush push; };

uint linksOf(ivec2 place, int picture) { return imageLoad(level_links, ivec3(place, picture)).x; }
float fluxOf(ivec2 place, int layer) { return float(imageLoad(level_flux, ivec3(place, layer)).x); }

void main() {
  ivec2 at = ivec2(gl_GlobalInvocationID.xy);
  int picture = int(gl_GlobalInvocationID.z);
  uint below = push.level - 1u;
  ivec2 padded = paddedSize(uvec2(push.width, push.height), push.level_count), size = padded >> push.level;
  ivec2 end = below == 0u ? ivec2(push.width, push.height) : padded >> below;
  if (any(greaterThanEqual(at, end))) return;
  ivec2 origin = levelOrigin(padded, push.level), side = 2 * (at & 1) - 1, own = at >> 1;
  ivec2 beside = clamp(own + side, ivec2(0), size - 1);
  // The four, on both axes from the one before to the one after.
  ivec2 first = min(own, beside), last = max(own, beside);
  uint links = linksOf(origin + first, picture), links_x = linksOf(origin + ivec2(last.x, first.y), picture);
  uint links_y = linksOf(origin + ivec2(first.x, last.y), picture);
  bool across = ((own.y == first.y ? links : links_y) & kLinkAcross) != 0u && beside.x != own.x;
  bool down = ((own.x == first.x ? links : links_x) & kLinkDown) != 0u && beside.y != own.y;
  bool all_same = across && down && (links & links_y & kLinkAcross) != 0u && (links & links_x & kLinkDown) != 0u;
  float share_across = across ? 0.1875 : 0.0, share_down = down ? 0.1875 : 0.0, share_both = all_same ? 0.0625 : 0.0;
  float share_own = 1.0 - share_across - share_down - share_both;
  float sum[2u * kFluxChannels];
  for (uint c = 0u; c < kChannels; ++c) {
    int layer = picture * int(kChannels) + int(c);
    // A quarter: for each of the four below.
    sum[c] = 0.25 * (share_own * fluxOf(origin + own, layer) +
                     share_across * fluxOf(origin + ivec2(beside.x, own.y), layer) +
                     share_down * fluxOf(origin + ivec2(own.x, beside.y), layer) +
                     share_both * fluxOf(origin + beside, layer));
  }
  uint random = mixBits(uint(at.x) + (uint(at.y) << 12) + push.level * 0x9e3779b1u);
  bool any_flux = false;
  for (uint c = 0u; c < kChannels; ++c) {
    int steps = int(floor(sum[c] + float((c < 3u ? random : mixBits(random + c)) >> 8) * (1.0 / 16777216.0)));
    if (steps == 0) continue;
    any_flux = true;
    int layer = picture * int(kChannels) + int(c);
    if (below == 0u) {
      ivec3 place = ivec3(at, layer);
      imageStore(flux_image, place, ivec4(imageLoad(flux_image, place).x + steps));
    } else {
      ivec3 place = ivec3(levelOrigin(padded, below) + at, layer);
      imageStore(level_flux, place, ivec4(imageLoad(level_flux, place).x + steps));
    }
  }
  if (any_flux && below == 0u) imageStore(tile_image, ivec3(at / int(kDepositTile), picture), uvec4(1u));
}
