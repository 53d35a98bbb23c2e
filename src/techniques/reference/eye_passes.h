// Passes of paths from the eye, tile by tile: how many each has had, and which get the next ones.
//
// A pass is one path through each pixel. Where errors steer a render it need not go everywhere: with v_t the variance
// of one pass over tile t, relative to what is seen there, and c_t what it costs, the error Σ v_t/n_t at a cost of
// Σ c_t n_t is least where n_t is in proportion to √(v_t/c_t).
//
// Passes that gather photons must also be spread over the batches of them: four passes that gather one batch err alike
// by its photons. So a tile is not given many passes in one round and none in the next: each round brings it what its
// rate says, rounded, and what rounding left over counts for the next.
#pragma once

#include <cstdint>
#include <functional>
#include <span>
#include <vector>

#include "techniques/reference/picture_tiles.h"

namespace nephroid {

class EyePasses {
 public:
  EyePasses(int width, int height);
  const PictureTiles& tiles() const { return tiles_; }

  /// Finished passes, by tile.
  std::span<const std::uint64_t> done() const { return done_; }
  /// The same as a mean over pixels, rounded.
  std::uint64_t meanPasses() const;

  /// The next round: one pass over the whole picture.
  void planAll();
  /// The next round: passes at the same cost as one over the whole picture, at rates that bring the numbers of passes
  /// to where the error is least once the render has taken twice as long as so far. Every tile must have had one.
  /// @param variances  of one pass, relative, summed over the tile
  void planWhereItPays(std::span<const double> variances);
  /// Is there anything of a round left to do?
  bool planned() const;

  /// Does what is left of the round: calls `trace(x, y, sample)`, which returns what it cost, in rays, in parallel for
  /// different tiles. A tile is done as a whole; once `stopped()` says so no further tile is begun.
  void run(const std::function<std::uint64_t(int x, int y, std::uint32_t sample)>& trace,
           const std::function<bool()>& stopped);

  /// Visits all that a checkpoint keeps of it.
  template <class State>
  void visitState(State& state) {
    state.values(std::span(done_));
    state.values(std::span(planned_));
    state.values(std::span(costs_));
    state.values(std::span(due_));
  }

 private:
  std::vector<double> ratesWhereItPays(std::span<const double> variances) const;

  PictureTiles tiles_;
  std::vector<std::uint64_t> done_;     ///< passes, by tile
  std::vector<std::uint32_t> planned_;  ///< passes of this round that are left, by tile
  std::vector<std::uint64_t> costs_;    ///< of all passes, by tile
  std::vector<double> due_;             ///< passes that rounds owe, or were ahead, by tile: half a pass at most
};

}  // namespace nephroid
