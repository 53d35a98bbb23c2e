#include "techniques/reference/eye_passes.h"

#include <algorithm>
#include <numeric>

#include "core/parallel.h"

namespace nephroid {

EyePasses::EyePasses(int width, int height)
    : tiles_(width, height), done_(tiles_.count(), 0), planned_(tiles_.count(), 0), rays_(tiles_.count(), 0) {}

std::uint64_t EyePasses::meanPasses() const {
  std::uint64_t paths = 0, pixels = 0;
  for (std::size_t t = 0; t < tiles_.count(); ++t)
    tiles_.visitPixels(t, [&](int, int) { paths += done_[t], ++pixels; });
  return (paths + pixels / 2) / pixels;
}

void EyePasses::planAll() { std::fill(planned_.begin(), planned_.end(), 1U); }

void EyePasses::planWhereItPays(std::span<const double> variances, std::uint32_t quantum) {
  double whole = 0.0;  // rays of a pass over everything
  std::vector<double> cost(tiles_.count()), worth(tiles_.count());
  for (std::size_t t = 0; t < tiles_.count(); ++t) {
    const auto n = static_cast<double>(done_[t]);
    // A tile that needs no rays is not free.
    cost[t] = std::max(static_cast<double>(rays_[t]), 1.0) / n;
    worth[t] = variances[t] / (cost[t] * n * n);
    whole += cost[t];
  }
  std::vector<std::size_t> order(tiles_.count());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::stable_sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) { return worth[a] > worth[b]; });
  double planned = 0.0;
  for (std::size_t i = 0; i < order.size() && planned < whole; ++i) {
    const std::size_t t = order[i];
    planned_[t] = quantum - static_cast<std::uint32_t>(done_[t] % quantum);
    planned += cost[t] * planned_[t];
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
      tiles_.visitPixels(t, [&](int x, int y) { rays_[t] += trace(x, y, sample); });
    }
    done_[t] += planned_[t];
    planned_[t] = 0;
  });
}

}  // namespace nephroid
