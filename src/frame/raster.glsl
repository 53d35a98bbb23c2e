// A triangle on the film: which pixels it covers, and at what depth. Shared by the passes of frame/raster.h.
//
// Passes must agree to the last bit on what they compute of the same triangle, hence `precise` throughout.
#ifndef NEPHROID_RASTER_GLSL
#define NEPHROID_RASTER_GLSL

#extension GL_EXT_control_flow_attributes : require
#extension GL_EXT_shader_atomic_int64 : require
#extension GL_EXT_shader_explicit_arithmetic_types_int64 : require
#include "frame/raster.shared.h"
#include "frame/tables.glsl"

layout(scalar, set = 0, binding = 7) buffer Keys { uint64_t keys[]; };      // by pixel, of the nearest: makeKey
layout(scalar, set = 0, binding = 8) buffer Counts { uint counts[]; };      // by list: kCount…
layout(scalar, set = 0, binding = 9) buffer Parts { RasterPart parts[]; };  // from part_capacity on whole triangles
layout(scalar, set = 0, binding = 10) buffer Items { uint items[]; };       // by list: triangles, or places in `parts`

layout(push_constant, scalar) uniform Push { RasterPush push; };

/// Triangles cover so much more to all sides, in pixels. The hardware's rasteriser rounds corners by up to this: no
/// gap is left between what it draws and what is drawn here, nor by rounding between neighbours.
const float kMargin = 1.0 / 512.0 + 1e-4;

/// Three corners in clip space, x and y in pixels from the film's middle (times w).
struct Corners {
  vec4 clip[3];
};

/// What is linear over the film, q being pixels from `origin`: value = dot(plane, vec3(q, 1)).
struct FilmTriangle {
  vec2 origin;
  vec3 edges[3];  // >= 0 inside of edge k
  vec3 depth;     // 1 at the near end to 0
  float cut;      // nothing is nearer
  float nearest;
  float farthest;
  ivec2 first;  // the pixels that it may cover; none if last < first
  ivec2 last;
};

vec4 toClip(InstanceRecord instance, vec3 p) {
  precise vec3 world;
  world.x = instance.row_x.x * p.x + instance.row_x.y * p.y + instance.row_x.z * p.z + instance.row_x.w;
  world.y = instance.row_y.x * p.x + instance.row_y.y * p.y + instance.row_y.z * p.z + instance.row_y.w;
  world.z = instance.row_z.x * p.x + instance.row_z.y * p.y + instance.row_z.z * p.z + instance.row_z.w;
  precise vec4 clip = push.clip_column_x * world.x + push.clip_column_y * world.y + push.clip_column_z * world.z +
                      push.clip_column_w;
  return clip;
}

Corners fetchCorners(InstanceRecord instance, uint triangle) {
  TriangleRecord t = fetchTriangle(instance.first_triangle + triangle);
  return Corners(vec4[3](toClip(instance, t.a), toClip(instance, t.b), toClip(instance, t.c)));
}

/// Whether a corner lies before the near end or far off the film.
bool isBeyond(vec4 clip) {
  return !(clip.w - clip.z >= 0.0 && max(abs(clip.x), abs(clip.y)) <= push.guard * clip.w);
}

bool isBeyond(Corners c) { return isBeyond(c.clip[0]) || isBeyond(c.clip[1]) || isBeyond(c.clip[2]); }

/// False only if the triangle is not on the film.
bool mayCover(Corners c) {
  vec2 reach = 0.5 * vec2(push.size_x, push.size_y) + 1.0;
  bool right = true, left = true, below = true, above = true, before = true;
  [[unroll]] for (int k = 0; k < 3; ++k) {
    vec4 p = c.clip[k];
    right = right && p.x > reach.x * p.w;
    left = left && p.x < -reach.x * p.w;
    below = below && p.y > reach.y * p.w;
    above = above && p.y < -reach.y * p.w;
    before = before && p.w - p.z < 0.0;
  }
  return !(right || left || below || above || before);
}

