#include "closed_form/ring.h"

#include <gtest/gtest.h>

#include "closed_form/optics.h"
#include "closed_form/profile.h"

namespace nephroid::closed_form {
namespace {

constexpr int kSegments = 2048, kPixels = 512;

class RingCaustic : public ::testing::Test {
 protected:
  static const PlanePicture& picture() {
    static const PlanePicture kPicture =
        renderPlane(makeRingScene(RingCase{}, kSegments), ringView(RingCase{}, kPixels), std::uint64_t{1} << 22);
    return kPicture;
  }
};

TEST_F(RingCaustic, HasThePredictedProfileAlongTheAxisToThreePercent) {
  const Image predicted = ringIrradiance({}, kPixels);
  const double profile = relativeL1(axisProfile(picture().irradiance, 32), axisProfile(predicted, 32));
  const double whole = relativeL1(sumSquares(picture().irradiance), sumSquares(predicted));
  RecordProperty("relative_l1_axis", fmt::format("{:.6f}", profile));
  RecordProperty("relative_l1_plane", fmt::format("{:.6f}", whole));
  EXPECT_LE(profile, 0.03);
  EXPECT_LE(whole, 0.03) << "squares of 8 x 8 pixels";
  EXPECT_LE(worstResidual(picture().ledgers), 1e-5);
}

TEST_F(RingCaustic, IsBrightestOnTheNephroid) {
  const double distance_px = nephroidDistance({}, picture());
  RecordProperty("distance_px", fmt::format("{:.5f}", distance_px));
  EXPECT_LE(distance_px, 1.5);
}

TEST_F(RingCaustic, HasItsCuspHalfwayBetweenWallAndCentre) {
  const double cusp = cuspPosition({}, picture());
  RecordProperty("cusp_over_radius", fmt::format("{:.5f}", cusp));
  EXPECT_NEAR(cusp, -0.5, 1.5 * picture().view.pixelSize() / RingCase{}.inner_radius);
}

TEST(RingFormula, HasTheNephroidAsItsEnvelope) {
  // Neighbouring reflected rays meet on the curve.
  const RingCase c;
  const double phi = 0.6, step = 1e-5, elevation = radiansD(c.sun_elevation_deg);
  const double y = 0.5 * c.inner_radius * std::cos(phi) * std::tan(elevation);
  const dvec2 here = traceRing(c, phi, y).position, curve = nephroidPoint(c.inner_radius, phi);
  EXPECT_NEAR(here.x, curve.x, 1e-12);
  EXPECT_NEAR(here.y, curve.y, 1e-12);
  const dvec2 across = (traceRing(c, phi + step, y).position - traceRing(c, phi - step, y).position) / (2.0 * step);
  const dvec2 along(std::cos(2.0 * phi), -std::sin(2.0 * phi));
  EXPECT_NEAR(across.x * along.y - across.y * along.x, 0.0, 1e-9)
      << "the map from (φ, y) to the floor is singular here";
}

TEST(RingFormula, KeepsTheAngleFromWallToWall) {
  // A ray that falls slowly runs round inside; its reflections stay on the circle.
  RingCase c{.height = 1.0, .sun_elevation_deg = 45.0};
  for (const double phi : {0.3, 1.0, -1.2}) {
    const double chord = 2.0 * c.inner_radius * std::cos(phi);
    for (const double pieces : {1.0, 2.0, 3.0}) {
      const RingLanding landing = traceRing(c, phi, pieces * chord * (1.0 - 1e-9));
      EXPECT_NEAR(glm::length(landing.position), c.inner_radius, 1e-8) << phi << " " << pieces;
    }
  }
}

}  // namespace
}  // namespace nephroid::closed_form
