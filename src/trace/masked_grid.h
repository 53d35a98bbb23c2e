// A unit square cut into cells of which some are marked; samples fall on the marked ones only, evenly by area.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <unordered_map>
#include <vector>

#include "core/math.h"

namespace nephroid {

/// At most 65 535 cells wide and high.
class MaskedGrid {
 public:
  MaskedGrid(int width, int height)
      : width_(width), height_(height), marked_(static_cast<std::size_t>(width) * height, 0) {}
  int width() const { return width_; }
  int height() const { return height_; }
  void mark(int x, int y) { marked_[static_cast<std::size_t>(y) * width_ + x] = 1; }
  bool isMarked(int x, int y) const { return marked_[static_cast<std::size_t>(y) * width_ + x] != 0; }

  /// Ends marking. Cells are listed row by row, so that stratified numbers stay stratified over the marked area.
  void finish() {
    runs_.clear();
    row_runs_.assign(1, 0);
    row_begin_.assign(1, 0);
    std::uint32_t count = 0;
    for (int y = 0; y < height_; ++y) {
      for (int x = 0; x < width_; ++x) {
        if (!isMarked(x, y)) continue;
        if (x == 0 || !isMarked(x - 1, y)) runs_.push_back({count, static_cast<std::uint32_t>(x)});
        ++count;
      }
      row_runs_.push_back(static_cast<std::uint32_t>(runs_.size()));
      row_begin_.push_back(count);
    }
    buildGuide();
  }
  std::size_t markedCount() const { return row_begin_.back(); }
  /// Marked share of the square: 1 / density of `sample`.
  double markedFraction() const {
    return static_cast<double>(markedCount()) / (static_cast<double>(width_) * static_cast<double>(height_));
  }
  /// A point of the marked cells: the row by u.y, the place in the row by u.x. @pre markedCount() > 0
  vec2 sample(vec2 u) const {
    // Doubles: a float has too few bits to tell places within one of a million cells.
    const double along = static_cast<double>(u.y) * row_begin_.back();
    const auto target = std::min(static_cast<std::uint32_t>(along), row_begin_.back() - 1);
    std::uint32_t row =
        guide_[std::min(static_cast<std::size_t>(u.y * static_cast<float>(guide_.size())), guide_.size() - 1)];
    // The guide is near; rounding may have it off either way.
    while (row_begin_[row] > target) --row;
    while (row_begin_[row + 1] <= target) ++row;
    const std::uint32_t begin = row_begin_[row], count = row_begin_[row + 1] - begin;
    const double in_row = static_cast<double>(u.x) * count;
    const std::uint32_t cell = std::min(static_cast<std::uint32_t>(in_row), count - 1);
    return {static_cast<float>((columnOf(row, begin + cell) + (in_row - cell)) / width_),
            static_cast<float>((row + (along - begin) / count) / height_)};
  }
  /// The numbers of which `sample` makes a point; of a point that is not marked, those of a marked one near by in its
  /// row, or of the next row that has any. @pre markedCount() > 0
  vec2 invert(vec2 point) const {
    const auto cellOf = [](double x, int count) { return std::clamp(static_cast<int>(std::floor(x)), 0, count - 1); };
    const double x = static_cast<double>(point.x) * width_, y = static_cast<double>(point.y) * height_;
    const auto row = static_cast<std::uint32_t>(cellOf(y, height_));
    const std::uint32_t begin = row_begin_[row], count = row_begin_[row + 1] - begin;
    const auto all = static_cast<double>(row_begin_.back());
    if (count == 0) return {0.5F, static_cast<float>(std::min(begin / all, 1.0))};
    const auto column = static_cast<std::uint32_t>(cellOf(x, width_));
    const auto first = runs_.begin() + row_runs_[row], end = runs_.begin() + row_runs_[row + 1];
    const auto isBefore = [](std::uint32_t c, const Run& run) { return c < run.column; };
    const auto next = std::upper_bound(first, end, column, isBefore);
    double in_row = 0.0;
    if (next != first) {
      const std::uint32_t run_end = next == end ? begin + count : next->first;
      const Run& run = *(next - 1);
      in_row = std::min<double>(run.first - begin + (x - run.column), run_end - begin);
    }
    return {static_cast<float>(in_row / count),
            static_cast<float>((begin + std::clamp(y - row, 0.0, 1.0) * count) / all)};
  }

