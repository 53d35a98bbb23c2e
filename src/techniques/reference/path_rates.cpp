#include "techniques/reference/path_rates.h"

#include <algorithm>

#include "core/parallel.h"

namespace nephroid {
namespace {

/// Passes that a tile learns from before it has rates of its own.
constexpr double kFewestPasses = 16.0;
/// Of a variance that much is left at least when what rates added is taken off: batches know of points that are spread
/// well, squares do not.
constexpr double kLeastVariance = 0.25;
constexpr RateLimits kLearned{.safety = 2.0, .least = 0.1, .lesser_safety = 2.0, .least_lesser = 0.1};

}  // namespace

PathRates::PathRates(const PictureTiles& tiles, const Continuation& first)
    : tiles_(tiles), rates_(tiles.count(), first), learned_(tiles.count()), scales_(tiles.pixels(), 0.0F) {}

void PathRates::note(std::size_t tile, std::size_t pixel, const PartTally& path) {
  const double scale = scales_[pixel];
  if (scale <= 0.0) return;
  learned_[tile].sum.add(path, scale, 1.0);
  learned_[tile].paths += 1.0;
}

void PathRates::choose(std::span<const double> variances, std::span<const float> scales) {
  std::copy(scales.begin(), scales.end(), scales_.begin());
  if (variances.empty()) return;
  parallelFor(tiles_.count(), [&](std::size_t tile) {
    if (passesOf(tile) >= kFewestPasses) rates_[tile] = chooseFor(tile, variances);
  });
}

double PathRates::passesOf(std::size_t tile) const {
  std::size_t pixels = 0;
  tiles_.visitPixels(tile, [&](int, int) { ++pixels; });
  return learned_[tile].paths / static_cast<double>(pixels);
}

/// With its neighbours, which make up for what few paths have not met yet.
Continuation PathRates::chooseFor(std::size_t tile, std::span<const double> variances) const {
  PartTally of_pass;
  double variance = 0.0;
  tiles_.visitAround(tile, [&](std::size_t near) {
    const double passes = passesOf(near);
    if (passes < kFewestPasses) return;
    of_pass.add(learned_[near].sum, 1.0 / passes, 1.0 / passes);
    variance += variances[near];
  });
  return chooseContinuation(of_pass, std::max(variance - of_pass.excess, kLeastVariance * variance), kLearned);
}

}  // namespace nephroid
