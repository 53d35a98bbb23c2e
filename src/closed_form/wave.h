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

#include <cstddef>
#include <vector>

#include "closed_form/plane_picture.h"

namespace nephroid::closed_form {

struct WaveCase {
  double depth = 0.5, amplitude = 0.02, wavelength = 0.5, ior = 1.33;
  double size = 1.0;  ///< of the patch of water, two wavelengths
};

double waveLanding(const WaveCase& c, double x);

/// E / E⊥ over one wavelength about x = 0.
std::vector<double> waveIrradiance(const WaveCase& c, std::size_t bins);

/// Depth at which the crest focuses: for small slopes X ≈ x + d y' (n − 1)/n, so dX/dx = 1 − d A k² (n − 1)/n at x = 0.
double waveFocalDepth(const WaveCase& c);

SceneData makeWaveScene(const WaveCase& c, int segments);

/// One wavelength, 512 pixels wide, in the middle, and nearly as long as the patch: light is
/// turned by less than 4 degrees, across the waves only, so that nothing of the patch's ends shows.
PlaneView waveView(const WaveCase& c);

}  // namespace nephroid::closed_form
