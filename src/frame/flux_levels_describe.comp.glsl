// What the texels of a level show, by those of the level before; and which of the latter show the same as those beside
// them.
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#extension GL_EXT_control_flow_attributes : require
#include "frame/flux_levels.glsl"
#include "core/optics/photon.shared.h"

layout(local_size_x = 8, local_size_y = 8) in;
layout(set = 0, binding = 0, rgba32f) readonly uniform image2DArray surfaces;
layout(set = 0, binding = 1, rgba32f) uniform image2DArray level_surfaces;
layout(set = 0, binding = 2, r32ui) uniform uimage2DArray level_kinds;
layout(set = 0, binding = 3, r32ui) writeonly uniform uimage2DArray level_links;
layout(constant_id = 0) const bool kIsFirst = false;  // level 1
layout(push_constant, scalar) uniform Push { FluxLevelsPush push; };

/// Least cosine between the normals of neighbours on one surface.
const float kSameNormal = 0.95;
/// How far a neighbour may lie off the plane, over how far away it is.
const float kMostBend = 0.1;
/// Farther away than anything, m: where nothing is seen.
const float kNowhereAt = 1e30;

struct Node {
  vec4 surface;
  vec3 normal;
  uint kind;
};

ivec2 padded() { return paddedSize(uvec2(push.width, push.height), push.level_count); }

/// @param level  0: the picture itself
Node fetchNode(ivec2 at, uint level, uint picture) {
  ivec2 padded_size = padded();
  ivec2 size = kIsFirst ? ivec2(push.width, push.height) : padded_size >> level;
  if (any(lessThan(at, ivec2(0))) || any(greaterThanEqual(at, size))) return Node(vec4(0.0), vec3(0.0), kNodeMixed);
  vec4 surface;
  uint kind;
  if (kIsFirst) {
    uint layer = picture / push.flux_layers * push.layer_count + picture % push.flux_layers;
    surface = imageLoad(surfaces, ivec3(at, layer));
    kind = abs(surface.x) < kNowhereAt ? kNodeSurface : kNodeNothing;
  } else {
    ivec3 place = ivec3(levelOrigin(padded_size, level) + at, picture);
    surface = imageLoad(level_surfaces, place);
    kind = imageLoad(level_kinds, place).x;
  }
  return Node(surface, unpackUnitVector(floatBitsToUint(surface.w)), kind);
}

bool showSame(Node a, Node b) {
  vec3 way = b.surface.xyz - a.surface.xyz;
  bool is_plane = dot(a.normal, b.normal) >= kSameNormal && abs(dot(a.normal, way)) <= kMostBend * length(way);
  return a.kind == b.kind && (a.kind == kNodeNothing || (a.kind == kNodeSurface && is_plane));
}

void store(ivec2 at, uint picture, Node first, bool same) {
  ivec3 place = ivec3(levelOrigin(padded(), push.level) + at, picture);
  imageStore(level_surfaces, place, first.surface);
  imageStore(level_kinds, place, uvec4(same ? first.kind : kNodeMixed));
}

/// Of the first level: nobody asks which texels of the picture itself show the same.
void describeFirst(ivec2 at, uint picture) {
  Node a = fetchNode(2 * at, 0u, picture), b = fetchNode(2 * at + ivec2(1, 0), 0u, picture);
  Node c = fetchNode(2 * at + ivec2(1, 1), 0u, picture), d = fetchNode(2 * at + ivec2(0, 1), 0u, picture);
  store(at, picture, a, showSame(a, b) && showSame(b, c) && showSame(c, d) && showSame(d, a));
}

void main() {
  ivec2 at = ivec2(gl_GlobalInvocationID.xy);
  uint picture = gl_GlobalInvocationID.z, below = push.level - 1u;
  ivec2 padded_size = padded(), size_below = padded_size >> below;
  if (any(greaterThanEqual(2 * at, size_below))) return;
  if (kIsFirst) {
    describeFirst(at, picture);
    return;
  }
  // The four below it, and those after them along both axes.
  Node nodes[3][3];
  [[unroll]] for (int y = 0; y < 3; ++y)
    [[unroll]] for (int x = 0; x < 3; ++x) nodes[y][x] = fetchNode(2 * at + ivec2(x, y), below, picture);
  uint links[4];
  [[unroll]] for (int k = 0; k < 4; ++k) {
    int x = k & 1, y = k >> 1;
    links[k] = (showSame(nodes[y][x], nodes[y][x + 1]) ? kLinkAcross : 0u) |
               (showSame(nodes[y][x], nodes[y + 1][x]) ? kLinkDown : 0u);
    ivec2 place = 2 * at + ivec2(x, y);
    if (all(lessThan(place, size_below)))
      imageStore(level_links, ivec3(levelOrigin(padded_size, below) + place, picture), uvec4(links[k]));
  }
  if (push.level > push.level_count) return;
  bool same = (links[0] & links[1] & kLinkDown) != 0u && (links[0] & links[2] & kLinkAcross) != 0u;
  store(at, picture, nodes[0][0], same);
}
