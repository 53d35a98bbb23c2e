// Which triangles lie before each cell of what a light sees: one list a cell, for shadows with exact edges.
//
// A ray from a light stays in one cell of its view, so whatever blocks the ray is in that cell's list, at any depth.
// Triangles that cover many cells go to the lists of a coarser grid, which every ray looks through as well.
// Lists are linked; their order differs between runs, what they hold does not.
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#include "frame/surface.glsl"

layout(local_size_x = 64) in;
layout(set = 0, binding = 7) uniform usamplerBuffer view_table;
// Light by light; of each, fine cells view by view, then coarse cells, then marks of the coarse cells in whose fine ones
// there is something.
layout(set = 0, binding = 8, r32ui) uniform uimageBuffer heads;
layout(set = 0, binding = 9, rgba32ui) writeonly uniform uimageBuffer nodes;
layout(scalar, set = 0, binding = 10) buffer Counters { uint node_counts[]; };  // by light

layout(push_constant, scalar) uniform Push {
  uint instance_index;
  uint triangle_count;
  uint light;
  uint first_head;  // of its lists
  uint first_view;
  uint view_count;
  uint view_mask;  // views that may show the instance
  uint grid_size;  // cells along a side of a view
  uint first_node;
  uint node_capacity;
  vec3 scene_lower;  // bounds of all geometry, world
  vec3 scene_upper;
  vec4 source;  // a place of the light, or with w = 0 the direction to it
};

/// More cells than this in its box, and a triangle is a large one; unless it is thin and leans, and so covers few of them.
const int kLargeCells = 128;
/// Cells in the box for each that is covered by a thin one.
const float kThin = 4.0;
/// Of the box, in which one thread looks for those that are covered.
const int kMostCells = 2048;
/// What is this near to the plane of the light, relative to the farthest corner, is cut off: it would be projected to
/// infinity, and no point that could be shadowed lies between.
const float kCutShare = 1e-6;
/// Widening of triangles, in cells: the rounding of projected corners, of which cells know nothing.
const float kMargin = 0.01;

void addNode(uint list, GridNode node) {
  uint place = atomicAdd(node_counts[light], 1u);
  if (place >= node_capacity) return;  // counted: the lists are built again with room for all
  place += first_node;
  node.next = imageAtomicExchange(heads, int(list), place);
  imageStore(nodes, int(3u * place), uvec4(floatBitsToUint(node.a), node.next));
  imageStore(nodes, int(3u * place + 1u), uvec4(floatBitsToUint(node.b), node.instance));
  imageStore(nodes, int(3u * place + 2u), uvec4(floatBitsToUint(node.c), node.triangle));
}

struct ViewRows {
  vec4 x;
  vec4 y;
  vec4 w;
};

ViewRows fetchRows(uint view) {
  return ViewRows(uintBitsToFloat(texelFetch(view_table, int(8u * view))),
                  uintBitsToFloat(texelFetch(view_table, int(8u * view + 1u))),
                  uintBitsToFloat(texelFetch(view_table, int(8u * view + 3u))));
}

/// The part of a triangle before the light, projected: up to four corners, in cells.
struct Outline {
  vec2 corners[4];
  int count;
};

Outline project(ViewRows view, GridNode t, float size) {
  vec4 world[3] = vec4[3](vec4(t.a, 1.0), vec4(t.b, 1.0), vec4(t.c, 1.0));
  vec3 clip[3];
  float farthest = 0.0;
  for (int k = 0; k < 3; ++k) {
    clip[k] = vec3(dot(view.x, world[k]), dot(view.y, world[k]), dot(view.w, world[k]));
    farthest = max(farthest, clip[k].z);
  }
  Outline o;
  o.count = 0;
  float cut = kCutShare * farthest;
  if (farthest <= 0.0) return o;
  for (int k = 0; k < 3; ++k) {
    vec3 here = clip[k], next = clip[(k + 1) % 3];
    if (here.z >= cut) o.corners[o.count++] = here.xy / here.z;
    if ((here.z >= cut) != (next.z >= cut)) {
      vec3 between = mix(here, next, (cut - here.z) / (next.z - here.z));
      o.corners[o.count++] = between.xy / cut;
    }
  }
  for (int k = 0; k < o.count; ++k) o.corners[k] = (o.corners[k] * 0.5 + 0.5) * size;
  return o;
}

/// False only if the outline, which is convex, is clear of the cell: an edge has all of the cell on its outer side.
bool overlaps(Outline o, float orientation, vec2 cell) {
  vec2 middle = cell + 0.5;
  float reach = 0.5 + kMargin;
  for (int k = 0; k < o.count; ++k) {
    vec2 from = o.corners[k], edge = o.corners[(k + 1) % o.count] - from;
    vec2 outward = orientation * vec2(edge.y, -edge.x);
    float nearest = dot(outward, middle - from) - reach * (abs(outward.x) + abs(outward.y));
    // What was projected from near the light's plane is huge, and so is the rounding of its edges.
    if (nearest > 1e-5 * dot(abs(outward), abs(from) + abs(middle))) return false;
  }
  return true;
}

