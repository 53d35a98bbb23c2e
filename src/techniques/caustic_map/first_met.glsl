// What the light of a cell of the emission grid meets first.
//
// The including shader declares before: push, a TransportPush, and first_seen, of the emission's views: all there is.
#ifndef NEPHROID_FIRST_MET_GLSL
#define NEPHROID_FIRST_MET_GLSL

#include "frame/tables.glsl"

/// Where the photon of a cell starts on the view's film, in [-1, 1]².
vec2 filmOf(uvec2 cell) { return (vec2(cell) + push.offset) / float(push.grid) * 2.0 - 1.0; }

uvec2 firstSeen(vec2 film) {
  ivec3 texel = ivec3(ivec2((film * 0.5 + 0.5) * push.generator_size), push.view);
  return texelFetch(first_seen, texel, 0).xy;
}

/// What light neither is bent by nor may pass straight through.
bool isBlocker(uint instance) {
  uint passes = kInstanceGenerates | (kSceneHasPassable ? kInstancePassable : 0u);
  return (fetchInstance(instance).flags & passes) == 0u;
}

#endif
