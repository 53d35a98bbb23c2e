#include "closed_form/prism.h"

#include <gtest/gtest.h>

#include "closed_form/optics.h"
#include "closed_form/profile.h"
#include "core/spectrum.h"

namespace nephroid::closed_form {
namespace {

constexpr double kTolerance_deg = 0.05;
// The slit lets a fortieth of the photons through; a beam's centre is known to a hundredth of its width of 1 mm, 0.002
// degrees.
constexpr std::uint64_t kPhotons = std::uint64_t{1} << 17;

PlaneRenderer withPhotons(std::uint64_t photons) {
  return [photons](const SceneData& scene, const PlaneView& view, const std::vector<std::string>& parameters) {
    PlanePicture picture = renderPlane(scene, view, photons, 1, parameters);
    EXPECT_LE(worstResidual(picture.ledgers), 1e-5);
    return picture;
  };
}

/// The one beam's deviation, degrees.
double measureDeviation_deg(const PrismCase& c) {
  const double predicted = prismDeviation(radiansD(c.apex_deg), radiansD(c.incidence_deg), c.ior);
  const std::vector<double> measured =
      measureDeviations(c, radiansD(c.sun_elevation_deg) + predicted, withPhotons(kPhotons));
  EXPECT_EQ(measured.size(), 1U);
  return measured.empty() ? 0.0 : degreesD(measured[0]);
}

TEST(Prism, DeviatesLeastAtTheSymmetricPassage) {
  PrismCase c;
  const double least = degreesD(prismMinimumDeviation(radiansD(c.apex_deg), c.ior));
  double worst = 0.0;
  for (const double off : {-8.0, 0.0, 8.0}) {
    c.incidence_deg = 0.5 * (c.apex_deg + least) + off;
    const double predicted = degreesD(prismDeviation(radiansD(c.apex_deg), radiansD(c.incidence_deg), c.ior));
    const double measured = measureDeviation_deg(c);
    EXPECT_NEAR(measured, predicted, kTolerance_deg) << "incidence " << c.incidence_deg;
    if (off == 0.0) {
      EXPECT_NEAR(measured, least, kTolerance_deg);
    } else {
      EXPECT_GT(measured, least + kTolerance_deg);
    }
    worst = std::max(worst, std::abs(measured - predicted));
  }
  RecordProperty("error_deg", fmt::format("{:.5f}", worst));
}

TEST(Prism, SpreadsWavelengthsByTheirIndices) {
  // Flint glass, V = 30, in the minimum of the d line; three bands, each one wavelength.
  PrismCase c{.ior = 1.62, .abbe = 30.0};
  const double apex = radiansD(c.apex_deg), least = prismMinimumDeviation(apex, c.ior);
  c.incidence_deg = degreesD(0.5 * (apex + least));
  const std::vector<double> measured =
      measureDeviations(c, radiansD(c.sun_elevation_deg) + least, withPhotons(2 * kPhotons), {"bands=3"});
  const std::vector<Band> bands = makeBands(3);
  ASSERT_EQ(measured.size(), bands.size());
  double worst = 0.0;
  for (std::size_t i = 0; i < bands.size(); ++i) {
    // Blue is turned most and lands nearest, at the left; bands are in order of wavelength, blue first.
    const double ior = cauchyIndex(c.ior, c.abbe, static_cast<double>(bands[i].wavelength_nm));
    const double predicted = prismDeviation(apex, radiansD(c.incidence_deg), ior);
    EXPECT_NEAR(degreesD(measured[i]), degreesD(predicted), kTolerance_deg) << bands[i].wavelength_nm << " nm";
    worst = std::max(worst, std::abs(degreesD(measured[i] - predicted)));
  }
  RecordProperty("error_deg", fmt::format("{:.5f}", worst));
}

TEST(Prism, FansWhiteLightOutIntoTheColoursOfAllWavelengths) {
  const FanCase c;
  const auto measure = [&](const std::vector<std::string>& parameters) {
    const PlanePicture picture = renderPlane(c.scene(), c.view(), std::uint64_t{1} << 22, 1, parameters);
    return relativeColourL1(binColumns(picture, c.bins), fanIrradiance(c));
  };
  // A hundred thousand photons pass the slit, some 2000 a bin, each with a colour of its own: 4 % if they came by mere
  // chance; well-spread points do better.
  const double error = measure({});
  EXPECT_LT(error, 0.03);
  // Bands stand apart as stripes.
  EXPECT_GT(measure({"bands=16"}), 0.3);
  RecordProperty("relative_l1", fmt::format("{:.4f}", error));
}

TEST(PrismFormula, HasItsMinimumWhereBothSidesAreEqual) {
  const double apex = radiansD(60.0), least = prismMinimumDeviation(apex, 1.5), at = 0.5 * (apex + least);
  EXPECT_NEAR(prismDeviation(apex, at, 1.5), least, 1e-12);
  EXPECT_GT(prismDeviation(apex, at + 0.01, 1.5), least);
  EXPECT_GT(prismDeviation(apex, at - 0.01, 1.5), least);
}

}  // namespace
}  // namespace nephroid::closed_form
