#include "closed_form/wave.h"

#include <fmt/format.h>

#include <cmath>

#include "closed_form/optics.h"
#include "closed_form/profile.h"
#include "scene/load.h"

namespace nephroid::closed_form {

double waveLanding(const WaveCase& c, double x) {
  const double k = 2.0 * kPiD / c.wavelength, slope = -c.amplitude * k * std::sin(k * x);
  const double tilt = std::atan(std::abs(slope)), bent = tilt - std::asin(std::sin(tilt) / c.ior);
  return x + std::copysign(1.0, slope) * (c.depth + c.amplitude * std::cos(k * x)) * std::tan(bent);
}

std::vector<double> waveIrradiance(const WaveCase& c, std::size_t bins) {
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

double waveFocalDepth(const WaveCase& c) {
  const double k = 2.0 * kPiD / c.wavelength;
  return c.ior / ((c.ior - 1.0) * c.amplitude * k * k);
}

SceneData makeWaveScene(const WaveCase& c, int segments) {
  return loadScene(
      fmt::format("builtin:wave?waves=1&irradiance=1&size={}&depth={}&amplitude={}&wavelength={}&ior={}&"
                  "segments={}&floor-size={}",
                  c.size, c.depth, c.amplitude, c.wavelength, c.ior, segments, 2.0 * c.size));
}

PlaneView waveView(const WaveCase& c) {
  PlaneView view;
  view.distance = 0.5 * c.depth;
  view.width = c.wavelength;
  view.columns = 512;
  view.rows = static_cast<int>(0.9 * c.size / view.pixelSize());
  return view;
}

}  // namespace nephroid::closed_form
