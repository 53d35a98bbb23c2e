#include "core/sampling/distribution.h"

#include <gtest/gtest.h>

#include <array>
#include <random>

#include "core/sampling/chi_squared.h"

namespace nephroid {
namespace {

TEST(Distribution1D, ChoosesInProportionToTheWeights) {
  std::vector<float> weights(40);
  for (std::size_t i = 0; i < weights.size(); ++i) weights[i] = static_cast<float>(i % 7);
  const Distribution1D distribution(weights);
  std::mt19937 generator(3);
  std::uniform_real_distribution<float> uniform(0.0F, kOneMinusEpsilon);
  std::vector<double> observed(weights.size(), 0.0), expected(weights.size());
  for (int i = 0; i < 100000; ++i) observed[distribution.sample(uniform(generator)).index] += 1;
  for (std::size_t i = 0; i < weights.size(); ++i) expected[i] = 100000 * weights[i] / distribution.total();
  EXPECT_GT(test::chiSquaredPValue(observed, expected), test::kSignificance);
}

TEST(Distribution1D, NeverChoosesZeroWeights) {
  const Distribution1D distribution(std::array{0.0F, 1.0F, 0.0F, 0.0F, 3.0F, 0.0F});
  for (int i = 0; i <= 1000; ++i) {
    const auto s = distribution.sample(std::min(static_cast<float>(i) / 1000, kOneMinusEpsilon));
    EXPECT_TRUE(s.index == 1 || s.index == 4) << s.index;
    EXPECT_GT(s.pdf, 0.0F);
  }
  EXPECT_EQ(distribution.sample(0.0F).index, 1U);
  EXPECT_EQ(distribution.sample(0.25F).index, 4U);
  EXPECT_EQ(distribution.sample(1.0F).index, 4U);
}

TEST(Distribution1D, ProbabilitiesAndDensitiesSumToOne) {
  const Distribution1D distribution(std::array{0.2F, 1.0F, 0.0F, 5.0F});
  float probability = 0, integral = 0;
  for (std::size_t i = 0; i < 4; ++i) {
    probability += distribution.probability(i);
    integral += distribution.pdf((static_cast<float>(i) + 0.5F) / 4) / 4;
  }
  EXPECT_NEAR(probability, 1.0F, 1e-6F);
  EXPECT_NEAR(integral, 1.0F, 1e-6F);
}

TEST(Distribution1D, InverseUndoesSample) {
  const Distribution1D distribution(std::array{0.2F, 1.0F, 0.0F, 5.0F, 1e-3F});
  for (int i = 0; i < 1000; ++i) {
    const float u = (static_cast<float>(i) + 0.5F) / 1000;
    const auto s = distribution.sample(u);
    EXPECT_NEAR(distribution.invert(s.index, s.offset), u, 1e-7F);
    EXPECT_FLOAT_EQ(s.pdf, distribution.probability(s.index) * 5);
  }
}

TEST(Distribution1D, IsUniformWhenAllWeightsAreZero) {
  const Distribution1D distribution(std::array{0.0F, 0.0F, 0.0F, 0.0F});
  EXPECT_EQ(distribution.total(), 0.0);
  EXPECT_EQ(distribution.sample(0.6F).index, 2U);
  EXPECT_FLOAT_EQ(distribution.sample(0.6F).pdf, 1.0F);
}

TEST(Distribution1D, KeepsSmallWeightsAmongAMillion) {
  std::vector<float> weights(1000000, 1.0F);
  weights[999999] = 1e-3F;
  const Distribution1D distribution(weights);
  EXPECT_NEAR(distribution.total(), 999999.001, 1e-6);
  EXPECT_NEAR(distribution.probability(999999), 1e-3 / 999999.001, 1e-15);
}

std::vector<float> makeSpots(std::size_t width, std::size_t height) {
  std::vector<float> weights(width * height, 0.1F);
  weights[3 * width + 5] = 20;
  weights[0] = 0;
  for (std::size_t x = 0; x < width; ++x) weights[4 * width + x] = 0;
  return weights;
}

TEST(Distribution2D, SamplesFollowTheDensity) {
  const std::size_t width = 16, height = 8;
  const Distribution2D distribution(width, height, makeSpots(width, height));
  std::mt19937 generator(5);
  std::uniform_real_distribution<float> uniform(0.0F, kOneMinusEpsilon);
  // Two cells across each texel, so that the offset within the texel is tested too.
  std::vector<double> observed(4 * width * height, 0.0), expected(observed.size());
  for (int i = 0; i < 200000; ++i) {
    const auto s = distribution.sample({uniform(generator), uniform(generator)});
    EXPECT_EQ(s.pdf, distribution.pdf(s.uv));
    observed[static_cast<std::size_t>(s.uv.y * 2 * height) * 2 * width +
             static_cast<std::size_t>(s.uv.x * 2 * width)] += 1;
  }
  double integral = 0;
  for (std::size_t i = 0; i < observed.size(); ++i) {
    const vec2 uv((static_cast<float>(i % (2 * width)) + 0.5F) / (2 * width),
                  (static_cast<float>(i / (2 * width)) + 0.5F) / (2 * height));
    const double share = distribution.pdf(uv) / static_cast<double>(observed.size());
    integral += share;
    expected[i] = 200000 * share;
  }
  EXPECT_NEAR(integral, 1.0, 1e-6);
  EXPECT_GT(test::chiSquaredPValue(observed, expected), test::kSignificance);
}

TEST(Distribution2D, InverseUndoesSample) {
  const Distribution2D distribution(16, 8, makeSpots(16, 8));
  for (int i = 0; i < 1000; ++i) {
    const vec2 u((static_cast<float>(i) + 0.5F) / 1000, std::fmod(static_cast<float>(i) * 0.618F, 1.0F));
    const vec2 v = distribution.invert(distribution.sample(u).uv);
    // Where a texel holds much of the weight, half an ulp of uv is a larger step in u.
    EXPECT_NEAR(v.x, u.x, 2e-5F);
    EXPECT_NEAR(v.y, u.y, 2e-5F);
  }
}

TEST(LatLongDistribution, OfAConstantMapIsUniformOverTheSphere) {
  const std::size_t width = 64, height = 32;
  const auto distribution = makeLatLongDistribution(width, height, std::vector<float>(width * height, 2.0F));
  for (std::size_t y = 0; y < height; ++y) {
    // Probability of a row over its exact solid angle, 2π(cos θ₀ − cos θ₁), is 1/4π.
    const double theta0 = glm::radians(180.0) * static_cast<double>(y) / height;
    const double theta1 = glm::radians(180.0) * static_cast<double>(y + 1) / height;
    const double share = 0.5 * (std::cos(theta0) - std::cos(theta1));
    EXPECT_NEAR(distribution.pdf({0.3F, (static_cast<float>(y) + 0.5F) / height}) / height / share, 1.0, 1e-5);
  }
}

}  // namespace
}  // namespace nephroid
