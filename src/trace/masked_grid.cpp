#include "trace/masked_grid.h"

#include <cmath>

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

void markBlock(MaskedGrid& grid, float one_minus_cos, int x, int y, int size, const std::vector<DirectionCap>& caps) {
  const DirectionCap block = boundBlock(grid, one_minus_cos, x, y, size);
  // Blocks of more than an eighth of the square bend too much for the bound above: they always split.
  const bool split_always = size > grid.width() / 8;
  std::vector<DirectionCap> inside;
  for (const DirectionCap& cap : caps) {
    if (!split_always && !overlap(block, cap)) continue;
    if (size == 1 || (!split_always && contains(cap, block))) {
      for (int j = y; j < y + size; ++j)
        for (int i = x; i < x + size; ++i) grid.mark(i, j);
      return;
    }
    inside.push_back(cap);
  }
  if (inside.empty()) return;
  const int half = size / 2;
  for (const int dy : {0, half})
    for (const int dx : {0, half}) markBlock(grid, one_minus_cos, x + dx, y + dy, half, inside);
}

}  // namespace

vec3 capFromSquare(vec2 uv, float one_minus_cos) {
  const vec2 disc = sampleConcentricDisc(uv);
  const float r2 = dot(disc, disc);
  // sin θ = √(1 − z²) with z = 1 − r²(1 − cos): factored, so that the sun's half degree keeps its digits.
  const float stretch = std::sqrt(std::max(one_minus_cos * (2.0F - r2 * one_minus_cos), 0.0F));
  return {disc.x * stretch, disc.y * stretch, 1.0F - r2 * one_minus_cos};
}

void markCaps(MaskedGrid& grid, float one_minus_cos, const std::vector<DirectionCap>& caps) {
  markBlock(grid, one_minus_cos, 0, 0, grid.width(), caps);
}

}  // namespace nephroid
