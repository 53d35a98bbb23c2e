// The analytic daylight sky, baked to an environment image.
#pragma once

#include "core/image/image.h"
#include "scene/scene_data.h"

namespace nephroid {

struct SkySettings {
  float turbidity = 3.0F;       ///< haze, in [1.7, 10]
  float elevation_deg = 45.0F;  ///< of the sun, in [0, 90]
  float azimuth_deg = 0.0F;     ///< of the sun: 0 is +Z, 90 is +X
  float irradiance = 1.5F;      ///< W/m², mean of R, G and B on a horizontal plane, >= 0
  vec3 tint{1.0F};              ///< multiplies every direction after the irradiance was set
};

/// Radiance of the sky without the sun's disc, `height × width × 3`, lat-long as `Environment` lays it out, W/m²/sr.
/// The integral of radiance × cosine over the upper half of this very image is `irradiance`; the lower half is the
/// constant radiance of ground of albedo 0.2 under it.
/// @see [preetham-daylight] appendix A.2 (zenith values, Perez coefficients)
Image renderSky(const SkySettings& settings, int width, int height);

/// `renderSky` at 512 × 256.
Environment makeSky(const SkySettings& settings);

}  // namespace nephroid
