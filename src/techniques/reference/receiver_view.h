// What each pixel of the picture sees first, at its centre: where a photon that is spread over pixels may count.
#pragma once

#include <cstdint>
#include <vector>

#include "techniques/reference/world.h"

namespace nephroid {

class ReceiverView {
 public:
  struct Seen {
    vec3 position;           ///< world, m
    std::uint32_t instance;  ///< kNone: nothing, or something with holes or panes
  };
  /// One ray per pixel, over all threads.
  explicit ReceiverView(const ReferenceWorld& world);

  int width() const { return width_; }
  int height() const { return height_; }
  const Seen& at(int x, int y) const { return seen_[static_cast<std::size_t>(y) * width_ + x]; }

 private:
  int width_, height_;
  std::vector<Seen> seen_;  ///< height × width
};

}  // namespace nephroid
