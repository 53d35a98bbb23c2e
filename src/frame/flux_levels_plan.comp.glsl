// Whether large cells go to the coarser levels of a map: where they cover little, making the levels ready would cost
// more than all their texels.
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#include "frame/flux_levels.glsl"

layout(local_size_x = 1) in;
layout(scalar, set = 0, binding = 0) readonly buffer Lists { DepositListsHead lists; };
layout(scalar, set = 0, binding = 1) buffer State { FluxLevelsState state; };
layout(push_constant, scalar) uniform Push { FluxLevelsPush push; };

/// Layers of all texels that large cells may cover before levels are used, whose tents soften the outlines of cells.
/// With 8 the profile of a hollow ball was off by 12 % instead of 5 %, whose cells are just large.
const uint kMostExactLayers = 64u;

DepositGroups groupsOver(ivec2 size, bool any) {
  uvec2 groups = any ? uvec2(size + 7) / 8u : uvec2(0u);
  return DepositGroups(groups.x, groups.y, push.picture_count);
}

void main() {
  bool begins = push.level_count > 0u && state.is_used == 0u &&
                lists.large_parts > kMostExactLayers * kLayerParts * push.picture_count;
  ivec2 padded = paddedSize(uvec2(push.width, push.height), push.level_count);
  for (uint k = 0u; k <= push.level_count; ++k) state.describe[k] = groupsOver((padded >> k) + 1 >> 1, begins);
  for (uint k = 0u; k < push.level_count && begins; ++k) state.sum[k] = groupsOver(padded >> k, true);
  if (begins) state.is_used = 1u;
  uint groups_at_levels = state.is_used != 0u ? kListGroups : 0u;
  state.at_levels = DepositGroups(groups_at_levels, 1u, 1u);
  state.exact = DepositGroups(kListGroups - groups_at_levels, 1u, 1u);
}
