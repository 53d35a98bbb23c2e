#include "techniques/reference/continuation.h"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace nephroid {
namespace {

/// Of a part and all that come after it.
double sumFrom(const std::array<double, PathPart::kCount>& values, std::size_t part) {
  return std::accumulate(values.begin() + static_cast<std::ptrdiff_t>(part), values.end(), 0.0);
}

}  // namespace

Continuation chooseContinuation(const PartTally& tally, double variance, const RateLimits& limits) {
  Continuation continuation;
  double rate_before = 1.0;
  for (std::size_t part = 1; part < PathPart::kCount; ++part) {
    const double cost = sumFrom(tally.rays, part) / sumFrom(tally.rays, 0), gain = sumFrom(tally.squares, part);
    if (!(cost > 0.0)) break;
    const double best = gain > 0.0 ? std::sqrt(gain / variance / cost) : 0.0;
    const double rate = std::min(rate_before, std::max(limits.safety * best, limits.least));
    continuation.probability[part] = static_cast<float>(rate / rate_before);
    rate_before = rate;
  }
  if (tally.lesser_rays > 0.0 && variance > 0.0) {
    const double cost = tally.lesser_rays / sumFrom(tally.rays, 0);
    const double best = std::sqrt(tally.lesser_squares / variance / cost);
    continuation.lesser_way = static_cast<float>(std::clamp(limits.lesser_safety * best, limits.least_lesser, 1.0));
  }
  return continuation;
}

}  // namespace nephroid
