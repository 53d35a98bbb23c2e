// Azimuth and elevation of a light in the sky, as people give them.
#pragma once

#include <cmath>

#include "core/math.h"

namespace nephroid {

/// The unit vector towards where light comes from: azimuth 0 is +Z, 90 is +X; elevation 90 is +Y. Degrees.
/// Computed in double so that 90 and 45 degrees come out exact to the last bit or two.
inline vec3 directionTowards(float azimuth_deg, float elevation_deg) {
  constexpr double kRadiansPerDegree = 3.14159265358979323846 / 180.0;
  const double azimuth = azimuth_deg * kRadiansPerDegree, elevation = elevation_deg * kRadiansPerDegree;
  // cos(90 deg) is 6e-17, not 0: a sun at the zenith should stand exactly there.
  const double horizontal = std::abs(elevation_deg) == 90.0F ? 0.0 : std::cos(elevation);
  return vec3(dvec3(std::sin(azimuth) * horizontal, std::sin(elevation), std::cos(azimuth) * horizontal));
}

}  // namespace nephroid
