#include "core/sampling/sampler.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <vector>

#include "core/sampling/chi_squared.h"

namespace nephroid {
namespace {

/// Coordinates 2·pair and 2·pair + 1 of the points first … first + count − 1.
std::vector<vec2> makePairs(std::uint32_t seed, std::uint32_t stream, int pair, std::uint32_t first,
                            std::uint32_t count) {
  std::vector<vec2> points;
  for (std::uint32_t i = first; i < first + count; ++i) {
    Sampler sampler(seed, stream, i);
    for (int k = 0; k < pair; ++k) sampler.next2D();
    points.push_back(sampler.next2D());
  }
  return points;
}

/// Most points in any cell of any grid of 2^a × 2^b = count cells; 1 is a (0, m, 2)-net.
int worstElementaryInterval(const std::vector<vec2>& points) {
  int worst = 0;
  for (std::size_t columns = 1; columns <= points.size(); columns *= 2) {
    const std::size_t rows = points.size() / columns;
    std::vector<int> hits(points.size(), 0);
    for (const vec2 p : points)
      worst = std::max(worst, ++hits[static_cast<std::size_t>(p.y * static_cast<float>(rows)) * columns +
                                     static_cast<std::size_t>(p.x * static_cast<float>(columns))]);
  }
  return worst;
}

TEST(Sampler, EveryPairIsANetInBaseTwo) {
  for (const std::uint32_t seed : {0U, 1U, 77U})
    for (int pair = 0; pair < 6; ++pair) {
      EXPECT_EQ(worstElementaryInterval(makePairs(seed, 3, pair, 0, 256)), 1) << "pair " << pair;
      EXPECT_EQ(worstElementaryInterval(makePairs(seed, 3, pair, 3 * 1024, 1024)), 1) << "pair " << pair;
    }
}

TEST(Sampler, GroupsOfFourAreNetsInBaseFour) {
  // 4^m points have one in each box of volume 4^−m with sides that are powers of 1/4.
  for (const std::uint32_t group : {0U, 1U, 4U})
    for (unsigned shape = 0; shape < 256; ++shape) {
      const std::array<unsigned, 4> sides{shape & 3U, (shape >> 2) & 3U, (shape >> 4) & 3U, shape >> 6};
      const unsigned m = sides[0] + sides[1] + sides[2] + sides[3];
      if (m != 4) continue;
      std::vector<int> hits(256, 0);
      for (std::uint32_t i = 0; i < 256; ++i) {
        Sampler sampler(1, 2, i);
        for (std::uint32_t k = 0; k < 4 * group; ++k) sampler.next1D();
        std::size_t box = 0;
        for (const unsigned side : sides)
          box = (box << (2 * side)) + static_cast<std::size_t>(sampler.next1D() * static_cast<float>(1U << (2 * side)));
        ++hits[box];
      }
      for (const int h : hits) ASSERT_EQ(h, 1) << "shape " << shape;
    }
}

TEST(Sampler, StaysInHalfOpenUnitInterval) {
  for (std::uint32_t i = 0; i < 2000; ++i) {
    Sampler sampler(i, 0xffffffffU, 0xffffffffU - i);
    for (int k = 0; k < 20; ++k) {
      const float x = sampler.next1D();
      ASSERT_GE(x, 0.0F);
      ASSERT_LT(x, 1.0F);
    }
  }
}

TEST(Sampler, IsAFunctionOfItsArguments) {
  Sampler a(1, 2, 3), b(1, 2, 3);
  for (int k = 0; k < 20; ++k) EXPECT_EQ(a.next1D(), b.next1D());
}

TEST(Sampler, PairsBeginAtEvenDimensions) {
  Sampler a(1, 2, 3), b(1, 2, 3);
  a.next1D();
  b.next2D();
  EXPECT_EQ(a.next2D(), b.next2D());
  EXPECT_EQ(a.dimension(), 4U);
}

/// ∫ of a smooth function of four numbers, exact value 1, estimated with n points of one scrambling.
double estimate(std::uint32_t seed, std::uint32_t stream, std::uint32_t n) {
  double sum = 0;
  for (std::uint32_t i = 0; i < n; ++i) {
    Sampler sampler(seed, stream, i);
    double product = 1;
    for (int k = 0; k < 4; ++k) product *= 1 + 0.8 * (sampler.next1D() - 0.5);
    sum += product;
  }
  return sum / n;
}

double rootMeanSquareError(std::uint32_t n) {
  double sum = 0;
  for (std::uint32_t seed = 0; seed < 32; ++seed) sum += std::pow(estimate(seed, 1, n) - 1, 2);
  return std::sqrt(sum / 32);
}

TEST(Sampler, ErrorOfSmoothIntegrandsFallsFasterThanRandom) {
  // Random points gain a factor 8 from 64 times as many; scrambled nets of smooth functions gain up to 64^1.5 = 512.
  const double few = rootMeanSquareError(64), many = rootMeanSquareError(4096);
  EXPECT_GT(few / many, 64.0);
  // Variance of the integrand is (1 + 0.64/12)^4 − 1 = 0.231.
  EXPECT_LT(many, 0.05 * std::sqrt(0.231 / 4096));
}

TEST(Sampler, ScramblingsAreUnbiasedAndIndependent) {
  // Mean over scramblings within 4 standard errors of the truth (p = 6e-5), and neighbours do not correlate.
  double sum = 0, squares = 0, products = 0, last = 0;
  const int n = 2000;
  for (int i = 0; i < n; ++i) {
    const double e = estimate(9, static_cast<std::uint32_t>(i), 16) - 1;
    sum += e, squares += e * e, products += e * last;
    last = e;
  }
  EXPECT_LT(std::abs(sum / n), 4 * std::sqrt(squares) / n);
  EXPECT_LT(std::abs(products / squares), 4 / std::sqrt(double{n}));
}

TEST(Sampler, OnePointOverManyStreamsIsUniform) {
  // What a pixel sees: index 0 of each stream. 8² cells for two pairs of numbers far apart.
  for (const int skip : {0, 5}) {
    std::vector<double> observed(64, 0.0), expected(64, 50000.0 / 64);
    for (std::uint32_t stream = 0; stream < 50000; ++stream) {
      Sampler sampler(4, stream, 0);
      for (int k = 0; k < skip; ++k) sampler.next1D();
      const auto x = static_cast<std::size_t>(8 * sampler.next1D());
      ++observed[8 * x + static_cast<std::size_t>(8 * sampler.next1D())];
    }
    EXPECT_GT(test::chiSquaredPValue(observed, expected), test::sidak(2));
  }
}

TEST(Sampler, FirstTwoDimensionsAreSobols) {
  // Points 1 to 5 of Joe and Kuo's first two dimensions (in natural, not Gray-code, order).
  const std::array<std::array<double, 5>, 2> expected{
      {{0.5, 0.25, 0.75, 0.125, 0.625}, {0.5, 0.75, 0.25, 0.625, 0.125}}};
  for (unsigned dimension = 0; dimension < 2; ++dimension)
    for (std::uint32_t i = 1; i <= 5; ++i)
      EXPECT_EQ(detail::reverseBits(detail::computeDigitalReversed(i, dimension)) * 0x1p-32, expected[dimension][i - 1])
          << dimension << " " << i;
}

}  // namespace
}  // namespace nephroid
