// The floor of a sinusoidal sea under a sun at the zenith.
//
// The surface is y = d + A cos kx. Light falls straight down; at x the surface is tilted by β, tan β = |slope|, so it
// meets the water at θ = β and is bent to θ', sin β = n sin θ': in the water it runs at β − θ' to the vertical, towards
// the crest. It lands at
//
//   X(x) = x + y'(x)/|y'(x)| · (d + A cos kx) · tan(β − θ'),
//
// and the floor, which lies in the water, gets
//
//   E(X) = Σ over all x with X(x) = X of  E⊥ (1 − R(β)) / |dX/dx|.
//
// dX/dx = 0 are the folds: the caustic lines, from a depth of about n / ((n − 1) A k²) on. Intervals of x are mapped to
// intervals of X and gathered in bins, so folds are finite and counted with both of their branches.
#pragma once

#include <fmt/format.h>

#include "scene/load.h"
#include "support/closed_form.h"
#include "support/closed_form_render.h"

namespace nephroid::closed_form {

struct WaveCase {
  double depth = 0.5, amplitude = 0.02, wavelength = 0.5, ior = 1.33;
  double size = 1.0;  ///< of the patch of water, two wavelengths
};

inline double waveLanding(const WaveCase& c, double x) {
  const double k = 2.0 * kPiD / c.wavelength, slope = -c.amplitude * k * std::sin(k * x);
  const double tilt = std::atan(std::abs(slope)), bent = tilt - std::asin(std::sin(tilt) / c.ior);
  return x + std::copysign(1.0, slope) * (c.depth + c.amplitude * std::cos(k * x)) * std::tan(bent);
}

/// E / E⊥ over one wavelength about x = 0.
inline std::vector<double> waveIrradiance(const WaveCase& c, std::size_t bins) {
  constexpr int kPieces = 200'000;  // per wavelength
  const double k = 2.0 * kPiD / c.wavelength, step = c.wavelength / kPieces;
  Profile profile(-0.5 * c.wavelength, 0.5 * c.wavelength, bins);
  const int reach = 2 * kPieces;  // light from two wavelengths to either side; farther none comes
  double last = waveLanding(c, -reach * step);
  for (int i = -reach; i < reach; ++i) {
    const double next = waveLanding(c, (i + 1) * step);
    const double slope = c.amplitude * k * std::sin(k * (i + 0.5) * step);
    const double share = 1.0 - fresnelReflectance(1.0 / std::sqrt(1.0 + slope * slope), 1.0, c.ior);
    profile.deposit(last, next, share * step);
    last = next;
  }
  return profile.perStrip(1.0);
}

/// Depth at which the crest focuses: for small slopes X ≈ x + d y' (n − 1)/n, so dX/dx = 1 − d A k² (n − 1)/n at x = 0.
inline double waveFocalDepth(const WaveCase& c) {
  const double k = 2.0 * kPiD / c.wavelength;
  return c.ior / ((c.ior - 1.0) * c.amplitude * k * k);
}

inline SceneData makeWaveScene(const WaveCase& c, int segments) {
  return loadScene(
      fmt::format("builtin:wave?waves=1&irradiance=1&size={}&depth={}&amplitude={}&wavelength={}&ior={}&"
                  "segments={}&floor-size={}",
                  c.size, c.depth, c.amplitude, c.wavelength, c.ior, segments, 2.0 * c.size));
}

/// One wavelength, 512 pixels wide, in the middle, and nearly as long as the patch: light is
/// turned by less than 4 degrees, across the waves only, so that nothing of the patch's ends shows.
inline PlaneView waveView(const WaveCase& c) {
  PlaneView view;
  view.distance = 0.5 * c.depth;
  view.width = c.wavelength;
  view.columns = 512;
  view.rows = static_cast<int>(0.9 * c.size / view.pixelSize());
  return view;
}

}  // namespace nephroid::closed_form
