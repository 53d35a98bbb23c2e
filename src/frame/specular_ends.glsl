// Where the chains that are followed at the points of the grid end: three texels of four words for each of a point's two
// chains.
#ifndef NEPHROID_SPECULAR_ENDS_GLSL
#define NEPHROID_SPECULAR_ENDS_GLSL

#include "frame/specular_grid.glsl"

/// Of the chain that takes the way at every surface that carries most.
struct ChainEnd {
  vec3 place;     // on the surface that is seen lit; the direction of a ray that leaves the scene
  uint chain;     // hash of the surfaces met and the ways taken; 0: it says nothing about its neighbours
  vec3 weight;    // of the light that comes along it
  float others;   // chance with which another chain would have been drawn
  uint instance;  // of the surface that is seen; kNowhere: the sky, or nothing
  uint triangle;
  uint dir;       // of the ray that meets it, as packUnitVector
  float ior_from;
};

const uint kEndTexels = 3u;

/// Of a point's chain, of all points' in rows.
uint chainOf(uvec2 point, uint chain) { return 2u * (point.y * pointCount().x + point.x) + chain; }

int texelOfEnd(uvec2 point, uint chain, uint texel) { return int(chainOf(point, chain) * kEndTexels + texel); }

/// Of how ends bend between the corners of a cell: one texel along x, one along y, of its two chains.
int texelOfBend(uvec2 cell, uint chain, uint along) { return int(2u * chainOf(cell, chain) + along); }

#ifdef NEPHROID_ENDS_BINDING

layout(set = 0, binding = NEPHROID_ENDS_BINDING) uniform usamplerBuffer ends;

/// Place and hash of an end.
uvec4 fetchEndPlace(uvec2 point, uint chain) { return texelFetch(ends, texelOfEnd(point, chain, 0u)); }
/// Its weight and others.
vec4 fetchEndWeight(uvec2 point, uint chain) {
  return uintBitsToFloat(texelFetch(ends, texelOfEnd(point, chain, 1u)));
}
/// Its instance, triangle, dir and ior_from.
uvec4 fetchEndSurface(uvec2 point, uint chain) { return texelFetch(ends, texelOfEnd(point, chain, 2u)); }

/// What varies over a cell, from its corners: value = c + x·along_x + y·along_y + x·y·twist with x, y in [0, 1].
struct Bilinear {
  vec4 corner;
  vec4 along_x;
  vec4 along_y;
  vec4 twist;
};

Bilinear bilinearOf(vec4 c00, vec4 c10, vec4 c01, vec4 c11) {
  return Bilinear(c00, c10 - c00, c01 - c00, c00 - c10 - c01 + c11);
}

vec4 valueAt(Bilinear b, vec2 at) { return b.corner + at.x * b.along_x + at.y * (b.along_y + at.x * b.twist); }

#endif

#endif
