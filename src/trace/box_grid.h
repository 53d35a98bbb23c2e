// Boxes, found by a place that they hold.
//
// Cells of one width, by a hash. A box is entered in every cell that it meets, so that a place looks into one, and
// there as bytes: its sides in 256ths of the cell. So a place is held against sixteen boxes at once, by the vector unit
// of any processor, and next to none is looked at in vain; cells may be wide, which keeps boxes from meeting many.
#pragma once

#include <algorithm>
#include <array>
#include <bit>
#include <cstdint>
#include <cstring>
#include <span>
#include <vector>

#include "core/math.h"
#include "trace/cell_hash.h"

namespace nephroid {

class BoxGrid {
 public:
  /// A box in a cell.
  struct Entry {
    std::uint32_t bucket, id;
    std::array<std::uint8_t, 3> low, high;  ///< in 256ths of the cell, both within
  };
  /// @param cell  width of cells, m  @param boxes  that there will be
  BoxGrid(float cell, std::size_t boxes);

  glm::ivec3 cellAt(vec3 position) const { return floored(inCells(position)); }
  vec3 middleOf(glm::ivec3 cell) const { return (vec3(cell) + (0.5F - kOriginInCell)) / inverse_cell_; }
  /// What enters a box in cells that it meets, each once.
  class Box {
   public:
    /// @param low,high  corners, m  @param entries  to which is added
    Box(const BoxGrid& grid, std::uint32_t id, vec3 low, vec3 high, std::vector<Entry>& entries)
        : grid_(grid),
          id_(id),
          low_(grid.inCells(low)),
          high_(grid.inCells(high)),
          entries_(entries),
          first_(entries.size()) {}
    void enter(glm::ivec3 cell);

   private:
    const BoxGrid& grid_;
    std::uint32_t id_;
    vec3 low_, high_;  ///< in cells
    std::vector<Entry>& entries_;
    std::size_t first_;
  };
  /// Takes all entries, in the order in which they are found later. @param chunks  that order
  void close(std::span<const std::vector<Entry>> chunks);

  /// Calls `visit(id)` for all boxes that hold `position`, and now and then for others, each at most once.
  template <class Visit>
  void visitBoxesAt(vec3 position, Visit&& visit) const;

 private:
  /// Where the origin lies in its cell: not on its border, for many scenes have a floor there, which would then lie in
  /// two layers of cells.
  static constexpr float kOriginInCell = 0.37F;
  static constexpr std::size_t kSides = 6;
  /// Boxes that are looked at together.
  static constexpr std::uint32_t kLanes = 16;
  using Lanes = signed char __attribute__((vector_size(kLanes)));
  using Bytes = std::uint8_t __attribute__((vector_size(kLanes)));
  static Bytes load(const std::uint8_t* bytes) {
    Bytes result;
    std::memcpy(&result, bytes, sizeof(result));
    return result;
  }

  vec3 inCells(vec3 position) const {
    constexpr float kMost = 1e9F;  // far beyond where floats still tell cells apart
    return glm::clamp(position * inverse_cell_ + kOriginInCell, -kMost, kMost);
  }
  /// As glm::floor, without a call for each component. @param place  of what fits an integer
  static glm::ivec3 floored(vec3 place) {
    const glm::ivec3 whole(place);
    return whole - glm::ivec3(glm::lessThan(place, vec3(whole)));
  }
  /// Never falls as `place` rises, so that rounding loses no box. @param place  in cells
  static std::array<std::uint8_t, 3> stepsIn(glm::ivec3 cell, vec3 place) {
    const glm::ivec3 steps(glm::clamp((place - vec3(cell)) * 256.0F, 0.0F, 255.0F));
    return {static_cast<std::uint8_t>(steps.x), static_cast<std::uint8_t>(steps.y), static_cast<std::uint8_t>(steps.z)};
  }
  std::uint32_t bucketOf(glm::ivec3 cell) const { return hashOfCell(cell.x, cell.y, cell.z) & mask_; }

  float inverse_cell_;  ///< 1/m
  std::uint32_t mask_;
  std::vector<std::uint32_t> begin_;  ///< bucket count + 1 offsets
  std::vector<std::uint32_t> ids_;    ///< by bucket
  /// Of each bucket all low x, then all low y and so on to high z; with what the last look reads beyond the end.
  std::vector<std::uint8_t> sides_;
};

template <class Visit>
void BoxGrid::visitBoxesAt(vec3 position, Visit&& visit) const {
  static_assert(std::endian::native == std::endian::little, "the first of eight bytes is the lowest");
  const vec3 place = inCells(position);
  const glm::ivec3 cell = floored(place);
  const auto [x, y, z] = stepsIn(cell, place);
  const std::uint32_t bucket = bucketOf(cell);
  const std::size_t first = begin_[bucket], count = begin_[bucket + 1] - first;
  const std::uint8_t* sides = sides_.data() + kSides * first;
  for (std::size_t i = 0; i < count; i += kLanes) {
    const std::uint8_t *low = sides + i, *high = low + 3 * count;
    const Lanes inside = (load(low) <= x) & (load(low + count) <= y) & (load(low + 2 * count) <= z) &
                         (load(high) >= x) & (load(high + count) >= y) & (load(high + 2 * count) >= z) & 1;
    // A byte is 1 where its box may hold the place.
    const auto words = std::bit_cast<std::array<std::uint64_t, kLanes / 8>>(inside);
    for (std::size_t w = 0; w < words.size(); ++w)
      for (std::uint64_t bits = words[w]; bits != 0; bits &= bits - 1) {
        const std::size_t box = i + 8 * w + static_cast<std::size_t>(std::countr_zero(bits)) / 8;
        if (box < count) visit(ids_[first + box]);
      }
  }
}

}  // namespace nephroid
