#include "closed_form/mirrors.h"

#include <gtest/gtest.h>

#include "closed_form/optics.h"
#include "closed_form/profile.h"

namespace nephroid::closed_form {
namespace {

TEST(Paraboloid, SendsAllItsLightThroughTheFocus) {
  const ParaboloidCase c;
  // The window is a fifth of the receiver: what would miss the focus by 2 mm, a 500th of the aperture, would be missed.
  const PlaneView view = receiverView(c.focal_length, 0.2 * c.receiver, 64);
  const PlanePicture picture = renderPlane(makeParaboloidScene(c, 256), view, std::uint64_t{1} << 18);
  const double predicted = paraboloidFlux(c), measured = picture.flux().x, spot = picture.meanRadius();
  RecordProperty("relative_error", fmt::format("{:.6f}", measured / predicted - 1.0));
  RecordProperty("spot_over_aperture", fmt::format("{:.2e}", spot / (c.x1 - c.x0)));
  EXPECT_NEAR(measured / predicted, 1.0, 2e-3);
  EXPECT_LE(spot, 1e-4 * (c.x1 - c.x0)) << "a pixel is 0.6e-4";
  EXPECT_LE(worstResidual(picture.ledgers), 1e-5);
}

TEST(SphericalMirror, CrossesTheAxisWhereTheFormulaSays) {
  double worst = 0.0;
  for (const double h : {0.1, 0.3, 0.5}) {
    const double crossing = measureCrossing(h, [](const SceneData& scene, const PlaneView& view, const auto&) {
      PlanePicture picture = renderPlane(scene, view, std::uint64_t{1} << 16);
      EXPECT_LE(worstResidual(picture.ledgers), 1e-5);
      return picture;
    });
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