 private:
  /// Entries of the guide: so many that the row is mostly the guessed one or the next.
  static constexpr int kGuidesPerRow = 2;
  /// Up to so many runs are looked through one by one.
  static constexpr std::uint32_t kFewRuns = 8;
  /// Marked neighbours in a row. Few numbers, unlike a list of the cells: they stay in the cache while photons are
  /// emitted all over.
  struct Run {
    std::uint32_t first;   ///< count of the marked cells before it, row by row
    std::uint32_t column;  ///< of its first cell
  };
  std::uint32_t columnOf(std::uint32_t row, std::uint32_t cell) const {
    // The last run that begins at or before the cell; most rows have one or two.
    std::uint32_t run = row_runs_[row + 1] - 1;
    if (run - row_runs_[row] < kFewRuns) {
      while (runs_[run].first > cell) --run;
    } else {
      const auto begin = runs_.begin() + row_runs_[row], end = runs_.begin() + row_runs_[row + 1];
      const auto isBefore = [](std::uint32_t c, const Run& r) { return c < r.first; };
      run = static_cast<std::uint32_t>(std::upper_bound(begin, end, cell, isBefore) - runs_.begin()) - 1;
    }
    return runs_[run].column + (cell - runs_[run].first);
  }
  void buildGuide() {
    const auto steps = static_cast<std::uint64_t>(kGuidesPerRow) * static_cast<std::uint64_t>(height_);
    guide_.clear();
    std::uint32_t row = 0;
    for (std::uint64_t k = 0; k < steps && markedCount() > 0; ++k) {
      while (row_begin_[row + 1] <= markedCount() * k / steps) ++row;
      guide_.push_back(row);
    }
  }

  int width_, height_;
  std::vector<std::uint8_t> marked_;
  std::vector<Run> runs_;                    ///< row by row
  std::vector<std::uint32_t> row_runs_;      ///< height + 1 offsets into runs_
  std::vector<std::uint32_t> guide_;         ///< row of every step of u.y
  std::vector<std::uint32_t> row_begin_{0};  ///< height + 1 counts of the marked cells before each row
};

/// Equal-area map of the square [0, 1]² onto the spherical cap about +z: concentric disc, then lifted.
/// @param one_minus_cos  1 − cos of the cap's half-angle, in (0, 2]; 2 is the whole sphere
vec3 capFromSquare(vec2 uv, float one_minus_cos);
/// Its inverse, up to rounding. @param dir  unit
vec2 squareFromCap(vec3 dir, float one_minus_cos);

/// A cone of directions.
struct DirectionCap {
  vec3 axis;  ///< unit, in the frame of the grid's cap
  float cos_angle, sin_angle;
};
/// Takes caps whose axes are nearly the same as one: a fine mesh has far more triangles than there are cells.
class CapMerger {
 public:
  /// @param spacing  axes nearer than this may be one, radians: what a cap may grow by
  explicit CapMerger(float spacing) : inverse_spacing_(1.0F / spacing) {}
  void add(const DirectionCap& cap);
  const std::vector<DirectionCap>& caps() const { return caps_; }

 private:
  float inverse_spacing_;
  std::vector<DirectionCap> caps_;
  std::unordered_map<std::uint64_t, std::size_t> cap_of_place_;
  // Caps of neighbours come one after the other.
  std::uint64_t last_place_ = 0;
  std::size_t last_ = 0;  ///< cap of it
};

/// Marks every cell of `grid` that maps into one of `caps` through `capFromSquare`, and few others.
void markCaps(MaskedGrid& grid, float one_minus_cos, std::vector<DirectionCap> caps);

}  // namespace nephroid
