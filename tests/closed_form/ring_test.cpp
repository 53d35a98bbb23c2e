#include "closed_form/ring.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "closed_form/optics.h"
#include "closed_form/profile.h"

namespace nephroid::closed_form {
namespace {

constexpr int kSegments = 2048, kPixels = 512;

/// Sums over squares of 8 x 8 pixels that lie inside the circle: the corners get light from the ring's outside too.
std::vector<double> sumSquares(const Image& image) {
  constexpr int kSide = 8;
  const int size = image.width / kSide;
  std::vector<double> sums;
  for (int row = 0; row < size; ++row) {
    for (int column = 0; column < size; ++column) {
      const double far_x = std::abs(column + 0.5 - 0.5 * size) + 0.5, far_y = std::abs(row + 0.5 - 0.5 * size) + 0.5;
      if (std::hypot(far_x, far_y) > 0.5 * size) continue;
      sums.push_back(0.0);
      for (int y = kSide * row; y < kSide * (row + 1); ++y)
        for (int x = kSide * column; x < kSide * (column + 1); ++x)
          sums.back() += static_cast<double>(image.at(x, y)[0]);
    }
  }
  return sums;
}

/// Means over an even number of rows about the axis.
std::vector<double> axisProfile(const Image& image, int rows) {
  std::vector<double> profile(static_cast<std::size_t>(image.width), 0.0);
  for (int y = (image.height - rows) / 2; y < (image.height + rows) / 2; ++y)
    for (int x = 0; x < image.width; ++x)
      profile[static_cast<std::size_t>(x)] += static_cast<double>(image.at(x, y)[0]) / rows;
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
  const double profile = relativeL1(axisProfile(picture().irradiance, 32), axisProfile(predicted, 32));
  const double whole = relativeL1(sumSquares(picture().irradiance), sumSquares(predicted));
  RecordProperty("relative_l1_axis", fmt::format("{:.6f}", profile));
  RecordProperty("relative_l1_plane", fmt::format("{:.6f}", whole));
  EXPECT_LE(profile, 0.03);
  EXPECT_LE(whole, 0.03) << "squares of 8 x 8 pixels";
  EXPECT_LE(worstResidual(picture().ledgers), 1e-5);
}

TEST_F(RingCaustic, IsBrightestOnTheNephroid) {
  // Down each of some columns the brightest pixel lies on the curve: inside there are more rays, at the fold infinitely
  // many. These columns cross the upper branch, φ from 45 to 75 degrees, which has |z| > a/(2√2); the cusp's light is
  // below.
  const RingCase c;
  const double pixel = picture().view.pixelSize();
  double worst = 0.0;
  int checked = 0;
  for (int column = 90; column <= 150; column += 2) {
    const double x = (column + 0.5) * pixel - c.inner_radius;
    constexpr int kFirstRow = kPixels / 2 + 92;
    int brightest = kFirstRow;
    for (int row = kFirstRow; row < kPixels; ++row)
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
  // The two rows about the axis are a strip |z| <= w of one pixel. Near the cusp N(φ)/a = (−1/2 − 3φ²/4, φ³): the strip
  // holds both folds up to φ = (w/a)^(1/3) and is brightest where they leave it, at x/a = −1/2 − (3/4)(w/a)^(2/3).
  const RingCase c;
  const double pixel = picture().view.pixelSize() / c.inner_radius;
  const std::vector<double> profile = axisProfile(picture().irradiance, 2);
  const auto peak = std::max_element(profile.begin(), profile.end()) - profile.begin();
  const double x = (static_cast<double>(peak) + 0.5) * pixel - 1.0;
  const double cusp = x + 0.75 * std::pow(pixel, 2.0 / 3.0);
  RecordProperty("cusp_over_radius", fmt::format("{:.5f}", cusp));
  EXPECT_NEAR(cusp, -0.5, 1.5 * pixel);
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
