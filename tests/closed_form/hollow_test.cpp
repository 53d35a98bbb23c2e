#include "closed_form/hollow.h"

#include <gtest/gtest.h>

#include "closed_form/optics.h"
#include "closed_form/profile.h"

namespace nephroid::closed_form {
namespace {

constexpr int kSegments = 1024;
constexpr std::uint64_t kPhotons = std::uint64_t{1} << 21;
constexpr std::size_t kBins = 64;

/// A thick shell, which has all three kinds of rays, and a thin one, which is totally reflected at its rim.
HollowCase thickCase() { return {{.gap = 0.05, .view_radius = 0.1}, 0.025}; }
HollowCase thinCase() { return {{.gap = 0.05, .view_radius = 0.1}, 0.045}; }

double compareProfile(const HollowCase& c) {
  const PlanePicture picture = renderPlane(makeHollowScene(c, kSegments), ballView(c.ball, 1024), kPhotons);
  EXPECT_LE(worstResidual(picture.ledgers), 1e-5);
  const double error = relativeL1(picture.ringMeans(c.ball.view_radius, kBins), hollowIrradiance(c, kBins));
  ::testing::Test::RecordProperty("relative_l1", fmt::format("{:.6f}", error));
  return error;
}

TEST(Hollow, DrawsTheProfileOfAThickShellToTwoPercent) { EXPECT_LE(compareProfile(thickCase()), 0.02); }

TEST(Hollow, DrawsTheProfileOfAThinShellToTwoPercent) { EXPECT_LE(compareProfile(thinCase()), 0.02); }

TEST(HollowFormula, WithoutACavityIsTheBalls) {
  const HollowCase c{{.gap = 0.05, .view_radius = 0.1}, 1e-9};
  EXPECT_LE(relativeL1(hollowIrradiance(c, kBins), ballIrradiance(c.ball, kBins)), 2e-3);
}

TEST(HollowFormula, AVeryThinShellIsTwoPanes) {
  // Straight ahead goes what two panes let through, each with the reflections between its faces: 1 − R′ = (1 − R)/(1 +
  // R).
  const HollowCase c{{.gap = 0.05, .view_radius = 0.1}, 0.05 - 1e-7};
  for (const double h : {0.005, 0.03, 0.04}) {
    double straight_on = 0.0;
    for (const auto& [sequence, landing] : traceHollow(c, h))
      if (std::abs(landing.radius - h) < 1e-5) straight_on += landing.share;
    const double r = fresnelReflectance(std::sqrt(1.0 - h * h / (0.05 * 0.05)), 1.0, 1.5), pane = (1.0 - r) / (1.0 + r);
    EXPECT_NEAR(straight_on, pane * pane, 1e-3) << h;
  }
}

TEST(HollowFormula, ConservesFlux) {
  const HollowCase c{{.gap = 0.05, .view_radius = 50.0}, 0.03};
  const std::vector<double> e = hollowIrradiance(c, 1000);
  double flux = 0.0;
  for (std::size_t i = 0; i < e.size(); ++i) flux += e[i] * kPiD * (2.0 * static_cast<double>(i) + 1.0) * 0.05 * 0.05;
  const double whole = kPiD * c.ball.radius * c.ball.radius;
  EXPECT_LT(flux, whole);
  EXPECT_GT(flux, 0.75 * whole);
}

}  // namespace
}  // namespace nephroid::closed_form
