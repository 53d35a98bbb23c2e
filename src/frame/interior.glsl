// Which solids a path is inside of, as trace/interior.h has it, for up to four of them.
//
// The list is kept in the order in which they rule: by priority, among equals the one entered last first. So the medium
// at a place is that of its first entry.
#ifndef NEPHROID_INTERIOR_GLSL
#define NEPHROID_INTERIOR_GLSL

#include "frame/tables.glsl"

struct Interior {
  uvec4 solids;      // and 1; 0 at the end
  uvec4 materials;
  ivec4 priorities;
};

const Interior kInTheOpen = Interior(uvec4(0u), uvec4(kNowhere), ivec4(-0x7FFFFFFF));

bool contains(Interior interior, uint solid) { return any(equal(interior.solids, uvec4(solid + 1u))); }

bool rules(Interior interior, uint solid) { return interior.solids.x == solid + 1u; }

/// Material that fills the place, leaving out a solid (kNowhere: none); kNowhere in the open.
uint mediumOf(Interior interior, uint except) {
  if (interior.solids.x != except + 1u) return interior.materials.x;
  if (interior.solids.y != except + 1u) return interior.materials.y;
  return interior.solids.z != except + 1u ? interior.materials.z : interior.materials.w;
}

/// @return  what it was if the list is full: `isFull` tells before
Interior enter(Interior now, uint solid, uint material, int priority) {
  // The first that it comes before, and all behind, move on.
  bvec4 moves = lessThanEqual(now.priorities, ivec4(priority));
  Interior next = now;
  next.solids.yzw = mix(now.solids.yzw, now.solids.xyz, moves.xyz);
  next.materials.yzw = mix(now.materials.yzw, now.materials.xyz, moves.xyz);
  next.priorities.yzw = mix(now.priorities.yzw, now.priorities.xyz, moves.xyz);
  int place = moves.x ? 0 : moves.y ? 1 : moves.z ? 2 : 3;
  bvec4 here = equal(ivec4(place), ivec4(0, 1, 2, 3));
  next.solids = mix(next.solids, uvec4(solid + 1u), here);
  next.materials = mix(next.materials, uvec4(material), here);
  next.priorities = mix(next.priorities, ivec4(priority), here);
  return next;
}

bool isFull(Interior interior) { return interior.solids.w != 0u; }

/// Without the latest entry of the solid, if there is one.
Interior leave(Interior now, uint solid) {
  bvec4 here = equal(now.solids, uvec4(solid + 1u));
  // From the first that is it, all behind move up.
  bvec4 moves = bvec4(here.x, here.x || here.y, here.x || here.y || here.z, any(here));
  Interior next;
  next.solids = mix(now.solids, uvec4(now.solids.yzw, 0u), moves);
  next.materials = mix(now.materials, uvec4(now.materials.yzw, kNowhere), moves);
  next.priorities = mix(now.priorities, ivec4(now.priorities.yzw, -0x7FFFFFFF), moves);
  return next;
}

/// What a path finds at the boundary of a solid, or on what is none.
struct Boundary {
  uint from;      // material that fills the side that the path comes from; kNowhere: vacuum
  uint to;        // and the one behind
  bool is_event;  // false: hidden inside a solid that rules; the path goes straight on
};

/// @param entering  the path meets the outer side of the surface
Boundary boundaryAt(Interior interior, uint solid, uint material, int priority, bool entering) {
  if (entering) return Boundary(mediumOf(interior, kNowhere), material, priority >= interior.priorities.x);
  // Not in the list: the path started inside, or the solid is open. Then it ruled all along.
  bool listed = contains(interior, solid);
  return Boundary(material, mediumOf(interior, solid), !listed || rules(interior, solid));
}

#endif
