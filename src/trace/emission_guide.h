// Where in its emission domain a light's photons are worth most: a density over the unit square that the domain is
// drawn from.
//
// Importance sampling in primary sample space: the two numbers that would choose the place evenly are warped first, and
// the photon's flux is divided by the density of the warp, so whatever the guide holds changes the noise and never the
// expectation.
#pragma once

#include <array>
#include <cstddef>
#include <span>
#include <vector>

#include "core/math.h"

namespace nephroid {

/// Immutable; safe from any thread.
class EmissionGuide {
 public:
  /// Blocks along each side of the square, each of one density. A power of two, for the tree of halvings.
  static constexpr int kSide = 64;

  /// @param weights  of the blocks, row by row, kSide × kSide, >= 0, of any scale; none positive: everything even
  /// @param even     share of the photons that are emitted evenly all the same, in (0, 1]: no flux is ever divided by
  ///                 less than it
  EmissionGuide(std::span<const float> weights, float even);

  /// From even numbers in [0, 1)² to guided ones in [0, 1)². A bijection, by halvings of the square along each side in
  /// turn: stratified numbers stay stratified. @param density  becomes that of the place, 1 on average over the square
  vec2 warp(vec2 u, float& density) const;
  /// Density of `warp` at a place in the unit square: of its block.
  float densityAt(vec2 place) const;
  /// The same of a block, counted row by row.
  float densityOfBlock(std::size_t block) const { return sums_[kLevels][block]; }

 private:
  static constexpr int kLevels = 6;
  static_assert(1 << kLevels == kSide);
  /// Sums of a level are `1 << level` along each side; the finest are the densities.
  std::array<std::vector<float>, kLevels + 1> sums_;
};

}  // namespace nephroid
