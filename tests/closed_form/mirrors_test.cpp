#include "closed_form/mirrors.h"

#include <gtest/gtest.h>

#include "closed_form/optics.h"
#include "closed_form/profile.h"

namespace nephroid::closed_form {
namespace {

/// Flux-weighted mean distance from the picture's centre, m.
double meanRadius(const PlanePicture& picture) {
  double sum = 0.0, moment = 0.0;
  for (int y = 0; y < picture.irradiance.height; ++y) {
    for (int x = 0; x < picture.irradiance.width; ++x) {
      const double value = static_cast<double>(picture.irradiance.at(x, y)[0]);
      sum += value;
      moment += value * std::hypot(x + 0.5 - 0.5 * picture.irradiance.width, y + 0.5 - 0.5 * picture.irradiance.height);
    }
  }
  return moment / sum * picture.view.pixelSize();
}

TEST(Paraboloid, SendsAllItsLightThroughTheFocus) {
  const ParaboloidCase c;
  // The window is a fifth of the receiver: what would miss the focus by 2 mm, a 500th of the aperture, would be missed.
  const PlaneView view = receiverView(c.focal_length, 0.2 * c.receiver, 64);
  const PlanePicture picture = renderPlane(makeParaboloidScene(c, 256), view, std::uint64_t{1} << 18);
  const double predicted = paraboloidFlux(c), measured = picture.flux().x, spot = meanRadius(picture);
  RecordProperty("relative_error", fmt::format("{:.6f}", measured / predicted - 1.0));
  RecordProperty("spot_over_aperture", fmt::format("{:.2e}", spot / (c.x1 - c.x0)));
  EXPECT_NEAR(measured / predicted, 1.0, 2e-3);
  EXPECT_LE(spot, 1e-4 * (c.x1 - c.x0)) << "a pixel is 0.6e-4";
  EXPECT_LE(worstResidual(picture.ledgers), 1e-5);
}

TEST(SphericalMirror, CrossesTheAxisWhereTheFormulaSays) {
  // A narrow zone at a time, caught on two planes before its crossing: a straight line through both radii.
  double worst = 0.0;
  for (const double h : {0.1, 0.3, 0.5}) {
    double radii[2], planes[2] = {0.30, 0.38};
    for (int i = 0; i < 2; ++i) {
      const SphericalMirrorCase c{.h0 = h - 0.002, .h1 = h + 0.002, .plane = planes[i], .receiver_radius = 0.2};
      // Receivers wider than the zone would shade it: as wide as the light on them, and some.
      SphericalMirrorCase fitted = c;
      fitted.receiver_radius = std::min(1.2 * sphericalLanding(c, h), 0.95 * h);
      const PlaneView view = receiverView(c.plane, 2.0 * fitted.receiver_radius, 512);
      const PlanePicture picture = renderPlane(makeSphericalMirrorScene(fitted, 8, 1024), view, std::uint64_t{1} << 16);
      EXPECT_LE(worstResidual(picture.ledgers), 1e-5);
      radii[i] = meanRadius(picture);
    }
    const double crossing = planes[0] + (planes[1] - planes[0]) * radii[0] / (radii[0] - radii[1]);
    EXPECT_NEAR(crossing, sphericalCrossing(1.0, h), 1e-3) << "h = " << h;
    worst = std::max(worst, std::abs(crossing - sphericalCrossing(1.0, h)));
  }
  RecordProperty("error_over_radius", fmt::format("{:.2e}", worst));
}

TEST(SphericalMirror, SpreadsItsFocusIntoTheAberrationDiscToTwoPercent) {
  // In the paraxial focal plane marginal rays land farthest out: r(0.5) = 0.134, of which the receiver catches the
  // inner 0.03.
  const SphericalMirrorCase c;
  const PlaneView view = receiverView(c.plane, 2.0 * c.receiver_radius, 1024);
  const PlanePicture picture = renderPlane(makeSphericalMirrorScene(c, 256, 512), view, std::uint64_t{1} << 20);
  const double error = relativeL1(picture.ringMeans(c.receiver_radius, 64), sphericalIrradiance(c, 64));
  RecordProperty("relative_l1", fmt::format("{:.6f}", error));
  EXPECT_LE(error, 0.02);
  EXPECT_LE(worstResidual(picture.ledgers), 1e-5);
}

TEST(MirrorFormula, FocusesParaxialRaysAtHalfTheRadius) {
  EXPECT_NEAR(sphericalCrossing(2.0, 1e-6), 1.0, 1e-9);
  // At 60 degrees the reflected ray returns through the lowest point: an equilateral triangle.
  EXPECT_NEAR(sphericalCrossing(2.0, 2.0 * std::sin(radiansD(60.0))), 0.0, 1e-12);
}

}  // namespace
}  // namespace nephroid::closed_form
