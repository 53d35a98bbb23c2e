#include "core/sampling/warp.h"

#include <gtest/gtest.h>

#include <random>

#include "core/sampling/chi_squared.h"

namespace nephroid {
namespace {

constexpr int kSamples = 200000;
constexpr int kSide = 12;
constexpr int kTests = 6;  // χ² tests of this file, for Šidák's correction

/// Random, not stratified: χ² assumes independent counts.
class Uniform2D {
 public:
  vec2 operator()() { return {uniform_(generator_), uniform_(generator_)}; }

 private:
  std::mt19937 generator_{12345};
  std::uniform_real_distribution<float> uniform_{0.0F, 0.99999F};
};

/// p-value of samples that `cell` maps to [0, 1)² in such a way that the density ought to become uniform.
template <class Sample, class Cell>
double uniformityPValue(const Sample& sample, const Cell& cell) {
  Uniform2D random;
  std::vector<double> observed(kSide * kSide, 0.0), expected(kSide * kSide, double{kSamples} / (kSide * kSide));
  for (int i = 0; i < kSamples; ++i) {
    const vec2 c = cell(sample(random()));
    const int x = std::min(static_cast<int>(c.x * kSide), kSide - 1);
    const int y = std::min(static_cast<int>(c.y * kSide), kSide - 1);
    observed[static_cast<std::size_t>(y * kSide + x)] += 1;
  }
  return test::chiSquaredPValue(observed, expected);
}

float turnOf(float x, float y) { return 0.5F + 0.4999999F * std::atan2(y, x) / kPi; }

template <class Sample, class Invert>
void expectInverse(const Sample& sample, const Invert& invert, float tolerance) {
  Uniform2D random;
  for (int i = 0; i < 2000; ++i) {
    const vec2 u = random();
    const vec2 v = invert(sample(u));
    EXPECT_NEAR(u.x, v.x, tolerance);
    EXPECT_NEAR(u.y, v.y, tolerance);
  }
}

TEST(Warp, ConcentricDiscIsUniformByArea) {
  // Area inside radius r is πr²: r² and the angle are uniform.
  EXPECT_GT(uniformityPValue(sampleConcentricDisc, [](vec2 p) { return vec2(dot(p, p), turnOf(p.x, p.y)); }),
            test::sidak(kTests));
  EXPECT_FLOAT_EQ(pdfAreaConcentricDisc() * kPi, 1.0F);
}

TEST(Warp, CosineHemisphereFollowsItsDensity) {
  // ∫ cos θ/π dω below θ is sin²θ = 1 − z².
  EXPECT_GT(uniformityPValue(sampleCosineHemisphere, [](vec3 d) { return vec2(1 - d.z * d.z, turnOf(d.x, d.y)); }),
            test::sidak(kTests));
}

TEST(Warp, UniformSphereFollowsItsDensity) {
  // Archimedes: z is uniform.
  EXPECT_GT(uniformityPValue(sampleUniformSphere, [](vec3 d) { return vec2(0.5F - 0.5F * d.z, turnOf(d.x, d.y)); }),
            test::sidak(kTests));
  EXPECT_FLOAT_EQ(pdfSolidAngleUniformSphere() * 4 * kPi, 1.0F);
}

TEST(Warp, UniformConeFollowsItsDensity) {
  const float k = 0.7F;
  EXPECT_GT(uniformityPValue([&](vec2 u) { return sampleUniformCone(u, k); },
                             [&](vec3 d) { return vec2((1 - d.z) / k, turnOf(d.x, d.y)); }),
            test::sidak(kTests));
}

TEST(Warp, ConeOfTheSunFollowsItsDensity) {
  // At 0.0046 rad, 1 − z has three digits left; sin² has all, and (1 − z) = sin²/(1 + z).
  const float k = oneMinusCos(0.00464F);
  EXPECT_NEAR(k, 0.5 * 0.00464 * 0.00464, 1e-10);
  EXPECT_GT(uniformityPValue([&](vec2 u) { return sampleUniformCone(u, k); },
                             [&](vec3 d) {
                               const float sin2 = d.x * d.x + d.y * d.y;
                               return vec2(sin2 / (1 + d.z) / k, turnOf(d.x, d.y));
                             }),
            test::sidak(kTests));
}

TEST(Warp, TriangleIsUniformByArea) {
  // The share of the triangle with weight b0 above c is (1 − c)²; given b0, the share b1/(1 − b0) is uniform.
  EXPECT_GT(
      uniformityPValue(sampleUniformTriangle, [](vec3 b) { return vec2((1 - b.x) * (1 - b.x), b.y / (1 - b.x)); }),
      test::sidak(kTests));
}

TEST(Warp, InversesUndoSamples) {
  expectInverse(sampleConcentricDisc, invertConcentricDisc, 2e-6F);
  expectInverse(sampleCosineHemisphere, invertCosineHemisphere, 2e-6F);
  expectInverse(sampleUniformSphere, invertUniformSphere, 2e-6F);
  expectInverse(sampleUniformTriangle, invertUniformTriangle, 1e-6F);
  for (const float k : {1e-9F, oneMinusCos(0.00464F), 0.3F, 1.0F, 1.9F})
    expectInverse([&](vec2 u) { return sampleUniformCone(u, k); }, [&](vec3 d) { return invertUniformCone(d, k); },
                  2e-5F);
}

TEST(Warp, DirectionsHaveUnitLength) {
  Uniform2D random;
  for (int i = 0; i < 2000; ++i) {
    const vec2 u = random();
    EXPECT_NEAR(length(sampleCosineHemisphere(u)), 1.0F, 1e-6F);
    EXPECT_NEAR(length(sampleUniformSphere(u)), 1.0F, 1e-6F);
    EXPECT_NEAR(length(sampleUniformCone(u, 1e-5F)), 1.0F, 1e-6F);
    EXPECT_NEAR(length(sampleUniformCone(u, 2.0F)), 1.0F, 1e-6F);
  }
}

TEST(Warp, DensitiesIntegrateToOne) {
  // Midpoint rule over the hemisphere in cos θ.
  double cosine = 0;
  for (int i = 0; i < 1000; ++i)
    cosine += 2 * kPi * pdfSolidAngleCosineHemisphere((static_cast<float>(i) + 0.5F) / 1000) / 1000;
  EXPECT_NEAR(cosine, 1.0, 1e-5);
  EXPECT_NEAR(pdfSolidAngleUniformCone(0.25F) * 2 * kPi * 0.25, 1.0, 1e-6);
  EXPECT_EQ(pdfSolidAngleCosineHemisphere(-0.1F), 0.0F);
  EXPECT_FLOAT_EQ(pdfAreaUniformTriangle(4.0F), 0.25F);
}

TEST(Warp, CornersOfTheSquareStayInside) {
  const float e = kOneMinusEpsilon;
  for (const vec2 u : {vec2(0, 0), vec2(e, 0), vec2(0, e), vec2(e, e), vec2(0.5F, 0.5F)}) {
    EXPECT_LE(length(sampleConcentricDisc(u)), 1.0F + 1e-6F);
    EXPECT_GE(sampleCosineHemisphere(u).z, 0.0F);
    EXPECT_GE(minComponent(sampleUniformTriangle(u)), -1e-6F);
    EXPECT_TRUE(isFinite(sampleUniformSphere(u)));
    EXPECT_EQ(sampleUniformCone(u, 0.0F), vec3(0, 0, 1));
  }
}

}  // namespace
}  // namespace nephroid
