// The cube of views about a point light: which one shows a direction, and where. For C++ and GLSL.
#ifndef NEPHROID_CUBE_SHARED_H
#define NEPHROID_CUBE_SHARED_H

#include "core/optics/bridge.shared.h"

NEPHROID_NAMESPACE_BEGIN

/// A place on one of the cube's views, as makeCubeView of frame/view.h draws it.
struct CubePlace {
  uint face;    // along +x, −x, +y, −y, +z, −z
  float x;      // times `depth`; in [-depth, depth]
  float y;      // likewise, down
  float depth;  // along the view, >= 0
};

/// @param v  from the middle of the cube, of any length; of 0 it is a place of depth 0
NEPHROID_FN CubePlace placeOnCube(vec3 v) {
  float ax = abs(v.x), ay = abs(v.y), az = abs(v.z);
  bool along_x = ax >= ay && ax >= az;
  bool along_y = !along_x && ay >= az;
  float along = along_x ? v.x : (along_y ? v.y : v.z);
  float side = along_x ? v.z : (along_y ? v.x : -v.x);
  CubePlace place;
  place.face = (along_x ? 0u : (along_y ? 2u : 4u)) + (along >= 0.0f ? 0u : 1u);
  place.x = along >= 0.0f ? side : -side;
  place.y = along_y ? -v.z : -v.y;
  place.depth = abs(along);
  return place;
}

NEPHROID_NAMESPACE_END

#endif
