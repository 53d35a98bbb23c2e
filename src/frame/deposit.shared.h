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
  uint level_count;      // FluxLevels::count
  // Of views that share surfaces (frame/receiver_map.shared.h), which are squares about one place.
  uint axes;
  uint views_by_axis;
  float texels_per_metre;
  vec3 centre;
};

/// Levels of FluxLevels at the most: a texel of the last one is 256 of the picture's wide.
NEPHROID_CONST uint kMostLevels = 8u;

// What a texel of a level shows.
NEPHROID_CONST uint kNodeMixed = 0u;    // several surfaces, or the picture's border
NEPHROID_CONST uint kNodeSurface = 1u;  // one
NEPHROID_CONST uint kNodeNothing = 2u;

// Of a texel of a level: whether the next ones along rows and columns show the same surface.
NEPHROID_CONST uint kLinkAcross = 1u;
NEPHROID_CONST uint kLinkDown = 2u;

/// Parts of a picture in which it is counted how much of it cells cover.
NEPHROID_CONST uint kLayerParts = 512u;

/// Groups of threads that go through a list.
NEPHROID_CONST uint kListGroups = 256u;

/// What passes over cells leave to each other; lists follow.
struct DepositListsHead {
  uint whole_count;
  uint torn_count;
  uint large_count;
  uint large_parts;  // of the picture that large cells cover together, kLayerParts each layer
};

/// Groups of threads of a dispatch.
struct DepositGroups {
  uint x;
  uint y;
  uint z;
};

/// Whether there is anything in the levels of a map, and the groups of the passes over them: none if there is not.
struct FluxLevelsState {
  uint is_used;                              // flux may be in them, and what they show is known
  DepositGroups describe[kMostLevels + 1u];  // of the present deposit: [k] finds out what level k + 1 shows
  DepositGroups sum[kMostLevels];            // [k] adds level k + 1 to level k
  DepositGroups exact;                       // over large pieces, if they are deposited on the picture itself,
  DepositGroups at_levels;                   // or at levels
};

struct FluxLevelsPush {
  uint width;  // texels of each picture
  uint height;
  uint level_count;
  uint level;
  uint layer_count;  // of each view, in the images of surfaces
  uint flux_layers;  // of each view that have flux
  uint picture_count;
};

NEPHROID_NAMESPACE_END

#endif
