// Halton points: the radical inverse of the index in one prime base per dimension [halton-1960], scrambled or not.
#pragma once

#include <cstdint>

namespace nephroid {

/// Dimensions that halton() has, one prime each (2 … 311).
inline constexpr int kHaltonDimensions = 64;

/// One coordinate of one point, in [0, 1).
///
/// @param index          of the point
/// @param dimension      in [0, kHaltonDimensions)
/// @param scramble_seed  0: plain, with the correlations between large bases that plain Halton points have. Else each
///                       digit is permuted by an affine map of its field, chosen by a hash of the seed, the dimension
///                       and the digits before it: nested as in Owen's scrambling, with p(p − 1) of the p! maps.
float halton(std::uint32_t index, int dimension, std::uint32_t scramble_seed);

}  // namespace nephroid
