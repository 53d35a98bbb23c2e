// Passes of paths from the eye, tile by tile: how many each has had, and which get the next ones.
//
// A pass is one path through each pixel. Where errors steer a render it need not go everywhere: with v_t the variance
// of one pass over tile t, relative to what is seen there, and c_t the rays that it costs, the error Σ v_t/n_t at a
// cost of Σ c_t n_t is least where n_t is in proportion to √(v_t/c_t). So the next pass belongs where v_t/(c_t n_t²),
// by which the error falls per ray, is largest.
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
  /// The next round: about as many rays as a pass over the whole picture costs, where they lessen the error most.
  /// Tiles get `quantum` passes at once, aligned to it: points of a sampler are well spread in such blocks.
  /// @param variances  of one pass, relative, summed over the tile
  void planWhereItPays(std::span<const double> variances, std::uint32_t quantum);
  /// Is there anything of a round left to do?
  bool planned() const;

  /// Does what is left of the round: calls `trace(x, y, sample)`, which returns the rays that it took, in parallel for
  /// different tiles. A tile is done as a whole; once `stopped()` says so no further tile is begun.
  void run(const std::function<std::uint64_t(int x, int y, std::uint32_t sample)>& trace,
           const std::function<bool()>& stopped);

  /// Visits all that a checkpoint keeps of it.
  template <class State>
  void visitState(State& state) {
    state.values(std::span(done_));
    state.values(std::span(planned_));
    state.values(std::span(rays_));
  }

 private:
  PictureTiles tiles_;
  std::vector<std::uint64_t> done_;     ///< passes, by tile
  std::vector<std::uint32_t> planned_;  ///< passes of this round that are left, by tile
  std::vector<std::uint64_t> rays_;     ///< of all passes, by tile
};

}  // namespace nephroid
