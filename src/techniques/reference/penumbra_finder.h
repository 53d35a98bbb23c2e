// Where a picture shows penumbrae, so that light samples are drawn there and not all over it.
//
// A small lamp or a sun is hidden from a point, or it is not: light samples from there agree, and one says as much as
// four. In a penumbra they do not, and there is most of the noise of direct light; some of it is so near to full shadow
// that hardly a sample in fifty meets the light. So what is found is remembered by tiles: a quarter of a tile's pixels
// come first and draw all samples; if those agree, to the last, the others draw one each. What a path finds itself has
// no part in how many samples it draws, so that each pass is unbiased.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "techniques/reference/picture_tiles.h"

namespace nephroid {

class PenumbraFinder {
 public:
  explicit PenumbraFinder(const PictureTiles& tiles) : tiles_(tiles), found_(tiles.count(), Found::kNothing) {}

  /// May light be partly hidden from what pixel (x, y) shows? @param pass  from 0
  bool mayBeAt(int x, int y, std::uint32_t pass) const {
    const Found found = found_[tiles_.tileOf(x, y)];
    const bool is_first = pass == 0 && PictureTiles::comesFirst(x, y);
    return is_first || found == Found::kNothing || found == Found::kBoth;
  }
  /// After a path, from one thread per tile. @param seen  light samples that met nothing, of those `asked`
  void note(int x, int y, std::uint32_t seen, std::uint32_t asked) {
    Found& found = found_[tiles_.tileOf(x, y)];
    const Found here = seen == 0 ? Found::kShadow : seen == asked ? Found::kLight : Found::kBoth;
    found = found == Found::kNothing || found == here ? here : Found::kBoth;
  }

  /// Visits all that a checkpoint keeps of it.
  template <class State>
  void visitState(State& state) {
    state.values(std::span(found_));
  }

 private:
  enum class Found : std::uint8_t { kNothing, kShadow, kLight, kBoth };

  PictureTiles tiles_;
  std::vector<Found> found_;  ///< by tile
};

}  // namespace nephroid
