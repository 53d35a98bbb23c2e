// How much of the noise of paths from the eye comes from the photons that they gather.
//
// Paths that gather the same batch of photons err alike: more of them lessen only what is their own. Of a few pixels
// the rounds of paths are kept apart. Within a batch they differ by the paths' own variance V_e, from batch to batch by
// the photons' V_g as well (one-way analysis of variance with groups of unequal size): with B batches of n_b passes,
// N = Σ n_b, the mean squares within, M_w, and between, M_b, have the means V_e and V_e + n₀ V_g with
// n₀ = (N − Σ n_b²/N)/(B − 1), and the variance of the mean over all is V_e/N + V_g Σ n_b²/N².
#pragma once

#include <cstdint>
#include <span>
#include <string_view>
#include <vector>

#include "techniques/reference/film.h"
#include "techniques/reference/picture_tiles.h"

namespace nephroid {

class GatherProbe {
 public:
  /// @param film   must outlive it  @param layer  a name that planesOf() knows
  GatherProbe(const Film& film, std::string_view layer);

  /// After a round of paths. @param passes  that the film holds, by tile
  void takeRound(std::span<const std::uint64_t> passes);
  /// The next round gathers other photons. Batches that no round gathered leave no trace.
  void closeBatch();
  /// Of the variance of the mean, relative to what is seen and summed over the picture, the part that is the photons':
  /// 0 to 1. Unknown, before two batches were gathered by two rounds each, it is 1.
  double photonsShare() const;

  /// Visits all that a checkpoint keeps of it.
  template <class State>
  void visitState(State& state) {
    state.values(std::span(pixels_));
  }

 private:
  /// One of each tile. Values are means over the channels.
  struct Pixel {
    double sum = 0.0, passes = 0.0;  ///< in all rounds
    double batch_sum = 0.0, batch_passes = 0.0, batch_rounds = 0.0;
    double batch_squares = 0.0;                    ///< Σ S_i²/n_i over its rounds
    double within = 0.0, within_freedom = 0.0;     ///< squares within closed batches
    double closed_sum = 0.0, closed_passes = 0.0;  ///< in closed batches
    double squares = 0.0, passes_squared = 0.0;    ///< Σ S_b²/n_b, Σ n_b²
    double batches = 0.0;
  };
  double sumAt(std::size_t tile) const;

  PictureTiles tiles_;
  std::vector<const FilmPlane*> planes_;
  std::vector<Pixel> pixels_;  ///< by tile
};

}  // namespace nephroid
