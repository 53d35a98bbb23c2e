// Where the texels of coarser levels lie in the pictures that hold them all (frame/flux_levels.h).
#ifndef NEPHROID_FLUX_LEVELS_GLSL
#define NEPHROID_FLUX_LEVELS_GLSL

#include "frame/deposit.shared.h"

/// A picture's size, rounded up to whole texels of the last level.
ivec2 paddedSize(uvec2 size, uint level_count) {
  uint last = (1u << level_count) - 1u;
  return ivec2((size + last) & ~uvec2(last));
}

/// Where a level >= 1 begins: the first on the left, the others beside it from top to bottom.
ivec2 levelOrigin(ivec2 padded, uint level) {
  return level == 1u ? ivec2(0) : ivec2(padded.x >> 1, (padded.y >> 1) - (padded.y >> (level - 1u)));
}

#endif
