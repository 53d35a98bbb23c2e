#include "core/sampling/chi_squared.h"

#include <gtest/gtest.h>

#include <random>

namespace nephroid::test {
namespace {

TEST(ChiSquared, MatchesTheTabulatedQuantile) {
  // The upper 1 % point of χ² with 30 degrees of freedom is 50.892: one cell carries all of it.
  std::vector<double> expected(31, 100.0), observed(31, 100.0);
  observed[7] += std::sqrt(50.892 * 100.0);
  EXPECT_NEAR(chiSquaredPValue(observed, expected), 0.01, 0.0005);
}

TEST(ChiSquared, RejectsASlightlyWrongDensity) {
  std::mt19937 generator(1);
  std::uniform_real_distribution<double> uniform;
  std::vector<double> observed(64, 0.0), expected(64, 100000.0 / 64);
  for (int i = 0; i < 100000; ++i) observed[static_cast<std::size_t>(64 * std::pow(uniform(generator), 1.03))] += 1;
  EXPECT_LT(chiSquaredPValue(observed, expected), 1e-4);
}

TEST(ChiSquared, RejectsSamplesWhereTheDensityIsZero) { EXPECT_EQ(chiSquaredPValue({50, 50, 1}, {50, 51, 0}), 0.0); }

}  // namespace
}  // namespace nephroid::test
