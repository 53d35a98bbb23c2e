#include "techniques/reference/continuation.h"

#include <cmath>
#include <numeric>

namespace nephroid {
namespace {

/// Rates are so many times those that were measured to be the best, and no less than kLeastRate: too low a rate turns
/// what the measurement missed into noise, too high a one only costs rays.
constexpr double kSafety = 2.0, kLeastRate = 0.5;

/// Of a part and all that come after it.
double sumFrom(const std::array<double, PathPart::kCount>& values, std::size_t part) {
  return std::accumulate(values.begin() + static_cast<std::ptrdiff_t>(part), values.end(), 0.0);
}

}  // namespace

Continuation chooseContinuation(const PartTally& tally, double variance) {
  Continuation continuation;
  double rate_before = 1.0;
  for (std::size_t part = 1; part < PathPart::kCount; ++part) {
    const double cost = sumFrom(tally.rays, part) / sumFrom(tally.rays, 0), gain = sumFrom(tally.squares, part);
    if (!(cost > 0.0)) break;
    const double best = gain > 0.0 ? std::sqrt(gain / variance / cost) : 0.0;
    const double rate = std::min(rate_before, std::max(kSafety * best, kLeastRate));
    continuation.probability[part] = static_cast<float>(rate / rate_before);
    rate_before = rate;
  }
  return continuation;
}

}  // namespace nephroid
