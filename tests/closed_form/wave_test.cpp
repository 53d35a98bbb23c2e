#include "closed_form/wave.h"

#include <gtest/gtest.h>

#include "closed_form/profile.h"

namespace nephroid::closed_form {
namespace {

// Some 45 % of the photons land in the view: 470 000, or 920 a column. Random numbers would leave an error of 2.6 % in
// the profile (0.8/sqrt(920)); the stratified ones of the sampler leave a fraction of it.
constexpr std::uint64_t kPhotons = std::uint64_t{1} << 20;

// Cells a 256th of the wavelength wide. Between vertices slopes are linear, so that on the floor a cell is a step of
// constant irradiance: its error is of first order in the cell's width, and greatest beyond the focus (3 % at 64
// cells).
constexpr int kCells = 512;

/// Relative L1 over a row of 512 pixels.
double compareProfile(const WaveCase& c) {
  const PlanePicture picture = renderPlane(makeWaveScene(c, kCells), waveView(c), kPhotons);
  EXPECT_LE(worstResidual(picture.ledgers), 1e-5);
  const double error = relativeL1(picture.columnMeans(), waveIrradiance(c, 512));
  ::testing::Test::RecordProperty("relative_l1", fmt::format("{:.6f}", error));
  return error;
}

TEST(Wave, LightsAShallowFloorToTwoPercent) {
  const WaveCase c{.depth = 0.5};
  ASSERT_LT(c.depth, waveFocalDepth(c));
  EXPECT_LE(compareProfile(c), 0.02);
}

TEST(Wave, DrawsTheFoldsBeyondItsFocusToTwoPercent) {
  const WaveCase c{.depth = 2.0};
  ASSERT_GT(c.depth, 1.5 * waveFocalDepth(c));
  EXPECT_LE(compareProfile(c), 0.02);
}

TEST(WaveFormula, FoldsFirstAtTheFocalDepth) {
  // A gentle wave, for which the linear estimate holds: dX/dx at the crest changes its sign there.
  WaveCase c{.amplitude = 1e-4};
  for (const double factor : {0.99, 1.01}) {
    c.depth = factor * waveFocalDepth(c);
    EXPECT_EQ(waveLanding(c, 1e-4) > 0.0, factor < 1.0);
  }
}

}  // namespace
}  // namespace nephroid::closed_form
