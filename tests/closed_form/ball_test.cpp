#include "closed_form/ball.h"

#include <gtest/gtest.h>

#include "closed_form/optics.h"
#include "closed_form/profile.h"

namespace nephroid::closed_form {
namespace {

// 1 024 facets around: a facet is 0.006 radii wide, and its sagitta 5e-6 radii.
constexpr int kSegments = 1024;
constexpr std::uint64_t kPhotons = std::uint64_t{1} << 21;
constexpr std::size_t kBins = 64;

/// Relative L1 of the radial profile.
double compareProfile(const BallCase& c, const std::vector<std::string>& settings = {}, int columns = 1024) {
  const PlanePicture picture = renderPlane(makeBallScene(c, kSegments), ballView(c, columns), kPhotons, 1, settings);
  EXPECT_LE(worstResidual(picture.ledgers), 1e-5);
  const double error = relativeL1(picture.ringMeans(c.view_radius, kBins), ballIrradiance(c, kBins));
  ::testing::Test::RecordProperty("relative_l1", fmt::format("{:.6f}", error));
  return error;
}

TEST(Ball, DrawsTheRadialProfileBeforeItsFocusToOnePercent) {
  // The plane cuts the caustic's cusped surface: a bright ring at the fold and a peak on the axis.
  EXPECT_LE(compareProfile({.gap = 0.015, .view_radius = 0.03}), 0.01);
}

TEST(Ball, DrawsTheRadialProfileBehindItsFocusToOnePercent) {
  EXPECT_LE(compareProfile({.gap = 0.05, .view_radius = 0.1}), 0.01);
}

TEST(Ball, DrawsTheRadialProfileByVertexConnectionAndMergingToThreePercent) {
  // Kernels blur the fold.
  EXPECT_LE(compareProfile({.gap = 0.05, .view_radius = 0.1}, {"estimator=vcm"}, 256), 0.03);
}

TEST(BallFormula, PutsParaxialRaysIntoTheFocus) {
  BallCase c;
  c.gap = ballFocalDistance(c.radius, c.ior) - c.radius;
  const double theta = 1e-4, inside = std::asin(std::sin(theta) / c.ior);
  EXPECT_NEAR(*landOnPlane(c, theta, inside, 0), 0.0, 1e-12);
  // Halfway between the back of the ball and the focus the cone has half its width: h n' with the lens equation.
  c.gap *= 0.5;
  const double at_back = c.radius * std::sin(2.0 * inside - theta);
  EXPECT_NEAR(*landOnPlane(c, theta, inside, 0), 0.5 * at_back, 1e-3 * at_back);
}

TEST(BallFormula, ConservesFlux) {
  // Over a plane wide enough everything that leaves downwards lands: at most the ball's cross section.
  const BallCase c{.gap = 0.05, .view_radius = 50.0};
  const std::vector<double> e = ballIrradiance(c, 1000);
  double flux = 0.0;
  for (std::size_t i = 0; i < e.size(); ++i) flux += e[i] * kPiD * (2.0 * static_cast<double>(i) + 1.0) * 0.05 * 0.05;
  EXPECT_LT(flux, kPiD * c.radius * c.radius);
  EXPECT_GT(flux, 0.9 * kPiD * c.radius * c.radius);
}

}  // namespace
}  // namespace nephroid::closed_form
