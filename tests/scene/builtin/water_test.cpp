#include "scene/builtin/water.h"

#include <gtest/gtest.h>

#include <cmath>

namespace nephroid {
namespace {

/// Largest difference between the slopes returned and central differences of the height, over a grid.
/// The step of 1e-5 m leaves h²/6·y''' ≈ 1e-8 and rounding 1e-16/1e-5 = 1e-11.
template <class Surface>
double worstSlopeError(const Surface& surface, double extent) {
  constexpr double kStep = 1e-5;
  double worst = 0;
  for (int i = 0; i <= 40; ++i)
    for (int j = 0; j <= 40; ++j) {
      const double x = extent * (i / 40.0 - 0.5), z = extent * (j / 40.0 - 0.5);
      const HeightSample s = surface(x, z);
      const double dx = (surface(x + kStep, z).y - surface(x - kStep, z).y) / (2 * kStep);
      const double dz = (surface(x, z + kStep).y - surface(x, z - kStep).y) / (2 * kStep);
      worst = std::max({worst, std::abs(dx - s.dy_dx), std::abs(dz - s.dy_dz)});
    }
  return worst;
}

TEST(Water, WaveSlopesAreThoseOfTheHeight) {
  const std::vector<PlaneWave> waves = makePlaneWaves(8, 0.05, 0.7, 3);
  EXPECT_LT(worstSlopeError([&](double x, double z) { return evaluateWaves(waves, x, z); }, 2.0), 1e-6);
}

TEST(Water, PlopSlopesAreThoseOfTheHeight) {
  const PlopSurface surface(
      {.size_x = 4, .size_z = 4, .rate = 3, .amplitude = 0.05, .wavelength = 0.5, .speed = 0.6, .seed = 7}, 2.37);
  const auto at = [&](double x, double z) { return surface.at(x, z); };
  EXPECT_LT(worstSlopeError(at, 4.0), 1e-6);
  double highest = 0;
  for (int i = 0; i < 50; ++i) highest = std::max(highest, std::abs(at(i * 0.08 - 2, 0.1).y));
  EXPECT_GT(highest, 0.005);
  EXPECT_LT(highest, 0.5);
}

TEST(Water, PlopsMoveSmoothlyInTime) {
  const PlopSettings settings{.size_x = 4, .size_z = 4, .rate = 5, .amplitude = 0.05, .wavelength = 0.5, .seed = 7};
  // No height may jump as drops begin or are forgotten: 1 ms changes it by at most the waves' own speed × slope.
  double worst = 0;
  for (int step = 0; step < 400; ++step) {
    const double time = 0.01 * step;
    worst = std::max(worst, std::abs(PlopSurface(settings, time).at(0.3, -0.2).y -
                                     PlopSurface(settings, time + 1e-3).at(0.3, -0.2).y));
  }
  EXPECT_LT(worst, 2e-3);
}

TEST(Water, NoDropsLeaveTheWaterFlat) {
  const HeightSample s = PlopSurface({.rate = 0}, 1.0).at(0.1, 0.2);
  EXPECT_EQ(s.y, 0.0);
  EXPECT_EQ(s.dy_dx, 0.0);
}

}  // namespace
}  // namespace nephroid
