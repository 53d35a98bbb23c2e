// What photons leave behind: splats on the picture, and the account of their flux.
#pragma once

#include <cstdint>
#include <vector>

#include "core/math.h"
#include "techniques/ledger.h"
#include "trace/photon_grid.h"

namespace nephroid {

/// What one photon adds to one pixel.
struct Splat {
  std::uint32_t pixel;
  bool is_caustic;  ///< else indirect
  vec3 radiance;    ///< W/m²/sr × emitted count
  vec3 irradiance;  ///< W/m² × emitted count
};

/// What a run of photons left behind.
struct PhotonTally {
  Ledger ledger;  ///< sums of flux × emitted count
  std::uint64_t rays = 0;
  std::uint64_t not_finite = 0;
  std::vector<Splat> splats;
  std::vector<GridPhoton> deposits;  ///< caustic photons where they ended, if they are kept; flux × emitted count
};

}  // namespace nephroid
