#include "core/optics/lights.shared.h"

#include <gtest/gtest.h>

#include <cmath>

#include "core/math.h"

namespace nephroid {
namespace {

TEST(SpotFalloff, IsOneInsideAndZeroOutside) {
  for (const float c : {1.0F, 0.95F, 0.9F}) EXPECT_EQ(spotFalloff(c, 0.9F, 0.5F), 1.0F) << c;
  for (const float c : {0.5F, 0.2F, -1.0F}) EXPECT_EQ(spotFalloff(c, 0.9F, 0.5F), 0.0F) << c;
}

TEST(CellSolidAngle, IsTheExactOneOfATexelToTheMidpointRulesError) {
  // Exactly, the difference of atan2(uv, √(1+u²+v²)) at the texel's corners.
  const auto corner = [](double u, double v) { return std::atan2(u * v, std::sqrt(1.0 + u * u + v * v)); };
  const int n = 64;
  double sum = 0.0;
  for (int y = 0; y < n; ++y)
    for (int x = 0; x < n; ++x) {
      const double a = 2.0 * x / n - 1.0, b = 2.0 * (x + 1) / n - 1.0, c = 2.0 * y / n - 1.0,
                   d = 2.0 * (y + 1) / n - 1.0;
      const double exact = corner(b, d) - corner(a, d) - corner(b, c) + corner(a, c);
      const float found =
          cellSolidAngle(static_cast<float>(0.5 * (a + b)), static_cast<float>(0.5 * (c + d)), 4.0F / (n * n));
      ASSERT_NEAR(found / exact, 1.0, 2.0 / (n * n)) << x << ", " << y;
      sum += found;
    }
  EXPECT_NEAR(6.0 * sum / (4.0 * kPi), 1.0, 1e-4);
}

TEST(SpotFalloff, IsTheSquareOfALinearRampInTheCosine) {
  EXPECT_NEAR(spotFalloff(0.7F, 0.9F, 0.5F), 0.25F, 1e-6F);
  EXPECT_NEAR(spotFalloff(0.8F, 0.9F, 0.5F), 0.5625F, 1e-6F);
}

TEST(SpotFalloff, HasAHardEdgeWhereTheConesCoincide) {
  const float edge = std::cos(0.3F);
  EXPECT_EQ(spotFalloff(edge + 1e-6F, edge, edge), 1.0F);
  EXPECT_EQ(spotFalloff(edge - 1e-6F, edge, edge), 0.0F);
  EXPECT_TRUE(std::isfinite(spotFalloff(edge, edge, edge)));
}

TEST(SpotIntensity, AddsUpToTheFluxOfTheCone) {
  // Φ = 2πI·((1 − a) + ∫ᵇᵃ ((c − b)/(a − b))² dc) = 2πI·((1 − a) + (a − b)/3), a and b the cosines of the inner and
  // outer cone.
  const float cos_inner = 0.9F, cos_outer = 0.6F;
  const int count = 20000;
  double flux = 0.0;
  for (int i = 0; i < count; ++i) {
    const double c = -1.0 + 2.0 * (i + 0.5) / count;
    const vec3 dir(std::sqrt(1.0 - c * c), 0.0F, -c);
    flux += 2.0 * kPi * spotIntensity(vec3(3.0F), vec3(0, 0, -1), cos_inner, cos_outer, dir).y * 2.0 / count;
  }
  EXPECT_NEAR(flux / (2.0 * kPi * 3.0 * (0.1 + 0.3 / 3.0)), 1.0, 1e-4);
}

TEST(IrradianceFromPoint, IsIntensityTimesCosineOverSquaredDistance) {
  EXPECT_EQ(irradianceFromPoint(vec3(8.0F, 4.0F, 0.0F), 4.0F, 0.5F), vec3(1.0F, 0.5F, 0.0F));
  EXPECT_EQ(irradianceFromPoint(vec3(8.0F), 4.0F, -0.5F), vec3(0.0F));
}

TEST(IrradianceFromPoint, SendsHalfOfItsFluxOntoAnEndlessPlane) {
  // At height 1 over the plane and distance r from the foot: d² = 1 + r², cosθ = 1/d. With r = tan φ the rings are
  // 2πr dr = 2π tanφ/cos²φ dφ, and all of them together get 2πI.
  const int count = 10000;
  double flux = 0.0;
  for (int i = 0; i < count; ++i) {
    const double phi = 0.5 * double{kPi} * (i + 0.5) / count, c = std::cos(phi);
    const double ring = 2.0 * double{kPi} * std::tan(phi) / (c * c) * 0.5 * double{kPi} / count;
    flux += ring * irradianceFromPoint(vec3(5.0F), static_cast<float>(1.0 / (c * c)), static_cast<float>(c)).x;
  }
  EXPECT_NEAR(flux / (2.0 * double{kPi} * 5.0), 1.0, 1e-5);
}

TEST(IrradianceFromSun, FollowsTheCosine) {
  EXPECT_EQ(irradianceFromSun(vec3(10.0F, 4.0F, 2.0F), 0.5F), vec3(5.0F, 2.0F, 1.0F));
  EXPECT_EQ(irradianceFromSun(vec3(10.0F), 1.0F), vec3(10.0F));
  EXPECT_EQ(irradianceFromSun(vec3(10.0F), -0.1F), vec3(0.0F));
}

}  // namespace
}  // namespace nephroid
