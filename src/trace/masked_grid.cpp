#include "trace/masked_grid.h"

#include <cmath>
#include <span>
#include <utility>

#include "core/sampling/warp.h"

namespace nephroid {
namespace {

bool overlap(const DirectionCap& a, const DirectionCap& b) {
  // Angles add up to a half turn or more: they cover everything between them.
  if (a.cos_angle < -b.cos_angle) return true;
  return dot(a.axis, b.axis) >= a.cos_angle * b.cos_angle - a.sin_angle * b.sin_angle - 1e-6F;
}

/// True only if `inner` lies wholly in `outer`.
bool contains(const DirectionCap& outer, const DirectionCap& inner) {
  if (outer.cos_angle > inner.cos_angle) return false;
  return dot(outer.axis, inner.axis) >= outer.cos_angle * inner.cos_angle + outer.sin_angle * inner.sin_angle + 1e-6F;
}

/// A cap that holds the image of a block of cells: about the image of its centre, as wide as the farthest of eight
/// points of its border, and a quarter more for the curvature between them.
DirectionCap boundBlock(const MaskedGrid& grid, float one_minus_cos, int x, int y, int size) {
  const auto image = [&](float i, float j) {
    return capFromSquare(
        vec2((static_cast<float>(x) + i * static_cast<float>(size)) / static_cast<float>(grid.width()),
             (static_cast<float>(y) + j * static_cast<float>(size)) / static_cast<float>(grid.height())),
        one_minus_cos);
  };
  DirectionCap cap{image(0.5F, 0.5F), 1.0F, 0.0F};
  float chord = 0.0F;
  for (const float i : {0.0F, 0.5F, 1.0F})
    for (const float j : {0.0F, 0.5F, 1.0F}) chord = std::max(chord, length(image(i, j) - cap.axis));
  // Half the chord is the sine of half the angle.
  const float angle = std::min(1.25F * 2.0F * std::asin(std::min(0.5F * chord, 1.0F)), kPi);
  cap.cos_angle = std::cos(angle);
  cap.sin_angle = std::sin(angle);
  return cap;
}

/// @param finest  blocks of so many cells along each side are not split any more  @param caps  comes back in any order
void markBlock(MaskedGrid& grid, float one_minus_cos, int x, int y, int size, int finest,
               std::span<DirectionCap> caps) {
  // Blocks of more than an eighth of the square bend too much for the bound above: they always split.
  const bool split_always = size > grid.width() / 8;
  const int half = size / 2;
  if (split_always) {
    for (const int dy : {0, half})
      for (const int dx : {0, half}) markBlock(grid, one_minus_cos, x + dx, y + dy, half, finest, caps);
    return;
  }
  const DirectionCap block = boundBlock(grid, one_minus_cos, x, y, size);
  std::size_t inside = 0;  // of them, all at the front
  for (DirectionCap& cap : caps) {
    if (!overlap(block, cap)) continue;
    if (size <= finest || contains(cap, block)) {
      for (int j = y; j < y + size; ++j)
        for (int i = x; i < x + size; ++i) grid.mark(i, j);
      return;
    }
    std::swap(cap, caps[inside++]);
  }
  if (inside == 0) return;
  for (const int dy : {0, half})
    for (const int dx : {0, half}) markBlock(grid, one_minus_cos, x + dx, y + dy, half, finest, caps.first(inside));
}

}  // namespace

vec3 capFromSquare(vec2 uv, float one_minus_cos) {
  const vec2 disc = sampleConcentricDisc(uv);
  const float r2 = dot(disc, disc);
  // sin θ = √(1 − z²) with z = 1 − r²(1 − cos): factored, so that the sun's half degree keeps its digits.
  const float stretch = std::sqrt(std::max(one_minus_cos * (2.0F - r2 * one_minus_cos), 0.0F));
  return {disc.x * stretch, disc.y * stretch, 1.0F - r2 * one_minus_cos};
}

vec2 squareFromCap(vec3 dir, float one_minus_cos) {
  // 1 − z = (x² + y²) / (1 + z), which keeps its digits near the axis.
  const float sine2 = dir.x * dir.x + dir.y * dir.y;
  const float rise = dir.z > 0.0F ? sine2 / (1.0F + dir.z) : 1.0F - dir.z;
  const float sine = std::sqrt(sine2), r = std::min(std::sqrt(rise / one_minus_cos), 1.0F);
  return invertConcentricDisc(sine > 0.0F ? vec2(dir.x, dir.y) * (r / sine) : vec2(r, 0.0F));
}

void CapMerger::add(const DirectionCap& cap) {
  std::uint64_t place = 0;
  for (int k = 0; k < 3; ++k)  // of [−1, 1] no more than 2²⁰ steps are told apart
    place = (place << 21) | static_cast<std::uint64_t>((cap.axis[k] + 1.0F) * std::min(inverse_spacing_, 0x1p19F));
  if (caps_.empty() || place != last_place_) {
    const auto [found, is_new] = cap_of_place_.try_emplace(place, caps_.size());
    last_place_ = place, last_ = found->second;
    if (is_new) {
      caps_.push_back(cap);
      return;
    }
  }
  DirectionCap& merged = caps_[last_];
  if (contains(merged, cap)) return;
  // As wide as the farther side of the other, and a little more for rounding. Half the chord is the sine of half the
  // angle between the axes: no angle need be known.
  const vec3 chord = cap.axis - merged.axis;
  const float half_squared = std::min(0.25F * dot(chord, chord), 1.0F);
  const float cos_apart = 1.0F - 2.0F * half_squared,
              sin_apart = 2.0F * std::sqrt(half_squared * (1.0F - half_squared));
  constexpr float kSlack = 1e-6F;
  const float sine = sin_apart * cap.cos_angle + cos_apart * cap.sin_angle + kSlack;
  const float cosine = cos_apart * cap.cos_angle - sin_apart * cap.sin_angle - kSlack * sine;
  if (sine <= kSlack || cosine <= -1.0F)
    merged.cos_angle = -1.0F, merged.sin_angle = 0.0F;
  else if (cosine < merged.cos_angle)
    merged.cos_angle = cosine, merged.sin_angle = sine;
}

void markCaps(MaskedGrid& grid, float one_minus_cos, std::vector<DirectionCap> caps) {
  // The border is as coarse as a sixteenth of the smallest cap: finer, and large caps, of which many overlap, take
  // long.
  float least_sine = 1.0F;
  for (const DirectionCap& cap : caps) least_sine = std::min(least_sine, cap.sin_angle);
  const float cell_angle = std::sqrt(2.0F * kPi * one_minus_cos) / static_cast<float>(grid.width());
  int finest = 1;
  while (static_cast<float>(2 * finest) * cell_angle <= 0.0625F * least_sine) finest *= 2;
  markBlock(grid, one_minus_cos, 0, 0, grid.width(), std::min(finest, grid.width() / 8), caps);
}

}  // namespace nephroid
