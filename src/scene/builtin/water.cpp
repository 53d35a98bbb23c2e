#include "scene/builtin/water.h"

#include <algorithm>
#include <cmath>

#include "scene/builtin/hash.h"

namespace nephroid {
namespace {

constexpr double kTau = 6.283185307179586476925;
/// After this many lifetimes a ring is below 0.1 % of its height and is left out.
constexpr double kLifetimesKept = 7.0;
/// Where the packet exp(−s²) has fallen to 2e-16: nearer, the cut would be a step that the slopes do not know of.
constexpr double kPacketReach = 6.0;

}  // namespace

std::vector<PlaneWave> makePlaneWaves(int count, double amplitude, double wavelength, int seed) {
  constexpr double kShorter = 0.7, kSpread = 60.0 / 360.0 * kTau;
  std::vector<PlaneWave> waves{{amplitude, wavelength, 0.0, 0.0}};
  for (int i = 1; i < count; ++i) {
    const double factor = std::pow(kShorter, i);
    waves.push_back({amplitude * factor, wavelength * factor, kSpread * (2.0 * hashToUnit(seed, i, 0) - 1.0),
                     kTau * hashToUnit(seed, i, 1)});
  }
  return waves;
}

HeightSample evaluateWaves(const std::vector<PlaneWave>& waves, double x, double z) {
  HeightSample sum;
  for (const PlaneWave& wave : waves) {
    const double k = kTau / wave.wavelength, kx = k * std::cos(wave.angle), kz = k * std::sin(wave.angle);
    const double argument = kx * x + kz * z + wave.phase;
    sum.y += wave.amplitude * std::cos(argument);
    const double slope = -wave.amplitude * std::sin(argument);
    sum.dy_dx += slope * kx;
    sum.dy_dz += slope * kz;
  }
  return sum;
}

PlopSurface::PlopSurface(const PlopSettings& settings, double time) : settings_(settings) {
  if (settings.rate <= 0.0) return;
  // Drop i falls at a random moment of the i-th interval of length 1/rate; i may be negative.
  const auto last = static_cast<std::int64_t>(std::floor(time * settings.rate));
  const auto kept = static_cast<std::int64_t>(std::ceil(kLifetimesKept * settings.lifetime * settings.rate)) + 1;
  for (std::int64_t i = last - kept; i <= last; ++i) {
    const double age = time - (static_cast<double>(i) + hashToUnit(settings.seed, i, 0)) / settings.rate;
    if (age <= 0.0) continue;
    plops_.push_back({settings.size_x * (hashToUnit(settings.seed, i, 1) - 0.5),
                      settings.size_z * (hashToUnit(settings.seed, i, 2) - 0.5), age});
  }
}

HeightSample PlopSurface::at(double x, double z) const {
  HeightSample sum;
  const double k = kTau / settings_.wavelength;
  // The distance is softened within a quarter of a wavelength: its slope is then smooth at the centre too.
  const double soft = 0.25 * settings_.wavelength, width = settings_.wavelength;
  for (const Plop& plop : plops_) {
    const double dx = x - plop.x, dz = z - plop.z;
    const double r = std::sqrt(dx * dx + dz * dz + soft * soft);
    const double front = r - settings_.speed * plop.age - soft, s = front / width;
    if (std::abs(s) > kPacketReach) continue;
    // The packet exp(−s²) cos(k·front) rises out of nothing and fades with age; it thins as 1/√r as it spreads.
    const double rise = 1.0 - std::exp(-plop.age * settings_.speed / soft);
    const double height = settings_.amplitude * rise * std::exp(-plop.age / settings_.lifetime) *
                          std::sqrt(settings_.wavelength / (settings_.wavelength + r)) * std::exp(-s * s);
    const double cosine = std::cos(k * front);
    sum.y += height * cosine;
    const double dy_dr =
        height * (cosine * (-2.0 * s / width - 0.5 / (settings_.wavelength + r)) - k * std::sin(k * front));
    sum.dy_dx += dy_dr * dx / r;
    sum.dy_dz += dy_dr * dz / r;
  }
  return sum;
}

}  // namespace nephroid
