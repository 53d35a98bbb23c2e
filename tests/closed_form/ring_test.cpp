#include "closed_form/ring.h"

#include <gtest/gtest.h>

#include <algorithm>

namespace nephroid::closed_form {
namespace {

constexpr int kSegments = 2048, kPixels = 512;

/// Sum of `factor`² pixels each.
std::vector<double> coarsen(const Image& image, int factor) {
  const int size = image.width / factor;
  std::vector<double> sums(static_cast<std::size_t>(size) * static_cast<std::size_t>(size), 0.0);
  for (int y = 0; y < image.height; ++y)
    for (int x = 0; x < image.width; ++x)
      sums[static_cast<std::size_t>(y / factor) * static_cast<std::size_t>(size) + static_cast<std::size_t>(x / factor)] +=
          static_cast<double>(image.at(x, y)[0]);
  return sums;
}

/// Means over the 32 rows about the axis.
std::vector<double> axisProfile(const Image& image) {
  std::vector<double> profile(static_cast<std::size_t>(image.width), 0.0);
  for (int y = image.height / 2 - 16; y < image.height / 2 + 16; ++y)
    for (int x = 0; x < image.width; ++x) profile[static_cast<std::size_t>(x)] += static_cast<double>(image.at(x, y)[0]) / 32.0;
  return profile;
}

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
  const double profile = relativeL1(axisProfile(picture().irradiance), axisProfile(predicted));
  const double whole = relativeL1(coarsen(picture().irradiance, 8), coarsen(predicted, 8));
  RecordProperty("relative_l1_axis", fmt::format("{:.6f}", profile));
  RecordProperty("relative_l1_plane", fmt::format("{:.6f}", whole));
  EXPECT_LE(profile, 0.03);
  EXPECT_LE(whole, 0.03) << "64 x 64 squares";
  EXPECT_LE(worstResidual(picture().ledgers), 1e-5);
}

TEST_F(RingCaustic, IsBrightestOnTheNephroid) {
  // Down each of some columns the brightest pixel lies on the curve: inside there are more rays, at the fold infinitely many.
  // Columns near the cusp and near the wall are left out, where branches crowd together within pixels.
  const RingCase c;
  const double pixel = picture().view.pixelSize();
  double worst = 0.0;
  int checked = 0;
  for (int column = 140; column <= 240; column += 4) {
    const double x = (column + 0.5) * pixel - c.inner_radius;
    int brightest = kPixels / 2;
    for (int row = kPixels / 2; row < kPixels; ++row)
      if (picture().irradiance.at(column, row)[0] > picture().irradiance.at(column, brightest)[0]) brightest = row;
    const dvec2 found(x, (brightest + 0.5) * pixel - c.inner_radius);
    double nearest = 1.0;
    for (int i = 0; i <= 20'000; ++i)
      nearest = std::min(nearest, glm::length(found - nephroidPoint(c.inner_radius, 0.5 * kPiD * i / 20'000)));
    worst = std::max(worst, nearest);
    ++checked;
  }
  RecordProperty("distance_over_radius", fmt::format("{:.5f}", worst / c.inner_radius));
  EXPECT_GT(checked, 20);
  EXPECT_LE(worst, 1.5 * pixel);
}

TEST_F(RingCaustic, HasItsCuspHalfwayBetweenWallAndCentre) {
  const std::vector<double> profile = axisProfile(picture().irradiance);
  const auto peak = std::max_element(profile.begin(), profile.end()) - profile.begin();
  const double x = (static_cast<double>(peak) + 0.5) * picture().view.pixelSize() - RingCase{}.inner_radius;
  RecordProperty("x_over_radius", fmt::format("{:.5f}", x / RingCase{}.inner_radius));
  EXPECT_NEAR(x / RingCase{}.inner_radius, -0.5, 0.01);
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
  EXPECT_NEAR(across.x * along.y - across.y * along.x, 0.0, 1e-9) << "the map from (φ, y) to the floor is singular here";
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
