#include "core/optics/fresnel.shared.h"

#include <gtest/gtest.h>

#include <cmath>
#include <complex>

#include "core/optics/fresnel_average.h"

namespace nephroid {
namespace {

struct Polarised {
  double s, p;
};

/// The textbook form with complex arithmetic in double precision; medium of index n + ik over vacuum when `from` is 1.
Polarised computeTextbook(double c, double from, std::complex<double> to) {
  const std::complex<double> ratio = from / to;
  const std::complex<double> t = std::sqrt(1.0 - ratio * ratio * (1.0 - c * c));
  return {std::norm((from * c - to * t) / (from * c + to * t)), std::norm((to * c - from * t) / (to * c + from * t))};
}
double computeUnpolarised(double c, double from, std::complex<double> to) {
  const auto [s, p] = computeTextbook(c, from, to);
  return 0.5 * (s + p);
}

TEST(FresnelDielectric, AtNormalIncidenceIsTheSquareOfTheIndexContrast) {
  for (const double n : {1.05, 1.33, 1.5, 2.4}) {
    const double expected = std::pow((n - 1) / (n + 1), 2);
    EXPECT_NEAR(fresnelDielectric(1.0F, static_cast<float>(1 / n)) / expected, 1.0, 1e-5);
    EXPECT_NEAR(fresnelDielectric(1.0F, static_cast<float>(n)) / expected, 1.0, 1e-5);
  }
}

TEST(FresnelDielectric, AtBrewstersAngleReflectsOnlyOnePolarisation) {
  // tan θ_B = n; there R_p = 0 and R_s = ((1 − n²)/(1 + n²))², for n = 1.5 (5/13)² = 0.147929.
  const float cos_brewster = 1.0F / std::sqrt(1.0F + 1.5F * 1.5F);
  EXPECT_NEAR(fresnelDielectric(cos_brewster, 1.0F / 1.5F), 0.5 * std::pow(1.25 / 3.25, 2), 1e-7);
  EXPECT_LT(computeTextbook(1 / std::sqrt(3.25), 1.0, 1.5).p, 1e-30);
}

TEST(FresnelDielectric, MatchesTheTextbookFormFromBothSides) {
  for (const double n : {0.4, 0.7, 1.001, 1.33, 1.5, 2.4})
    for (int i = 0; i <= 200; ++i) {
      const float c = static_cast<float>(i) / 200;
      const float ratio = static_cast<float>(1 / n);
      // The index as the function sees it, so that the error is that of the function.
      const double exact = computeUnpolarised(double{c}, double{ratio}, 1.0);
      // Near the critical angle R falls like −4t, t = cos of the refracted ray, and an error of 2⁻²³ in t² is one of
      // 2⁻²³/(2t) in t.
      const double t2 = 1 - double{ratio} * ratio * (1 - double{c} * c);
      const double tolerance = 1e-6 + 4 * 0x1p-23 / (2 * std::sqrt(std::max(t2, 1e-8)));
      EXPECT_NEAR(fresnelDielectric(c, ratio), exact, tolerance) << n << " " << c;
    }
}

TEST(FresnelDielectric, KeepsItsRelativePrecisionNearIndexOne) {
  // The plain form has no correct digit here: R is 2.5e-11 at normal incidence.
  const float ratio = 1.0F + 84 * 0x1p-23F;
  for (const float c : {1.0F, 0.9F, 0.5F, 0.1F}) {
    const double exact = computeUnpolarised(double{c}, double{ratio}, 1.0);
    EXPECT_NEAR(fresnelDielectric(c, ratio) / exact, 1.0, 2e-5) << c;
  }
}

TEST(FresnelDielectric, OfIndexOneIsExactlyZero) {
  for (const float c : {0.0F, 1e-20F, 0.3F, 1.0F}) EXPECT_EQ(fresnelDielectric(c, 1.0F), 0.0F);
}

TEST(FresnelDielectric, BeyondTheCriticalAngleIsOne) {
  // sin θ_c = 1/1.5: cos θ_c = 0.745356.
  EXPECT_EQ(fresnelDielectric(0.745F, 1.5F), 1.0F);
  EXPECT_LT(fresnelDielectric(0.746F, 1.5F), 1.0F);
  EXPECT_EQ(fresnelDielectric(0.0F, 1.5F), 1.0F);
  EXPECT_FLOAT_EQ(fresnelDielectric(0.0F, 1 / 1.5F), 1.0F);
}

TEST(FresnelDielectric, IsReciprocal) {
  // R is the same for the ray and its reverse.
  for (int i = 1; i <= 50; ++i) {
    const float c = static_cast<float>(i) / 50;
    const float t = std::sqrt(1 - (1 - c * c) / (1.5F * 1.5F));
    EXPECT_NEAR(fresnelDielectric(c, 1 / 1.5F), fresnelDielectric(t, 1.5F), 2e-5F) << c;
  }
}

TEST(FresnelDielectric, ClampsTheCosine) {
  EXPECT_EQ(fresnelDielectric(1.0001F, 0.7F), fresnelDielectric(1.0F, 0.7F));
  EXPECT_EQ(fresnelDielectric(-0.0001F, 0.7F), fresnelDielectric(0.0F, 0.7F));
}

TEST(FresnelSchlick, GoesFromF0ToOne) {
  EXPECT_EQ(fresnelSchlick(1.0F, vec3(0.1F, 0.2F, 0.3F)), vec3(0.1F, 0.2F, 0.3F));
  EXPECT_EQ(fresnelSchlick(0.0F, vec3(0.1F, 0.2F, 0.3F)), vec3(1.0F));
  EXPECT_FLOAT_EQ(fresnelSchlick(0.5F, vec3(0.04F)).x, 0.04F + 0.96F / 32);
}

TEST(FresnelConductor, MatchesComplexArithmetic) {
  const double metals[][2] = {{0.2, 3.9}, {1.3, 7.5}, {0.05, 4.2}, {3.1, 3.3}, {1.0, 0.001}, {0.6, 0.01}, {1.5, 0.0}};
  for (const auto& [n, k] : metals)
    for (int i = 1; i <= 100; ++i) {
      const float c = static_cast<float>(i) / 100;
      const vec3 f = fresnelConductor(c, vec3(static_cast<float>(n)), vec3(static_cast<float>(k)));
      EXPECT_NEAR(f.x, computeUnpolarised(double{c}, 1.0, {n, k}), 5e-6) << n << " " << k << " " << c;
      EXPECT_EQ(f.x, f.y);
      EXPECT_EQ(f.x, f.z);
    }
}

TEST(FresnelConductor, AtGrazingIncidenceIsOne) { EXPECT_EQ(fresnelConductor(0.0F, vec3(1), vec3(0)), vec3(1)); }

TEST(FresnelThinPane, SumsAllInterReflections) {
  for (const double r : {0.0, 0.04, 0.5, 0.9}) {
    double sum = r, inside = (1 - r) * (1 - r) * r;
    for (int i = 0; i < 1000; ++i, inside *= r * r) sum += inside;
    EXPECT_NEAR(fresnelThinPane(static_cast<float>(r)), sum, 1e-6);
  }
  EXPECT_EQ(fresnelThinPane(1.0F), 1.0F);
}

TEST(AverageFresnel, MatchesDenseQuadrature) {
  for (const double n : {0.5, 0.8, 1.0001, 1.01, 1.33, 1.5, 2.4, 4.0}) {
    // Midpoints in s, c = s²: dense where the reflectance is steep.
    double sum = 0;
    const int count = 200000;
    for (int i = 0; i < count; ++i) {
      const double s = (i + 0.5) / count;
      sum += 2 * computeUnpolarised(s * s, 1.0, n) * s * s * 2 * s / count;
    }
    EXPECT_NEAR(averageFresnelDielectric(static_cast<float>(n)), sum, 1e-5) << n;
  }
  EXPECT_EQ(averageFresnelDielectric(1.0F), 0.0F);
}

TEST(AverageFresnel, IsTheTabulatedValueForGlass) {
  // 0.0918 for n = 1.5 (Egan, Hilgeman and Reichman 1973: ((n − 1)(3n + 1))/(6(n + 1)²) + …).
  EXPECT_NEAR(averageFresnelDielectric(1.5F), 0.0918, 5e-5);
}

TEST(AverageFresnel, IsReciprocalUpToTheSolidAngle) {
  // Diffuse light in equilibrium exchanges as much either way: n²(1 − F_inside) = 1 − F_outside.
  for (const float n : {1.1F, 1.5F, 2.0F})
    EXPECT_NEAR(n * n * (1 - averageFresnelDielectric(1 / n)), 1 - averageFresnelDielectric(n), 3e-5);
}

}  // namespace
}  // namespace nephroid
