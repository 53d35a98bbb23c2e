#include "closed_form/blur.h"

#include <gtest/gtest.h>

#include "closed_form/optics.h"
#include "closed_form/profile.h"

namespace nephroid::closed_form {
namespace {

// About half of the photons land in the view. Spread over their footprints, they leave less noise than the 3 % that a
// column of full light would have of the 1 500 photons in it.
constexpr std::uint64_t kPhotons = std::uint64_t{1} << 20;

class FiniteSun : public ::testing::TestWithParam<double> {};

TEST_P(FiniteSun, BlursAnEdgeByTheDiscsEdgeSpreadToTwoPercent) {
  const BlurCase c{.ior = GetParam()};
  const PlanePicture picture = renderPlane(makeBlurScene(c), blurView(c), kPhotons);
  const std::vector<double> measured = picture.columnMeans(), predicted = blurIrradiance(c, 512);
  const double error = relativeL1(measured, predicted);
  const std::optional<double> width = measureEdgeWidth(c, picture);
  ASSERT_TRUE(width);
  RecordProperty("relative_l1", fmt::format("{:.6f}", error));
  RecordProperty("width_error", fmt::format("{:.6f}", *width / edgeWidth() - 1.0));
  EXPECT_LE(error, 0.02);
  EXPECT_NEAR(*width / edgeWidth(), 1.0, 0.02);
  EXPECT_LE(worstResidual(picture.ledgers), 1e-5);
}
INSTANTIATE_TEST_SUITE_P(Indices, FiniteSun, ::testing::Values(1.0, 1.33));

TEST(BlurFormula, IsAnEdgeSpreadFunction) {
  EXPECT_EQ(edgeSpread(-1.0), 0.0);
  EXPECT_DOUBLE_EQ(edgeSpread(1.0), 1.0);
  EXPECT_DOUBLE_EQ(edgeSpread(0.3) + edgeSpread(-0.3), 1.0);
  // Its slope is the disc's chord over its area: 2√(1 − u²)/π.
  EXPECT_NEAR((edgeSpread(0.6 + 1e-6) - edgeSpread(0.6 - 1e-6)) / 2e-6, 2.0 * 0.8 / kPiD, 1e-6);
}

}  // namespace
}  // namespace nephroid::closed_form
