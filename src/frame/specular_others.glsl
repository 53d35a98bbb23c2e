// Which pixels of a cell show the ways that carry less: one number is drawn for each pixel and chain, from [0, 1).
#ifndef NEPHROID_SPECULAR_OTHERS_GLSL
#define NEPHROID_SPECULAR_OTHERS_GLSL

#include "frame/tables.glsl"

float drawOther(uvec2 pixel, uint frame, uint chain) {
  uint h = hashChain(hashChain(pixel.x + (pixel.y << 16), frame), 0x0742u + chain);
  return float(h >> 8) / 16777216.0;
}

/// Index of the largest, among equals the first.
uint mostOf(vec3 ways) {
  if (ways.x >= ways.y && ways.x >= ways.z) return 0u;
  return ways.y >= ways.z ? 1u : 2u;
}

/// Is one of the other ways drawn at a surface?
/// @param others  their chances, less than 1 together
/// @param u       decides, in [0, 1); if none is drawn it decides at the next surface
/// @return        3: none
uint takeOther(vec3 others, inout float u) {
  float chance = 0.0;
  for (uint i = 0u; i < 3u; ++i) {
    chance += others[i];
    if (u < chance) return i;
  }
  u = (u - chance) / (1.0 - chance);
  return 3u;
}

#endif
