// Hash of a cell of a grid over space (Teschner 2003).
#pragma once

#include <cstdint>

namespace nephroid {

/// Hash of a grid's cell. Blocks of 4 × 4 × 4 cells are hashed, not single ones: what is near in space is near in
/// memory, and searches side by side find it in the cache.
inline std::uint32_t hashOfCell(int x, int y, int z) {
  // Counted from far off: −a ^ −b is a ^ b where a and b have as many factors of two, so that about the origin a third
  // of the blocks of a floor would share their hash with those across it.
  const auto blockAt = [](int cell) { return static_cast<std::uint32_t>(cell >> 2) + 0x9E3779B9U; };
  const std::uint32_t block = blockAt(x) * 73856093U ^ blockAt(y) * 19349663U ^ blockAt(z) * 83492791U;
  const auto within = static_cast<std::uint32_t>((x & 3) | (y & 3) << 2 | (z & 3) << 4);
  return block << 6 | within;
}

}  // namespace nephroid
