// How much of the noise of paths from the eye comes from the photons that they gather.
//
// Paths that gather the same batch of photons err alike: more of them lessen only what is their own. Of a few pixels
// the rounds of paths are kept apart. Passes of a pixel are spread evenly, most of all every two that follow each other
// from an even number on: they deviate from each other more than independent ones, and their mean errs less. So the
// paths' own variance cannot be had from how much passes differ within a batch; but half of the mean square by which
// the two of a pair differ is more by the photons' variance V_g where they gathered two batches than where they
// gathered one, whatever the passes have to do with each other.
// From batch to batch means of passes differ by both: with B batches of n_b passes, N = Σ n_b, the mean square between
// them (one-way analysis of variance with groups of unequal size) has the mean V_e + n₀ V_g with
// n₀ = (N − Σ n_b²/N)/(B − 1), V_e the paths' variance as runs of n_b have it, times their length. The variance of the
// mean over all is V_e/N + V_g Σ n_b²/N².
#pragma once

#include <cstdint>
#include <optional>
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
  /// Of variances relative to what is seen, summed over the pixels that are watched.
  struct Parts {
    double paths = 0.0;     ///< V_e/N
    double photons = 0.0;   ///< V_g Σ n_b²/N²
    double of_batch = 0.0;  ///< V_g; this and `photons` by groups of pixels, of which a few are not heard
  };
  /// Unknown before there are two batches, and pairs of passes of one and of two batches.
  std::optional<Parts> parts() const;

  /// Visits all that a checkpoint keeps of it.
  template <class State>
  void visitState(State& state) {
    state.values(std::span(pixels_));
  }

 private:
  /// Half of the squares by which two passes differ.
  struct Pairs {
    double squares = 0.0, count = 0.0;
    double mean() const { return squares / count; }
  };
  /// Some of each tile. Values are means over the channels.
  struct Pixel {
    std::size_t tile = 0, pixel = 0;
    double sum = 0.0, passes = 0.0;                ///< in all rounds
    double batch_sum = 0.0, batch_passes = 0.0;    ///< of the batch that is gathered
    double closed_sum = 0.0, closed_passes = 0.0;  ///< in closed batches
    double squares = 0.0, passes_squared = 0.0;    ///< Σ S_b²/n_b, Σ n_b²
    double batches = 0.0;
    double first = 0.0, first_batch = -1.0;  ///< of a pair: the pass, and how many batches came before; −1: none
    Pairs of_one_batch, of_two;

    void takePass(double value);
    bool isKnown() const { return batches >= 2.0 && of_one_batch.count > 0.0 && of_two.count > 0.0; }
  };
  double sumAt(std::size_t pixel) const;

  std::vector<const FilmPlane*> planes_;
  std::vector<Pixel> pixels_;
};

}  // namespace nephroid
