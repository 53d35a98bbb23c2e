// What a ray of any origin and direction meets first, by a tree of boxes (frame/triangle_tree.h).
//
// The including shader gives the two bindings from NEPHROID_TREE_BINDINGS on, and declares before, among what is pushed
// to it: tree_nodes, tree_grid_lower, tree_grid_scale.
#ifndef NEPHROID_TRIANGLE_TREE_GLSL
#define NEPHROID_TRIANGLE_TREE_GLSL

#include "frame/tables.glsl"
#include "frame/path.glsl"

layout(set = 0, binding = NEPHROID_TREE_BINDINGS) uniform usamplerBuffer tree_node_table;
layout(set = 0, binding = NEPHROID_TREE_BINDINGS + 1) uniform usamplerBuffer tree_triangle_table;

layout(constant_id = 20) const bool kTreeIsCompact = false;
layout(constant_id = 25) const bool kTreeHasOrders = false;  // by the octants of directions

/// Weights of corners may be below zero by what rounding makes of them, or a ray slips between two triangles: by so
/// much of the triangle, and of how far off it is in lengths of its edges.
const float kEdgeSlack = 1e-6;
const float kReachSlack = 5e-7;
/// Where a walk goes along falling coordinates it tells them the other way, from here.
const float kTreeMirror = kTreeIsCompact ? kTreeGridEnd : 0.0;

/// A box of the tree, on its grid: in the world where that is none.
struct TreeBox {
  vec3 lower;
  vec3 upper;
  uint link;
};

TreeBox fetchBox(uint node) {
  if (kTreeIsCompact) {
    uvec4 n = texelFetch(tree_node_table, int(node));
    return TreeBox(vec3(n.x & 0xFFFFu, n.x >> 16, n.y & 0xFFFFu), vec3(n.y >> 16, n.z & 0xFFFFu, n.z >> 16), n.w);
  }
  uvec4 lower = texelFetch(tree_node_table, int(2u * node));
  uvec4 upper = texelFetch(tree_node_table, int(2u * node + 1u));
  return TreeBox(uintBitsToFloat(lower.xyz), uintBitsToFloat(upper.xyz), lower.w);
}

/// Does a ray along which all coordinates rise meet a box before `t_max`?
bool meetsBox(TreeBox box, vec3 origin, vec3 inverse_dir, float t_max) {
  vec3 near = (box.lower - origin) * inverse_dir, far = (box.upper - origin) * inverse_dir;
  // Taken as integers, numbers from 0 on keep their order and those below it stay below: the most and the least of
  // integers are an instruction, while a device asks of each number whether it is one.
  ivec3 near_word = floatBitsToInt(near), far_word = floatBitsToInt(far);
  int enters = max(max(near_word.x, near_word.y), max(near_word.z, 0));
  int leaves = min(min(far_word.x, far_word.y), min(far_word.z, floatBitsToInt(t_max)));
  return intBitsToFloat(enters) <= intBitsToFloat(leaves) * (1.0 + 1e-6);
}

/// A box as a walk tells its coordinates.
TreeBox mirrored(TreeBox box, bvec3 falls) {
  vec3 lower = mix(box.lower, kTreeMirror - box.upper, falls), upper = mix(box.upper, kTreeMirror - box.lower, falls);
  return TreeBox(lower, upper, box.link);
}

float largestOf(vec3 v) { return max(abs(v.x), max(abs(v.y), abs(v.z))); }

/// No less than a third of the distance to a triangle times its longest edge, about: of the size of the products that
/// weights of corners are differences of.
float reachOf(Triangle t, vec3 from) {
  return largestOf(from - t.a) * max(largestOf(t.b - t.a), largestOf(t.c - t.a));
}

/// The first triangle that a ray meets but its own.
/// @param ray  starts a hair off its own triangle
Met meetFirst(Ray ray, uint own_instance, uint own_triangle) {
  Met best = Met(kFarAway, 0.0, 0.0, kNowhere, 0u);
  // The box of a plane across a coordinate in which the ray does not move is met at no time, or at all.
  vec3 dir = mix(ray.dir, vec3(1e-18), lessThan(abs(ray.dir), vec3(1e-18)));
  vec3 inverse_dir = 1.0 / abs(dir);
  bvec3 falls = lessThan(dir, vec3(0.0));
  uint first = kTreeHasOrders ? (uint(falls.x) + 2u * uint(falls.y) + 4u * uint(falls.z)) * tree_nodes : 0u;
  // The grid is the same along all axes, so directions are too, and distances are its cells.
  vec3 origin = (ray.origin - tree_grid_lower) * tree_grid_scale;
  origin = mix(origin, kTreeMirror - origin, falls);
  uint node = 0u, triangle = 0u, triangles_left = 0u;
  if (tree_nodes == 0u) return best;
  // All loops ask at the end whether there is more: a device that runs all branches runs a loop's body once more to find
  // that it is done.
  do {
    // To the next leaf. Threads that go in step wait for each other here: a turn for either a box or a triangle would
    // cost both.
    do {
      TreeBox box = fetchBox(first + node);
      if (!kTreeHasOrders) box = mirrored(box, falls);
      bool met = meetsBox(box, origin, inverse_dir, best.t * tree_grid_scale);
      bool is_leaf = box.link >= kTreeLeaf;
      node = met || is_leaf ? node + 1u : box.link;
      triangle = is_leaf ? (box.link - kTreeLeaf) >> 2 : 0u;
      triangles_left = met && is_leaf ? box.link & 3u : 0u;
    } while (node < tree_nodes && triangles_left == 0u);
    bool is_triangle = triangles_left > 0u;
    do {
      uvec4 a = texelFetch(tree_triangle_table, int(3u * triangle));
      uvec4 b = texelFetch(tree_triangle_table, int(3u * triangle + 1u));
      uvec4 c = texelFetch(tree_triangle_table, int(3u * triangle + 2u));
      ++triangle;
      Triangle corners = Triangle(uintBitsToFloat(a.xyz), uintBitsToFloat(b.xyz), uintBitsToFloat(c.xyz));
      RayTriangle hit = intersectPlaneOf(corners, ray.origin, ray.dir);
      float slack = kEdgeSlack * hit.size + kReachSlack * reachOf(corners, ray.origin);
      bool inside = hit.size > 0.0 && min(min(hit.u, hit.v), hit.size - hit.u - hit.v) >= -slack;
      bool own = a.w == own_instance && b.w == own_triangle;
      if (is_triangle && !own && inside && hit.t > 0.0 && hit.t < best.t * hit.size)
        best = Met(hit.t / hit.size, hit.u / hit.size, hit.v / hit.size, a.w, b.w);
      triangles_left = is_triangle ? triangles_left - 1u : 0u;
    } while (triangles_left > 0u);
  } while (node < tree_nodes);
  return best;
}

#endif
