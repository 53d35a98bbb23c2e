// Water surfaces as smooth functions: waves that run on for ever and rings of drops, with exact slopes.
#pragma once

#include <cstdint>
#include <vector>

#include "core/math.h"
#include "scene/builtin/shapes.h"

namespace nephroid {

/// One plane wave: amplitude · cos(2π (x cos α + z sin α) / wavelength + phase).
struct PlaneWave {
  double amplitude = 0, wavelength = 1;  ///< m
  double angle = 0, phase = 0;           ///< rad; angle 0 runs along +X
};

/// `count` >= 1 waves of equal steepness. The first is exactly `amplitude` · cos(2π x / wavelength): a crest at x = 0,
/// the same for all z. Each further one is shorter by a factor of about 0.7 and runs within 60° of the first,
/// with direction and phase from `seed`.
std::vector<PlaneWave> makePlaneWaves(int count, double amplitude, double wavelength, int seed);

/// Sum of the waves about y = 0.
HeightSample evaluateWaves(const std::vector<PlaneWave>& waves, double x, double z);

/// Rings that spread from drops ("plops") which fall at random places.
struct PlopSettings {
  double size_x = 1, size_z = 1;  ///< m, drops fall into |x| <= size_x/2, |z| <= size_z/2
  double rate = 1;                ///< drops per second
  double amplitude = 0.01;        ///< m, height of a ring as it starts
  double wavelength = 0.3;        ///< m
  double speed = 0.5;             ///< m/s
  double lifetime = 2;            ///< s, in which a ring falls to 1/e
  int seed = 0;
};

/// A surface at one time. The pool has been rained on for ever: there are rings at time 0 too.
class PlopSurface {
 public:
  PlopSurface(const PlopSettings& settings, double time);
  HeightSample at(double x, double z) const;

 private:
  struct Plop {
    double x, z, age;
  };
  PlopSettings settings_;
  std::vector<Plop> plops_;
};

}  // namespace nephroid
