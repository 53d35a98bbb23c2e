// Repeatable chance for the shapes of built-in scenes: a number from a seed and two counters, the same everywhere.
#pragma once

#include <cstdint>

namespace nephroid {

/// Scrambles 64 bits (the finaliser of SplitMix64, Steele et al. 2014).
inline std::uint64_t scrambleBits(std::uint64_t x) {
  x += 0x9E3779B97F4A7C15U;
  x = (x ^ (x >> 30)) * 0xBF58476D1CE4E5B9U;
  x = (x ^ (x >> 27)) * 0x94D049BB133111EBU;
  return x ^ (x >> 31);
}

/// A number in [0, 1) that depends on all three.
inline double hashToUnit(std::int64_t seed, std::int64_t item, std::int64_t dimension) {
  const std::uint64_t bits =
      scrambleBits(scrambleBits(scrambleBits(static_cast<std::uint64_t>(seed)) + static_cast<std::uint64_t>(item)) +
                   static_cast<std::uint64_t>(dimension));
  return static_cast<double>(bits >> 11) * 0x1p-53;
}

}  // namespace nephroid
