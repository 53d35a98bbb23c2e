// Which pixels of pictures are compared.
#pragma once

#include <fmt/format.h>

#include <cstdint>
#include <span>

#include "core/image/image.h"
#include "nephroid/error.h"

namespace nephroid {

/// One entry per pixel; empty: all count.
using Mask = std::span<const std::uint8_t>;

/// The value of a mask's pixels that count. Anything else does not: a resampled or lossy mask has soft edges, whose
/// pixels belong to neither side.
constexpr std::uint8_t kSelected = 255;

/// @throws InputError
inline void checkMask(const Image& image, Mask mask) {
  const auto pixel_count = static_cast<std::size_t>(image.width) * static_cast<std::size_t>(image.height);
  if (!mask.empty() && mask.size() != pixel_count)
    throw InputError(fmt::format("mask of {} pixels for an image of {} x {}; expected one of the same size",
                                 mask.size(), image.width, image.height));
}

/// @throws InputError
inline void checkSameSize(const Image& image, const Image& reference) {
  if (image.width != reference.width || image.height != reference.height)
    throw InputError(fmt::format("image of {} x {} pixels, reference of {} x {}; render both at the same size",
                                 image.width, image.height, reference.width, reference.height));
}

/// Calls `visit(x, y)` for the pixels that count, row by row.
/// @throws InputError if there is none
template <class Visit>
void forEachPixel(const Image& image, Mask mask, const Visit& visit) {
  std::size_t count = 0;
  std::size_t index = 0;
  for (int y = 0; y < image.height; ++y)
    for (int x = 0; x < image.width; ++x, ++index) {
      if (!mask.empty() && mask[index] != kSelected) continue;
      visit(x, y);
      ++count;
    }
  if (count == 0) throw InputError("nothing to measure: the mask selects no pixel; pixels of value 255 count");
}

}  // namespace nephroid
