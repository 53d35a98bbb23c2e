#include "techniques/reference/eye_passes.h"

#include <algorithm>
#include <cmath>

#include "core/parallel.h"

namespace nephroid {
namespace {

/// A tile that seems to be done gets this part of a mean tile's passes nevertheless: its variance may only seem small.
constexpr double kLeastRate = 0.2;

}  // namespace

EyePasses::EyePasses(int width, int height)
    : tiles_(width, height),
      done_(tiles_.count(), 0),
      planned_(tiles_.count(), 0),
      costs_(tiles_.count(), 0),
      due_(tiles_.count(), 0.0) {}

std::uint64_t EyePasses::meanPasses() const {
  std::uint64_t paths = 0, pixels = 0;
  for (std::size_t t = 0; t < tiles_.count(); ++t)
    tiles_.visitPixels(t, [&](int, int) { paths += done_[t], ++pixels; });
  return (paths + pixels / 2) / pixels;
}

void EyePasses::planAll() { std::fill(planned_.begin(), planned_.end(), 1U); }

/// Passes a round, by tile.
std::vector<double> EyePasses::ratesWhereItPays(std::span<const double> variances) const {
  const std::size_t count = tiles_.count();
  double whole = 0.0, spent = 0.0, wanted = 0.0;
  std::vector<double> cost(count), rates(count);
  for (std::size_t t = 0; t < count; ++t) {
    // A tile that needs no rays is not free.
    const double all = std::max(static_cast<double>(costs_[t]), 1.0);
    cost[t] = all / static_cast<double>(done_[t]);
    rates[t] = std::sqrt(variances[t] / cost[t]);
    whole += cost[t], spent += all, wanted += cost[t] * rates[t];
  }
  if (!(wanted > 0.0)) return std::vector<double>(count, 1.0);
  const double mean = spent / whole;
  double planned = 0.0;
  for (std::size_t t = 0; t < count; ++t) {
    const double goal = 2.0 * spent / wanted * rates[t];
    rates[t] = std::max(goal - static_cast<double>(done_[t]), kLeastRate * mean);
    planned += cost[t] * rates[t];
  }
  for (double& rate : rates) rate *= whole / planned;
  return rates;
}

void EyePasses::planWhereItPays(std::span<const double> variances) {
  const std::vector<double> rates = ratesWhereItPays(variances);
  for (std::size_t t = 0; t < tiles_.count(); ++t) {
    due_[t] += rates[t];
    planned_[t] = static_cast<std::uint32_t>(std::max(std::round(due_[t]), 0.0));
    due_[t] -= planned_[t];
  }
}

bool EyePasses::planned() const {
  return std::any_of(planned_.begin(), planned_.end(), [](std::uint32_t passes) { return passes > 0; });
}

void EyePasses::run(const std::function<std::uint64_t(int x, int y, std::uint32_t sample)>& trace,
                    const std::function<bool()>& stopped) {
  parallelFor(tiles_.count(), [&](std::size_t t) {
    if (planned_[t] == 0 || stopped()) return;
    for (std::uint32_t pass = 0; pass < planned_[t]; ++pass) {
      const auto sample = static_cast<std::uint32_t>(done_[t]) + pass;
      tiles_.visitPixels(t, [&](int x, int y) { costs_[t] += trace(x, y, sample); });
    }
    done_[t] += planned_[t];
    planned_[t] = 0;
  });
}

}  // namespace nephroid
