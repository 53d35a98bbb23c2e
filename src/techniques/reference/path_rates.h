// How often paths go on behind glass, and follow lesser ways there, tile by tile: learned from the render itself.
//
// A pilot's rates are one for the whole picture and on the safe side. What paths bring and cost is known far better
// after some passes, and differs from place to place: what pays where light falls in from the rim of a pool does not in
// its middle. Rates that follow from earlier passes leave each pass unbiased.
//
// What is learned is what always going on would have brought: a contribution that was followed at a rate q, and
// therefore weighs 1/q, counts q times its square. Of the variance that batches say, what those weights added is taken
// off.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "techniques/reference/continuation.h"
#include "techniques/reference/picture_tiles.h"

namespace nephroid {

class PathRates {
 public:
  /// @param first  of all tiles, until more is known
  PathRates(const PictureTiles& tiles, const Continuation& first);

  const Continuation& of(std::size_t tile) const { return rates_[tile]; }
  /// After a path, from one thread per tile. @param path  by rates of this tile
  void note(std::size_t tile, std::size_t pixel, const PartTally& path);
  /// Between rounds. @param variances  of one pass, relative, summed over the tile and channels; may be empty
  /// @param scales  what turns squares of radiance into relative ones, by pixel; may be empty: not known yet
  void choose(std::span<const double> variances, std::span<const float> scales);

  /// Visits all that a checkpoint keeps of it.
  template <class State>
  void visitState(State& state) {
    state.values(std::span(rates_));
    state.values(std::span(learned_));
    state.values(std::span(scales_));
  }

 private:
  /// What is known of a tile.
  struct Lessons {
    PartTally sum;  ///< squares relative
    double paths = 0.0;
  };
  Continuation chooseFor(std::size_t tile, std::span<const double> variances) const;
  double passesOf(std::size_t tile) const;

  PictureTiles tiles_;
  std::vector<Continuation> rates_;  ///< by tile
  std::vector<Lessons> learned_;     ///< by tile
  std::vector<float> scales_;        ///< by pixel; 0: nothing is noted of it yet
};

}  // namespace nephroid
