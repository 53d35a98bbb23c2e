#include "closed_form/drop.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "closed_form/optics.h"
#include "core/spectrum.h"

namespace nephroid::closed_form {
namespace {

TEST(Drop, ShowsTheRainbowWhereItsIndicesPutIt) {
  // Three bands, each of one wavelength. A photon in two hundred comes to the screen by way of the drop's back, half of
  // them within a quarter of a degree of the bow's edge.
  const DropCase c;
  constexpr double kTolerance_deg = 0.05, kBin_deg = 0.02, kLower_deg = 40.0, kUpper_deg = 44.0;
  const PlanePicture picture = renderPlane(makeDropScene(c), dropView(c), std::uint64_t{1} << 22, 1, {"bands=3"});
  EXPECT_LE(worstResidual(picture.ledgers), 1e-5);
  const std::vector<Band> bands = makeBands(3);
  const auto bins = static_cast<std::size_t>(std::lround((kUpper_deg - kLower_deg) / kBin_deg));
  const std::vector<dvec3> profile = angularProfile(picture, radiansD(kLower_deg), radiansD(kUpper_deg), bins);
  // Colours are sums over bands: their inverse tells how much of each there is.
  const glm::dmat3 bands_from_rgb =
      glm::inverse(glm::dmat3(dvec3(bands[0].weight), dvec3(bands[1].weight), dvec3(bands[2].weight)));
  double worst = 0.0;
  for (int b = 0; b < 3; ++b) {
    std::vector<double> flux;
    for (const dvec3& rgb : profile) flux.push_back((bands_from_rgb * rgb)[b]);
    const double densest = *std::max_element(flux.begin(), flux.end());
    // Light that the drop's front mirrors comes to all angles, thinly.
    std::size_t edge = bins;
    while (edge > 0 && flux[edge - 1] < 0.3 * densest) --edge;
    const double measured = kLower_deg + kBin_deg * static_cast<double>(edge);
    const double ior =
        cauchyIndex(c.ior, c.abbe, static_cast<double>(bands[static_cast<std::size_t>(b)].wavelength_nm));
    const double predicted = degreesD(bowAngle(c, ior));
    EXPECT_NEAR(measured, predicted, kTolerance_deg) << bands[static_cast<std::size_t>(b)].wavelength_nm << " nm";
    worst = std::max(worst, std::abs(measured - predicted));
  }
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