vec2 filmMiddle() { return 0.5 * vec2(push.size_x, push.size_y) - 0.5; }

void setPixels(inout FilmTriangle t, vec2 lower, vec2 upper) {
  vec2 size = vec2(push.size_x, push.size_y);
  t.first = ivec2(ceil(clamp(lower - kMargin + filmMiddle(), vec2(0.0), size)));
  t.last = ivec2(floor(clamp(upper + kMargin + filmMiddle(), vec2(-1.0), size - 1.0)));
  if (t.last.x < t.first.x) t.last.y = t.first.y - 1;
}

/// The box of what is behind the near end.
void setPixelsUncut(inout FilmTriangle t, Corners c) {
  vec2 lower = vec2(push.guard), upper = vec2(-push.guard);
  [[unroll]] for (int k = 0; k < 3; ++k) {
    vec4 here = c.clip[k], next = c.clip[(k + 1) % 3];
    float inside = here.w - here.z, next_inside = next.w - next.z;
    if (inside >= 0.0) {
      lower = min(lower, here.xy / here.w);
      upper = max(upper, here.xy / here.w);
    }
    if ((inside >= 0.0) != (next_inside >= 0.0)) {
      vec4 cut = mix(here, next, inside / (inside - next_inside));
      lower = min(lower, cut.xy / cut.w - 1.0);  // a pixel for its rounding
      upper = max(upper, cut.xy / cut.w + 1.0);
    }
  }
  setPixels(t, lower, upper);
}

vec3 widenEdge(vec3 edge) {
  precise float offset = edge.z + kMargin * (abs(edge.x) + abs(edge.y));
  return vec3(edge.xy, offset);
}

/// Neither is a triangle without area seen, nor one whose corners are no numbers.
bool isRegular(float area) { return abs(area) > 0.0 && abs(area) < 3e38; }

/// Of corners none of which is beyond.
FilmTriangle projectTriangle(Corners c) {
  precise vec2 a = c.clip[0].xy / c.clip[0].w, b = c.clip[1].xy / c.clip[1].w, d = c.clip[2].xy / c.clip[2].w;
  precise vec3 z = vec3(c.clip[0].z / c.clip[0].w, c.clip[1].z / c.clip[1].w, c.clip[2].z / c.clip[2].w);
  precise vec2 e1 = b - a, e2 = d - a;
  precise float area = e1.x * e2.y - e1.y * e2.x;
  precise float turn = area < 0.0 ? -1.0 : 1.0;
  // How the weight of each corner, times the area, grows over the film.
  precise vec2 of_b = turn * vec2(e2.y, -e2.x), of_d = turn * vec2(-e1.y, e1.x);
  precise vec2 of_a = -(of_b + of_d);
  precise vec2 slope = (of_b * (z.y - z.x) + of_d * (z.z - z.x)) / abs(area);
  precise FilmTriangle t;
  t.origin = a;
  t.edges[0] = widenEdge(vec3(of_a, abs(area)));
  t.edges[1] = widenEdge(vec3(of_b, 0.0));
  t.edges[2] = widenEdge(vec3(of_d, 0.0));
  t.depth = vec3(slope, z.x);
  t.cut = 3e38;
  t.nearest = max(max(z.x, z.y), z.z);
  t.farthest = min(min(z.x, z.y), z.z);
  setPixels(t, min(min(a, b), d), max(max(a, b), d));
  if (!isRegular(area)) t.last.y = t.first.y - 1;
  return t;
}

