#include "trace/emission_guide.h"

#include <algorithm>
#include <numeric>

namespace nephroid {
namespace {

/// Where [0, 1) is cut so that a share `low / (low + high)` lies below: takes `u` into its half and stretches it.
/// @return whether it is the upper half
bool descend(float& u, float low, float high) {
  const float cut = low / (low + high);
  const bool upper = u >= cut;
  u = upper ? (u - cut) / (1.0F - cut) : u / cut;
  u = std::min(u, kOneMinusEpsilon);
  return upper;
}

std::size_t blockOf(float x) {
  return static_cast<std::size_t>(
      std::clamp(static_cast<int>(x * static_cast<float>(EmissionGuide::kSide)), 0, EmissionGuide::kSide - 1));
}

}  // namespace

EmissionGuide::EmissionGuide(std::span<const float> weights, float even) {
  const double mean = std::accumulate(weights.begin(), weights.end(), 0.0) / static_cast<double>(weights.size());
  std::vector<float>& finest = sums_[kLevels];
  for (const float w : weights)
    finest.push_back(mean > 0.0 ? even + (1.0F - even) * static_cast<float>(w / mean) : 1.0F);
  for (int level = kLevels - 1; level >= 0; --level) {
    const std::size_t side = std::size_t{1} << level;
    const std::vector<float>& finer = sums_[level + 1];
    for (std::size_t y = 0; y < side; ++y)
      for (std::size_t x = 0; x < side; ++x) {
        const std::size_t corner = 4 * y * side + 2 * x;
        sums_[level].push_back(finer[corner] + finer[corner + 1] + finer[corner + 2 * side] +
                               finer[corner + 2 * side + 1]);
      }
  }
}

vec2 EmissionGuide::warp(vec2 u, float& density) const {
  std::size_t x = 0, y = 0;
  for (int level = 1; level <= kLevels; ++level) {
    const std::vector<float>& sums = sums_[level];
    const std::size_t side = std::size_t{1} << level;
    const float* top = &sums[2 * y * side + 2 * x];
    const float* bottom = top + side;
    const bool lower_half = descend(u.y, top[0] + top[1], bottom[0] + bottom[1]);
    const float* row = lower_half ? bottom : top;
    const bool right = descend(u.x, row[0], row[1]);
    x = 2 * x + (right ? 1 : 0), y = 2 * y + (lower_half ? 1 : 0);
  }
  density = sums_[kLevels][y * kSide + x];
  const vec2 place = (vec2(static_cast<float>(x), static_cast<float>(y)) + u) / static_cast<float>(kSide);
  // Rounding must not carry a place into the next block, whose density is another.
  const vec2 end = vec2(static_cast<float>(x + 1), static_cast<float>(y + 1)) / static_cast<float>(kSide);
  return glm::min(place, end * kOneMinusEpsilon);
}

float EmissionGuide::densityAt(vec2 place) const { return sums_[kLevels][blockOf(place.y) * kSide + blockOf(place.x)]; }

}  // namespace nephroid
