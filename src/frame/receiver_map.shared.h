// How shaders find a place in the map of what falls on receivers (frame/receiver_map.h).
#ifndef NEPHROID_RECEIVER_MAP_SHARED_H
#define NEPHROID_RECEIVER_MAP_SHARED_H

#include "core/optics/bridge.shared.h"

NEPHROID_NAMESPACE_BEGIN

/// Least cosine between the way to a view and the normal of what it shows. Every surface faces some axis by 1/√3 or
/// more; a cell of photons goes to one view, and on a surface that bends by up to 18° more all of it is shown there.
/// The less, the longer the surface that a texel covers.
NEPHROID_CONST float kLeastFacing = 0.3f;

/// Axes are numbered +x, −x, +y, −y, +z, −z. Which of them view v looks against, and which view looks against an axis,
/// is kept in 4 bits each; kNoView: none does.
NEPHROID_CONST uint kNoView = 15u;

/// Coordinates of a place as seen along an axis of x, y, z (0, 1, 2): right and down on the picture, and along the
/// axis.
NEPHROID_FN vec3 seenAlong(uint axis, vec3 v) {
  if (axis == 0u) return vec3(v.y, v.z, v.x);
  if (axis == 1u) return vec3(v.z, v.x, v.y);
  return v;
}

struct ReceiverMapHead {
  float irradiance;  // W/m² of a step of the flux in a texel whose surface faces the view
  float texel;       // side of a texel, m
  uint pad_0;
  uint pad_1;
};

/// A view along an axis.
struct ReceiverView {
  vec4 row_x;  // place in its picture, in texels from the corner: dot(row, vec4(place, 1))
  vec4 row_y;
  vec3 forward;
  float pad;
};

NEPHROID_NAMESPACE_END

#endif
