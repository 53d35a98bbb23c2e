// Which triangles lie before each cell of what a light sees: one list a cell, for shadows with exact edges.
//
// A ray from a light stays in one cell of its view, so whatever blocks the ray is in that cell's list, at any depth.
// Triangles that cover very many cells go to one list that every ray looks through: there are only few of them.
// Lists are linked; their order differs between runs, what they hold does not.
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#include "frame/scene_access.glsl"

layout(local_size_x = 64) in;
layout(scalar, set = 0, binding = 5) readonly buffer LightViews { ViewRecord light_views[]; };
layout(scalar, set = 0, binding = 6) readonly buffer Lights { LightRecord lights[]; };
layout(scalar, set = 0, binding = 7) buffer Heads { uint heads[]; };  // by cell, view by view; the last: large ones
layout(scalar, set = 0, binding = 8) writeonly buffer Nodes { GridNode nodes[]; };
layout(scalar, set = 0, binding = 9) buffer Counters { uint node_count; };

layout(push_constant, scalar) uniform Push {
  uint instance_index;
  uint triangle_count;
  uint view_mask;      // views that may show the instance
  uint node_capacity;
};

/// More cells than this, and a triangle is a large one: one thread writes all cells of a triangle.
const int kLargeCells = 1024;
/// What is this near to the plane of the light, relative to the farthest corner, is cut off: it would be projected to
/// infinity, and no point that could be shadowed lies between.
const float kCutShare = 1e-6;
/// Widening of triangles, in cells: the rounding of projected corners, of which cells know nothing.
const float kMargin = 0.01;

void addNode(uint list, uint triangle, Triangle t) {
  uint node = atomicAdd(node_count, 1u);
  if (node >= node_capacity) return;  // counted: the lists are built again with room for all
  nodes[node] = GridNode(instance_index, triangle, atomicExchange(heads[list], node), t.a, t.b, t.c);
}

/// The part of a triangle before the light, projected: up to four corners, in cells.
struct Outline {
  vec2 corners[4];
  int count;
};

Outline project(ViewRecord view, Triangle t, float size) {
  vec4 world[3] = vec4[3](vec4(t.a, 1.0), vec4(t.b, 1.0), vec4(t.c, 1.0));
  vec3 clip[3];
  float farthest = 0.0;
  for (int k = 0; k < 3; ++k) {
    clip[k] = vec3(dot(view.clip_row_x, world[k]), dot(view.clip_row_y, world[k]), dot(view.clip_row_w, world[k]));
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

float orientationOf(Outline o) {
  float area = 0.0;
  for (int k = 0; k < o.count; ++k) {
    vec2 a = o.corners[k] - o.corners[0], b = o.corners[(k + 1) % o.count] - o.corners[0];
    area += a.x * b.y - a.y * b.x;
  }
  return area < 0.0 ? -1.0 : 1.0;
}

void addToView(uint view_index, Triangle t, uint triangle, int size) {
  Outline o = project(light_views[view_index], t, float(size));
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
  uint cells = uint(size * size);
  if (extent.x * extent.y > kLargeCells) {
    addNode(lights[0].view_count * cells, triangle, t);
    return;
  }
  float orientation = orientationOf(o);
  for (int y = first.y; y <= last.y; ++y)
    for (int x = first.x; x <= last.x; ++x)
      if (overlaps(o, orientation, vec2(x, y))) addNode(view_index * cells + uint(y * size + x), triangle, t);
}

void main() {
  uint triangle = gl_GlobalInvocationID.x;
  if (triangle >= triangle_count) return;
  InstanceRecord instance = instances[instance_index];
  Triangle t = fetchTriangle(instance, triangleVertices(instance, triangle));
  for (uint v = 0u; v < lights[0].view_count; ++v)
    if ((view_mask & (1u << v)) != 0u) addToView(v, t, triangle, int(lights[0].grid_size));
}
