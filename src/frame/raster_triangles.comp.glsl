// Draws one instance's triangles: small ones at once, the others are put off in parts.
//
// Eight neighbours run in step, so all wait for the one with the most pixels.
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#include "frame/raster.glsl"

layout(local_size_x = 64) in;
layout(constant_id = 5) const bool kPutsOff = true;  // else all are small

void main() {
  InstanceRecord instance = fetchInstance(push.instance);
  uint triangle = gl_GlobalInvocationID.x;
  if (triangle >= push.triangle_count) return;
  Corners corners = fetchCorners(instance, triangle);
  FilmTriangle t = projectTriangle(corners);
  if (kPutsOff) {
    bool beyond = isBeyond(corners);
    bool put_off = beyond ? mayCover(corners) : pixelsOf(t) > kPartPixels;
    if (beyond || put_off) t.last.y = t.first.y - 1;
    if (put_off) items[push.first_number + atomicAdd(counts[countOf(push.list, kCountPutOff)], 1u)] = triangle;
  }
  draw(t, push.first_number + triangle);
}
