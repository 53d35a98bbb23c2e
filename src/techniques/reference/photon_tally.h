// What photons leave behind: splats on the picture, and the account of their flux.
#pragma once

#include <cstdint>
#include <vector>

#include "core/math.h"
#include "techniques/ledger.h"
#include "techniques/reference/vcm/light_vertex.h"
#include "trace/photon_grid.h"

namespace nephroid {

/// What one photon adds to one pixel.
struct Splat {
  std::uint32_t pixel;
  bool is_caustic;  ///< else indirect
  vec3 radiance;    ///< W/m²/sr × emitted count
  vec3 irradiance;  ///< W/m² × emitted count
};

/// The same, spread over an ellipse of pixels (see footprint_splat.h).
struct FootprintSplat {
  Splat splat;                         ///< as if the photon's own pixel took all
  vec2 film;                           ///< centre, pixels
  vec2 reach;                          ///< half-width and half-height, pixels
  float xx, xy, yy;                    ///< r² = xx·dx² + 2·xy·dx·dy + yy·dy²
  int steps;                           ///< points along each side of a pixel
  std::uint32_t instance;              ///< on which the photon ended
  vec3 normal;                         ///< of the plane there
  float plane;                         ///< normal · position, m
  float thickness;                     ///< how far off the plane a pixel's surface may be, m
  float weight_scale;                  ///< makes all weights sum to one
  float place_share, direction_share;  ///< of the light's extent, and of its directions, over which it is spread
};

/// What a run of photons left behind.
struct PhotonTally {
  Ledger ledger;  ///< sums of flux × emitted count
  std::uint64_t rays = 0;
  std::uint64_t not_finite = 0;
  std::vector<Splat> splats;
  std::vector<FootprintSplat> footprints;
  std::vector<VcmPhoton> vcm_photons;               ///< where they ended, for vertex connection and merging
  std::vector<VcmLightVertex> vcm_rough, vcm_ends;  ///< interfaces on the way, and ends, that may be connected
  // Photons where they met a diffuse surface, if they are kept; flux × emitted count.
  std::vector<GridPhoton> caustic_deposits;   ///< for the first time
  std::vector<GridPhoton> indirect_deposits;  ///< later
};

}  // namespace nephroid
