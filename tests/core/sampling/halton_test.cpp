#include "core/sampling/halton.h"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

namespace nephroid {
namespace {

TEST(Halton, IsTheRadicalInverse) {
  // 6 = 110₂ → 0.011₂ = 3/8; 5 = 12₃ → 0.21₃ = 7/9; 13 = 23₅ → 0.32₅ = 17/25.
  EXPECT_FLOAT_EQ(halton(6, 0, 0), 0.375F);
  EXPECT_FLOAT_EQ(halton(5, 1, 0), 7.0F / 9.0F);
  EXPECT_FLOAT_EQ(halton(13, 2, 0), 17.0F / 25.0F);
  EXPECT_EQ(halton(0, 3, 0), 0.0F);
}

TEST(Halton, LastDimensionHasThe64thPrime) { EXPECT_FLOAT_EQ(halton(1, 63, 0), 1.0F / 311.0F); }

TEST(Halton, StaysBelowOne) {
  for (const std::uint32_t seed : {0U, 1U, 99U})
    for (int dimension = 0; dimension < kHaltonDimensions; ++dimension)
      for (const std::uint32_t index : {0U, 1U, 0x7fffffffU, 0xffffffffU}) {
        EXPECT_GE(halton(index, dimension, seed), 0.0F);
        EXPECT_LT(halton(index, dimension, seed), 1.0F);
      }
}

/// True if each of `base^digits` equal intervals holds exactly one of the first base^digits points.
bool isOnePerInterval(int dimension, std::uint32_t count, std::uint32_t seed) {
  std::vector<int> hits(count, 0);
  // Scrambled points lie inside the intervals, plain ones on the lower ends, where float may round either way. (With
  // thousands of intervals some scrambled point would be close enough to an end for that, too.)
  for (std::uint32_t i = 0; i < count; ++i) {
    const double x = static_cast<double>(halton(i, dimension, seed)) * count;
    ++hits[static_cast<std::size_t>(seed == 0 ? std::round(x) : std::floor(x))];
  }
  for (const int h : hits)
    if (h != 1) return false;
  return true;
}

TEST(Halton, FillsIntervalsEvenlyScrambledOrNot) {
  for (const std::uint32_t seed : {0U, 7U, 12345U}) {
    EXPECT_TRUE(isOnePerInterval(0, 1024, seed));
    EXPECT_TRUE(isOnePerInterval(1, 729, seed));
    EXPECT_TRUE(isOnePerInterval(2, 625, seed));
    EXPECT_TRUE(isOnePerInterval(20, 73, seed));
  }
}

TEST(Halton, ScramblingBreaksTheCorrelationOfLargeBases) {
  // Plain, the first 60 points in bases 61 and 67 lie on a line.
  const auto correlation = [](std::uint32_t seed) {
    double sx = 0, sy = 0, sxy = 0, sxx = 0, syy = 0;
    const int n = 60;
    for (std::uint32_t i = 0; i < n; ++i) {
      const double x = halton(i, 17, seed), y = halton(i, 18, seed);
      sx += x, sy += y, sxy += x * y, sxx += x * x, syy += y * y;
    }
    return (n * sxy - sx * sy) / std::sqrt((n * sxx - sx * sx) * (n * syy - sy * sy));
  };
  EXPECT_GT(correlation(0), 0.99);
  EXPECT_LT(std::abs(correlation(5)), 0.5);
}

}  // namespace
}  // namespace nephroid
