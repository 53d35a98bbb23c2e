#include "closed_form/drop.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "closed_form/optics.h"

namespace nephroid::closed_form {
namespace {

TEST(Drop, ShowsTheRainbowWhereItsIndicesPutIt) {
  // Three bands, each of one wavelength. A photon in two hundred comes to the screen by way of the drop's back, half of
  // them within a quarter of a degree of the bow's edge.
  const DropCase c;
  const PlanePicture picture = renderPlane(makeDropScene(c), dropView(c), std::uint64_t{1} << 22, 1, {"bands=3"});
  EXPECT_LE(worstResidual(picture.ledgers), 1e-5);
  const std::vector<double> errors_deg = bowErrors_deg(c, picture);
  ASSERT_EQ(errors_deg.size(), 3U);
  const double worst = *std::max_element(errors_deg.begin(), errors_deg.end());
  EXPECT_LE(worst, 0.05);
  RecordProperty("error_deg", fmt::format("{:.4f}", worst));
}

TEST(DropFormula, IsTheLeastOfAllDeviations) {
  const DropCase c{.distance = 1e12};
  const auto angleOf = [&](double incidence) { return 4.0 * std::asin(std::sin(incidence) / c.ior) - 2.0 * incidence; };
  double largest = 0.0;
  for (double incidence = 0.0; incidence < 1.57; incidence += 1e-4) largest = std::max(largest, angleOf(incidence));
  EXPECT_NEAR(bowAngle(c, c.ior), largest, 1e-7);
  EXPECT_NEAR(degreesD(bowAngle(c, 4.0 / 3.0)), 42.03, 0.01);  // Descartes' figure
}

}  // namespace
}  // namespace nephroid::closed_form
