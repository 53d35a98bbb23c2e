// The squares into which the reference cuts a picture: what one task does, and what may be given more passes than
// others.
#pragma once

#include <algorithm>
#include <cstddef>

namespace nephroid {

/// Numbered row by row. Those along the right and the lower border may be smaller.
class PictureTiles {
 public:
  /// Small, so that work can follow the outline of a shadow; large enough for the spread within to mean something.
  static constexpr int kSide = 8;

  PictureTiles(int width, int height) : width_(width), height_(height), columns_((width + kSide - 1) / kSide) {}

  int width() const { return width_; }
  int height() const { return height_; }
  std::size_t pixels() const { return static_cast<std::size_t>(width_) * static_cast<std::size_t>(height_); }
  std::size_t count() const {
    return static_cast<std::size_t>(columns_) * static_cast<std::size_t>((height_ + kSide - 1) / kSide);
  }
  std::size_t tileOf(int x, int y) const {
    return static_cast<std::size_t>(y / kSide) * static_cast<std::size_t>(columns_) +
           static_cast<std::size_t>(x / kSide);
  }
  /// Of the quarter of a tile's pixels, spread over it, that are visited before the others?
  static bool comesFirst(int x, int y) { return x % 2 == 0 && y % 2 == 0; }
  /// Calls `visit(x, y)` for every pixel of a tile.
  template <class Visit>
  void visitPixels(std::size_t tile, const Visit& visit) const {
    const int x_first = static_cast<int>(tile % static_cast<std::size_t>(columns_)) * kSide;
    const int y_first = static_cast<int>(tile / static_cast<std::size_t>(columns_)) * kSide;
    for (const bool first : {true, false})
      for (int y = y_first; y < std::min(y_first + kSide, height_); ++y)
        for (int x = x_first; x < std::min(x_first + kSide, width_); ++x)
          if (comesFirst(x, y) == first) visit(x, y);
  }
  /// Calls `visit(other)` for a tile and those that touch it.
  template <class Visit>
  void visitAround(std::size_t tile, const Visit& visit) const {
    const auto columns = static_cast<std::size_t>(columns_), rows = count() / columns;
    const std::size_t column = tile % columns, row = tile / columns;
    for (std::size_t r = row > 0 ? row - 1 : 0; r < std::min(row + 2, rows); ++r)
      for (std::size_t c = column > 0 ? column - 1 : 0; c < std::min(column + 2, columns); ++c) visit(r * columns + c);
  }
  std::size_t pixelOf(int x, int y) const {
    return static_cast<std::size_t>(y) * static_cast<std::size_t>(width_) + static_cast<std::size_t>(x);
  }

 private:
  int width_, height_, columns_;
};

}  // namespace nephroid