/// Twice its area, in cells, negative if it turns the other way.
float doubleAreaOf(Outline o) {
  float area = 0.0;
  for (int k = 0; k < o.count; ++k) {
    vec2 a = o.corners[k] - o.corners[0], b = o.corners[(k + 1) % o.count] - o.corners[0];
    area += a.x * b.y - a.y * b.x;
  }
  return area;
}

/// @param extent  of its box, in cells
bool isLarge(Outline o, ivec2 extent) {
  int box = extent.x * extent.y;
  // A line crosses as many cells as it goes along both sides.
  float covered = 0.5 * abs(doubleAreaOf(o)) + float(extent.x + extent.y);
  return box > kLargeCells && (kThin * covered > float(box) || box > kMostCells);
}

/// Adds a triangle to the cells that it covers of a grid of a view, whose lists begin at `first_list`.
/// @param first_mark  of the view's; kNowhere: the cells are the coarse ones
void addToCells(Outline o, GridNode node, uint first_list, uint first_mark, int size, ivec2 first, ivec2 last) {
  float orientation = doubleAreaOf(o) < 0.0 ? -1.0 : 1.0;
  for (int y = first.y; y <= last.y; ++y) {
    for (int x = first.x; x <= last.x; ++x) {
      if (!overlaps(o, orientation, vec2(x, y))) continue;
      addNode(first_list + uint(y * size + x), node);
      ivec2 coarse = ivec2(x, y) / int(kCoarseCell);
      uint mark = first_mark + uint(coarse.y * (size / int(kCoarseCell)) + coarse.x);
      // All write the same.
      if (first_mark != kNowhere) imageAtomicMin(heads, int(mark), 0u);
    }
  }
}

void addToView(uint view, GridNode node) {
  int size = int(grid_size);
  Outline o = project(fetchRows(first_view + view), node, float(size));
  if (o.count == 0) return;
  vec2 lower = o.corners[0], upper = o.corners[0];
  for (int k = 1; k < o.count; ++k) {
    lower = min(lower, o.corners[k]);
    upper = max(upper, o.corners[k]);
  }
  if (any(lessThan(upper, vec2(-kMargin))) || any(greaterThan(lower, vec2(float(size) + kMargin)))) return;
  ivec2 first = ivec2(clamp(floor(lower - kMargin), vec2(0.0), vec2(float(size - 1))));
  ivec2 last = ivec2(clamp(floor(upper + kMargin), vec2(0.0), vec2(float(size - 1))));
  ivec2 extent = last - first + 1;
  uint coarse_cells = (grid_size / kCoarseCell) * (grid_size / kCoarseCell);
  uint first_list = first_head + view * grid_size * grid_size;
  uint first_mark = first_head + view_count * (grid_size * grid_size + coarse_cells) + view * coarse_cells;
  if (isLarge(o, extent)) {
    int coarse = int(kCoarseCell);
    for (int k = 0; k < o.count; ++k) o.corners[k] /= float(coarse);
    size /= coarse;
    first /= coarse;
    last /= coarse;
    first_list = first_head + view_count * grid_size * grid_size + view * coarse_cells;
    first_mark = kNowhere;
  }
  addToCells(o, node, first_list, first_mark, size, first, last);
}

/// Does the whole scene lie on the light's side of the triangle? Then it shadows nothing: floors and walls mostly.
bool isBackdrop(Triangle t) {
  vec3 normal = cross(t.b - t.a, t.c - t.a);
  if (dot(normal, source.xyz - source.w * t.a) < 0.0) normal = -normal;
  // The corner of the bounds that lies farthest behind; they are given by less than they are known by.
  vec3 behind = mix(scene_lower, scene_upper, lessThan(normal, vec3(0.0)));
  return dot(normal, behind - t.a) >= -1e-6 * dot(abs(normal), scene_upper - scene_lower);
}

void main() {
  uint triangle = gl_GlobalInvocationID.x;
  if (triangle >= triangle_count) return;
  InstanceRecord instance = fetchInstance(instance_index);
  Triangle t = toWorld(instance, fetchTriangle(instance.first_triangle + triangle));
  if (isBackdrop(t)) return;
  uint flagged = instance_index | ((instance.flags & kInstancePassable) != 0u ? kNodePassable : 0u);
  GridNode node = GridNode(t.a, 0u, t.b, flagged, t.c, triangle);
  for (uint v = 0u; v < view_count; ++v)
    if ((view_mask & (1u << v)) != 0u) addToView(v, node);
}
