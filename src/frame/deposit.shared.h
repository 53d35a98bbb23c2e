// What the deposit of photons and C++ tell each other.
#ifndef NEPHROID_DEPOSIT_SHARED_H
#define NEPHROID_DEPOSIT_SHARED_H

#include "core/optics/bridge.shared.h"

NEPHROID_NAMESPACE_BEGIN

/// Red, green, blue.
NEPHROID_CONST uint kFluxChannels = 3u;
/// Texels along a side of what is remembered to hold flux or not.
NEPHROID_CONST uint kDepositTile = 8u;

/// Cells along a side of a square that may be deposited as one cell.
NEPHROID_CONST uint kDepositSquare = 4u;

struct DepositPush {
  uint grid_width;  // photons in a row
  uint grid_height;
  uint width;  // texels of each view's picture
  uint height;
  float steps_per_watt;  // of the whole numbers
  float splat_radius;    // texels
  uint layer_count;      // of each view, in the images of surfaces; the first is what flux is deposited on
  uint squares_across;   // of PhotonBuffer::squares; 0: there are none
  // Of views that share surfaces (frame/receiver_map.shared.h), which are squares about one place.
  uint axes;
  uint views_by_axis;
  float texels_per_metre;
  vec3 centre;
};

NEPHROID_NAMESPACE_END

#endif
