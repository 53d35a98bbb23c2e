// Depths of one instance's triangles: small ones are drawn at once, the others put off in parts.
//
// Eight neighbours run in step, so all wait for the one with the most pixels.
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#include "frame/raster.glsl"

layout(local_size_x = 64) in;

void main() {
  InstanceRecord instance = fetchInstance(push.instance);
  uint triangle = gl_GlobalInvocationID.x;
  if (triangle >= push.triangle_count) return;
  Corners corners = fetchCorners(instance, triangle);
  FilmTriangle t = projectTriangle(corners);
  bool beyond = isBeyond(corners);
  bool put_off = beyond ? mayCover(corners) : pixelsOf(t) > kPartPixels;
  if (beyond || put_off) t.last.y = t.first.y - 1;
  bool may_be_seen = drawDepths(t);
  // One list or the other: accesses cost the same whether one thread of eight makes them or none.
  if (put_off || may_be_seen) {
    uint place = atomicAdd(counts[countOf(push.list, put_off ? kCountPutOff : kCountNearest)], 1u);
    items[push.first_number + (put_off ? push.first_put_off : 0u) + place] = triangle;
  }
}