/// Of any corners: the film's edges are planes through the eye, so nothing needs to be cut off.
/// @see [olano-greer-1997]
FilmTriangle projectUncut(Corners c) {
  precise FilmTriangle t;
  t.origin = vec2(0.0);
  t.cut = 1.0;
  t.nearest = 1.0;
  t.farthest = 0.0;
  precise vec3 p[3] = vec3[3](c.clip[0].xyw, c.clip[1].xyw, c.clip[2].xyw);
  precise vec3 planes[3];
  [[unroll]] for (int k = 0; k < 3; ++k) {
    vec3 from = p[(k + 1) % 3], to = p[(k + 2) % 3];
    planes[k] = vec3(from.y * to.z - from.z * to.y, from.z * to.x - from.x * to.z, from.x * to.y - from.y * to.x);
  }
  precise float volume = p[0].x * planes[0].x + p[0].y * planes[0].y + p[0].z * planes[0].z;
  precise float turn = volume < 0.0 ? -1.0 : 1.0;
  precise vec3 depth = (c.clip[0].z * planes[0] + c.clip[1].z * planes[1] + c.clip[2].z * planes[2]) / volume;
  t.depth = depth;
  [[unroll]] for (int k = 0; k < 3; ++k) t.edges[k] = widenEdge(turn * planes[k]);
  setPixelsUncut(t, c);
  if (!isRegular(volume)) t.last.y = t.first.y - 1;
  return t;
}

/// Bits of the triangle's depth at a pixel's centre, which are in the order of depths; 0 where it does not cover it.
uint depthAt(FilmTriangle t, ivec2 pixel) {
  precise vec2 q = vec2(pixel) - filmMiddle() - t.origin;
  precise float a = t.edges[0].x * q.x + t.edges[0].y * q.y + t.edges[0].z;
  precise float b = t.edges[1].x * q.x + t.edges[1].y * q.y + t.edges[1].z;
  precise float c = t.edges[2].x * q.x + t.edges[2].y * q.y + t.edges[2].z;
  precise float depth = t.depth.x * q.x + t.depth.y * q.y + t.depth.z;
  // Beyond its edges a triangle seen edge-on would be anywhere. Depths below the least normal number are zeros to some.
  bool covers = min(min(a, b), c) >= 0.0 && depth <= t.cut;
  return covers ? floatBitsToUint(max(clamp(depth, t.farthest, t.nearest), 1e-37)) : 0u;
}

int pixelsOf(FilmTriangle t) {
  ivec2 extent = t.last - t.first + 1;
  return extent.y > 0 ? extent.x * extent.y : 0;
}

uint indexOf(ivec2 pixel) { return uint(pixel.y * push.size_x + pixel.x); }

/// The next pixel of the triangle's box: row by row, until it lies below `last`.
ivec2 nextPixel(FilmTriangle t, ivec2 pixel) {
  return pixel.x < t.last.x ? pixel + ivec2(1, 0) : ivec2(t.first.x, pixel.y + 1);
}

/// From `pixel` on the first that the triangle covers, or one below `last`. A loop of its own: threads in step go
/// through memory, which is slow, as often as the one with the most pixels, not as the one with the largest box.
ivec2 findCovered(FilmTriangle t, ivec2 pixel) {
  while (pixel.y <= t.last.y && depthAt(t, pixel) == 0u) pixel = nextPixel(t, pixel);
  return pixel;
}

FilmTriangle projectPart(RasterPart part) {
  Corners corners = fetchCorners(fetchInstance(part.instance), part.triangle);
  FilmTriangle t = projectTriangle(corners);
  if (isBeyond(corners)) t = projectUncut(corners);
  t.first.y = max(t.first.y, int(part.rows & 0xFFFFu));
  t.last.y = min(t.last.y, int((part.rows & 0xFFFFu) + (part.rows >> 16u)) - 1);
  return t;
}

uint countOf(uint list, uint kind) { return kCounts * list + kind; }

/// The nearer the larger; of equally near triangles the first in number.
uint64_t makeKey(uint depth, uint number) { return packUint2x32(uvec2(~number, depth)); }

/// Leaves the key of the nearest triangle at each pixel. @param number  of the triangle, counted through all draws
void draw(FilmTriangle t, uint number) {
  for (ivec2 p = findCovered(t, t.first); p.y <= t.last.y; p = findCovered(t, nextPixel(t, p)))
    atomicMax(keys[indexOf(p)], makeKey(depthAt(t, p), number));
}

#endif
