#include "trace/emission_guide.h"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "core/sampling/sampler.h"

namespace nephroid {
namespace {

constexpr int kSide = EmissionGuide::kSide;

/// Most of it in a ring, nothing in one corner.
std::vector<float> makeWeights() {
  std::vector<float> weights;
  for (int y = 0; y < kSide; ++y)
    for (int x = 0; x < kSide; ++x) {
      const double r = std::hypot(x - 40.0, y - 20.0);
      weights.push_back(x < 16 && y >= 48 ? 0.0F : static_cast<float>(0.02 + 9.0 * std::exp(-(r - 12) * (r - 12))));
    }
  return weights;
}

TEST(EmissionGuide, FillsBlocksByTheirDensity) {
  const EmissionGuide guide(makeWeights(), 0.25F);
  constexpr int kPoints = 1 << 20;
  std::vector<int> counts(static_cast<std::size_t>(kSide) * kSide, 0);
  for (std::uint32_t i = 0; i < kPoints; ++i) {
    Sampler sampler(3, 1, i);
    float density = 0.0F;
    const vec2 place = guide.warp(sampler.next2D(), density);
    ASSERT_EQ(density, guide.densityAt(place));
    ++counts[static_cast<std::size_t>(place.y * kSide) * kSide + static_cast<std::size_t>(place.x * kSide)];
  }
  double sum = 0.0;
  for (std::size_t block = 0; block < counts.size(); ++block) {
    const double expected = guide.densityOfBlock(block) * kPoints / (kSide * kSide);
    // Points are stratified: far nearer to what is expected than √expected of independent ones.
    EXPECT_NEAR(counts[block], expected, 4.0 + 0.5 * std::sqrt(expected)) << block;
    EXPECT_GE(guide.densityOfBlock(block), 0.25F);
    sum += guide.densityOfBlock(block);
  }
  EXPECT_NEAR(sum / (kSide * kSide), 1.0, 1e-5);
}

TEST(EmissionGuide, DividingByTheDensityKeepsEveryMean) {
  const EmissionGuide guide(makeWeights(), 0.25F);
  constexpr int kPoints = 1 << 18;
  double sum = 0.0;
  for (std::uint32_t i = 0; i < kPoints; ++i) {
    Sampler sampler(5, 1, i);
    float density = 0.0F;
    const vec2 place = guide.warp(sampler.next2D(), density);
    sum += place.x * place.x * (1.0 - place.y) / density / kPoints;
  }
  EXPECT_NEAR(sum, 1.0 / 6.0, 2e-4);  // ∫∫ x² (1 − y)
}

TEST(EmissionGuide, WithoutWeightsIsEven) {
  const EmissionGuide guide(std::vector<float>(static_cast<std::size_t>(kSide) * kSide, 0.0F), 0.25F);
  float density = 0.0F;
  const vec2 u(0.3125F, 0.71875F);
  EXPECT_EQ(guide.warp(u, density), u);
  EXPECT_EQ(density, 1.0F);
}

TEST(EmissionGuide, UpperEndOfTheSquareStaysInside) {
  const EmissionGuide guide(makeWeights(), 0.25F);
  float density = 0.0F;
  const vec2 place = guide.warp(vec2(kOneMinusEpsilon), density);
  EXPECT_LT(place.x, 1.0F);
  EXPECT_LT(place.y, 1.0F);
}

}  // namespace
}  // namespace nephroid
