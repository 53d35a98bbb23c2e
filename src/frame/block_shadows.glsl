// Shadows of the points of a block, which lie near each other on one triangle.
//
// Points near each other have the same lists of a light's grid, so a list is walked once for all of them: what is
// fetched of a triangle, and the planes through its edges and the light, serve every point. A point is in the triangle's
// shadow if it lies inside of all three planes and beyond the triangle: the same question as a ray's, asked by signs.
// Nothing here lets light pass: for scenes without panes and cut-outs.
#ifndef NEPHROID_BLOCK_SHADOWS_GLSL
#define NEPHROID_BLOCK_SHADOWS_GLSL

#include "frame/lights.glsl"

const uint kBlockPoints = 16u;

/// Each light has its own code, and whatever lies before a point keeps all light from it.
const bool kHasBlockShadows = kFewLights > 0u && !kSceneHasPassable;

struct BlockPoints {
  vec3 starts[kBlockPoints];  // a hair off the surface, towards the light
  uint cells[kBlockPoints];   // of the light's grid
};

/// Which points a triangle keeps from a light, a bit each.
uint findBehind(GridNode node, LightRecord light, BlockPoints points) {
  bool is_directional = !kLightsHavePoints || (kLightsHaveDirectionals && light.kind == kLightDirectional);
  // Seen from the light, so that two triangles find the same of the edge that they share: the products of its corners
  // are each other's opposite to the last bit.
  vec3 origin = is_directional ? vec3(0.0) : light.position;
  vec3 a = node.a - origin, b = node.b - origin, c = node.c - origin, to_light = -light.direction;
  vec3 edges[3] = vec3[3](cross(a, b), cross(b, c), cross(c, a));
  vec3 offsets = vec3(0.0);
  if (is_directional) {
    edges = vec3[3](cross(b - a, to_light), cross(c - b, to_light), cross(a - c, to_light));
    offsets = 0.5 * vec3(dot(edges[0], a + b), dot(edges[1], b + c), dot(edges[2], c + a));
  }
  vec3 normal = cross(b - a, c - a);
  float of_light = is_directional ? dot(normal, to_light) : -dot(normal, a);
  float turn = of_light < 0.0 ? 1.0 : -1.0;
  uint behind = 0u;
  [[unroll]] for (uint k = 0u; k < kBlockPoints; ++k) {
    vec3 p = points.starts[k] - origin;
    vec3 sides = turn * (vec3(dot(edges[0], p), dot(edges[1], p), dot(edges[2], p)) - offsets);
    float beyond = turn * dot(normal, p - a);
    bool between = beyond > 0.0 && (is_directional || beyond * 1e-5 < abs(of_light));
    if (min(min(sides.x, sides.y), sides.z) >= 0.0 && between && of_light != 0.0) behind |= 1u << k;
  }
  return behind;
}

/// A cell without what tells it from others in the same coarse one.
uint coarsen(uint cell) { return cell & ~((kCoarseCell - 1u) * (1u | (1u << 14))); }

uint cellOf(BlockPoints points, uint k) {
  uint cell = 0u;
  [[unroll]] for (uint i = 0u; i < kBlockPoints; ++i) cell = i == k ? points.cells[i] : cell;
  return cell;
}

/// Which points may have something before them, by the marks of coarse cells: most have not.
/// @param wanted  the points that are asked for, a bit each
uint findDoubtful(uint light_index, LightRecord light, BlockPoints points, uint wanted) {
  uint doubtful = 0u;
  do {
    uint cell = wanted != 0u ? cellOf(points, uint(findLSB(wanted))) : 0u, same = 0u;
    [[unroll]] for (uint k = 0u; k < kBlockPoints; ++k)
      same |= coarsen(points.cells[k]) == coarsen(cell) ? 1u << k : 0u;
    GridLists lists = listsOf(light, cell);
    bool is_empty = fetchHead(lists.coarse) == kNowhere && fetchHead(lists.mark) == kNowhere;
    doubtful |= is_empty ? 0u : same & wanted;
    wanted &= ~same;
  } while (wanted != 0u);
  return doubtful;
}

/// Which points something lies before.
/// @param instance, triangle  that the points lie on: it does not shadow them
/// @param doubtful            findDoubtful
uint findShadowed(uint light_index, LightRecord light, uint instance, uint triangle, BlockPoints points,
                  uint doubtful) {
  uint wanted = doubtful, shadowed = 0u;
  uint walked = kNowhere;  // the coarse list that was
  do {
    uint cell = doubtful != 0u ? cellOf(points, uint(findLSB(doubtful))) : 0u, same = 0u;
    [[unroll]] for (uint k = 0u; k < kBlockPoints; ++k) same |= points.cells[k] == cell ? 1u << k : 0u;
    GridLists lists = listsOf(light, cell);
    uvec2 heads = uvec2(fetchHead(lists.fine), fetchHead(lists.coarse));
    if (lists.coarse == walked) heads.y = kNowhere;
    if (doubtful == 0u) heads = uvec2(kNowhere);
    walked = lists.coarse;
    uint next = heads.x != kNowhere ? heads.x : heads.y;
    if (heads.x == kNowhere) heads.y = kNowhere;
    bool is_node = next != kNowhere;
    next = is_node ? next : 0u;
    do {
      GridNode node = fetchNode(next);
      bool own = (node.instance & ~kNodePassable) == instance && node.triangle == triangle;
      uint behind = findBehind(node, light, points);
      shadowed |= is_node && !own ? behind : 0u;
      next = is_node ? node.next : kNowhere;
      bool is_last = next == kNowhere;
      next = is_last ? heads.y : next;
      heads.y = is_last ? kNowhere : heads.y;
    } while (next != kNowhere && (wanted & ~shadowed) != 0u);
    doubtful &= ~(same | shadowed);
  } while (doubtful != 0u);
  return shadowed & wanted;
}

#endif
