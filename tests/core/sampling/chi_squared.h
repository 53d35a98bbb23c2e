// Pearson's χ² test of counts against expectations.
#pragma once

#include <cmath>
#include <cstddef>
#include <vector>

namespace nephroid::test {

/// Significance of every χ² test of the core, before Šidák's correction: with fixed seeds a failure is not bad luck but
/// a change of the code.
inline constexpr double kSignificance = 0.01;

/// Significance of one of `tests` tests that fail together with probability kSignificance.
inline double sidak(int tests) { return 1.0 - std::pow(1.0 - kSignificance, 1.0 / tests); }

/// Probability of counts at least as far from the expectation. Cells are pooled in order until 5 are expected, the
/// usual condition of the test. The tail of χ² is taken from the Wilson–Hilferty cube-root normal, good to a few per
/// cent of the value for the dozens of degrees of freedom used here. Counts where nothing is expected give 0.
inline double chiSquaredPValue(const std::vector<double>& observed, const std::vector<double>& expected) {
  double sum = 0, pooled_observed = 0, pooled_expected = 0;
  int cells = 0;
  for (std::size_t i = 0; i < observed.size(); ++i) {
    if (expected[i] <= 0 && observed[i] > 0) return 0;
    pooled_observed += observed[i];
    pooled_expected += expected[i];
    if (pooled_expected < 5) continue;
    sum += (pooled_observed - pooled_expected) * (pooled_observed - pooled_expected) / pooled_expected;
    pooled_observed = pooled_expected = 0;
    ++cells;
  }
  const double freedom = cells - 1;
  const double spread = 2.0 / (9.0 * freedom);
  const double z = (std::cbrt(sum / freedom) - (1.0 - spread)) / std::sqrt(spread);
  return 0.5 * std::erfc(z / std::sqrt(2.0));
}

}  // namespace nephroid::test
