#include "closed_form/slab.h"

#include <gtest/gtest.h>

#include "closed_form/optics.h"

namespace nephroid::closed_form {
namespace {

// A quarter of 2^21 photons lands in the view. With random numbers each mean would have a standard error of at most
// sqrt(0.84 · 0.16 / 2^19) = 0.05 % (60 degrees); stratified ones do better.
constexpr std::uint64_t kPhotons = std::uint64_t{1} << 21;

class ClearSlab : public ::testing::TestWithParam<double> {};

TEST_P(ClearSlab, TransmitsAllOrdersToATenthOfAPercent) {
  const SlabCase c{.angle_deg = GetParam()};
  const PlanePicture picture = renderPlane(makeSlabScene(c), slabView(c), kPhotons);
  const double predicted = slabIrradiance(c).x, measured = meanIrradiance(picture).x;
  RecordProperty("relative_error", fmt::format("{:.6f}", measured / predicted - 1.0));
  EXPECT_NEAR(measured / predicted, 1.0, 1e-3);
  EXPECT_LE(worstResidual(picture.ledgers), 1e-5);
}
INSTANTIATE_TEST_SUITE_P(Angles, ClearSlab, ::testing::Values(0.0, 30.0, 60.0));

TEST_P(ClearSlab, TransmitsAllOrdersByVertexConnectionAndMergingToATenthOfAPercent) {
  const SlabCase c{.angle_deg = GetParam()};
  const PlanePicture picture = renderPlane(makeSlabScene(c), slabView(c), kPhotons, 1, {"estimator=vcm"});
  EXPECT_NEAR(meanIrradiance(picture).x / slabIrradiance(c).x, 1.0, 1e-3);
  EXPECT_LE(worstResidual(picture.ledgers), 1e-5);
}

class ColouredSlab : public ::testing::TestWithParam<double> {};

TEST_P(ColouredSlab, AbsorbsByBeerAndLambertAlongTheBentPathToHalfAPercent) {
  const SlabCase c{.angle_deg = GetParam(), .color = dvec3(0.9, 0.5, 0.15)};
  const PlanePicture picture = renderPlane(makeSlabScene(c), slabView(c), kPhotons);
  const dvec3 predicted = slabIrradiance(c), measured = meanIrradiance(picture);
  double worst = 0.0;
  for (int channel = 0; channel < 3; ++channel) {
    worst = std::max(worst, std::abs(measured[channel] / predicted[channel] - 1.0));
    EXPECT_NEAR(measured[channel] / predicted[channel], 1.0, 5e-3) << "channel " << channel;
  }
  RecordProperty("relative_error", fmt::format("{:.6f}", worst));
  EXPECT_LE(worstResidual(picture.ledgers), 1e-5);
}
INSTANTIATE_TEST_SUITE_P(Angles, ColouredSlab, ::testing::Values(0.0, 45.0));

TEST(SlabFormula, AgreesWithASumOverOrders) {
  const SlabCase c{.angle_deg = 50.0, .color = dvec3(0.7)};
  const double cos_i = std::cos(radiansD(50.0)), cos_t = std::sqrt(1.0 - std::pow(std::sin(radiansD(50.0)) / 1.5, 2));
  const double r = fresnelReflectance(cos_i, 1.0, 1.5), kept = std::pow(0.7, 1.0 / cos_t);
  double sum = 0.0, carried = (1.0 - r) * kept;
  for (int k = 0; k < 20; ++k, carried *= r * r * kept * kept) sum += carried * (1.0 - r);
  EXPECT_NEAR(slabIrradiance(c).x, cos_i * sum, 1e-12);
  // Stokes: the reflectance is the same from inside.
  EXPECT_NEAR(fresnelReflectance(cos_t, 1.5, 1.0), r, 1e-12);
}

}  // namespace
}  // namespace nephroid::closed_form
