#include "trace/kernel_map.h"

#include <algorithm>
#include <cmath>

namespace nephroid {

KernelMap::KernelMap(std::span<const GridPhoton> photons, const KernelRadii& radii, float scale) {
  if (photons.empty()) return;
  std::vector<std::vector<KernelPhoton>> levels;
  for (const GridPhoton& photon : photons) {
    const float radius = radii.at(photon.position);
    const auto level = static_cast<std::size_t>(std::max(0.0F, std::floor(std::log2(radii.widest() / radius))));
    if (levels.size() <= level) levels.resize(level + 1);
    const float squared = radius * radius * scale * scale;
    levels[level].push_back({photon, squared, 1.0F / (kPi * squared)});
  }
  for (std::size_t level = 0; level < levels.size(); ++level)
    if (!levels[level].empty())
      grids_.emplace_back(levels[level], scale * std::ldexp(radii.widest(), -static_cast<int>(level)));
}

}  // namespace nephroid
