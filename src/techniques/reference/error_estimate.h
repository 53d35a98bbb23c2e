// How far a progressive picture still is from its limit, from the spread of the batches that it is the mean of.
//
// Every layer is a mean over passes from the eye plus a mean over batches of photons. Both are cut into batches; a
// batch's mean is its sum over its count, and the spread of those means gives the variance of the whole: with sums S_b
// over n_b passes, S = Σ S_b and N = Σ n_b, the variance of the mean is (Σ S_b²/n_b − S²/N) / ((B − 1) N).
// What is summed is the layer, not its parts: paths of one pass (photons of one batch) are shared by all layers, so
// that the variance of `beauty` is not the sum of theirs.
//
// Low-discrepancy points err less than the spread of short runs of them says: over the outline of a shadow the variance
// of n well-spread points falls as n^(-3/2), not as 1/n. So batches grow with the render, an eighth to a quarter of it
// each, and how large the error of the picture is, is what the last four to eight of them say (two generations, see
// below), carried on to the whole: the variance v of a run of n passes is modelled as n v(n) = A + B n^(-1/2), and what
// single batches of a generation and pairs of them differ by are two such runs of the same passes, which give B. No
// more is taken off than there would be with A = 0: smoother integrands fall faster still. For single pixels there are
// too few batches: their standard errors are by all of them, as they are.
//
// Limits: it knows noise alone, no kernel's blur, and nothing of light that no path has found yet. Standard errors of
// pixels are what short runs of points say: too large where the integrand is smooth or has an outline.
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "core/image/image.h"
#include "techniques/reference/film.h"
#include "techniques/reference/picture_tiles.h"

namespace nephroid {

/// Share of a picture's mean that relMSE adds to each pixel, as in metrics: without it the darkest would rule the
/// figure (DESIGN, "Error figures").
inline constexpr double kRelativeFloor = 0.01;

/// Spread of the batches of one layer in one direction, per pixel and channel.
class BatchSpread {
 public:
  /// @param pixels  0 for a direction that adds nothing to the layer
  explicit BatchSpread(std::size_t pixels);
  /// What the planes gained since the last call is a batch. Different pixels from any thread.
  /// @param count  of passes in it  @param before  of passes in its generation
  /// @return what it adds to the sum of the squares, weighted by passes, by which batches of its generation deviate
  /// from their mean
  dvec3 close(std::size_t pixel, dvec3 sum, double count, double before);
  /// The batches since the last pair of this generation are a pair. All as for close().
  dvec3 closePair(std::size_t pixel, double count, double before);
  /// Batches from here on are a generation of their own.
  void beginGeneration(std::size_t pixel) {
    generation_.set(pixel, closed_.at(pixel));
    pair_.set(pixel, closed_.at(pixel));
  }
  /// Variance of one pass. @param batches  closed, >= 2  @param passes  in them
  dvec3 varianceOfPass(std::size_t pixel, std::uint64_t batches, std::uint64_t passes) const;

  bool active() const { return closed_.active(); }
  const FilmPlane& closedSum() const { return closed_; }
  template <class State>
  void visitState(State& state) {
    state.values(closed_.values());
    state.values(squares_.values());
    state.values(generation_.values());
    state.values(pair_.values());
  }

 private:
  FilmPlane closed_;      ///< sum of all closed batches
  FilmPlane squares_;     ///< Σ S_b²/n_b
  FilmPlane generation_;  ///< sum of those before this generation
  FilmPlane pair_;        ///< sum of those before the pair that is not closed yet
};

/// relMSE of a picture by its own standard errors, in the parts that more passes from the eye or more photons lessen.
struct RelativeError {
  double from_eye = 0.0, from_lights = 0.0;
  double total() const { return from_eye + from_lights; }
};

/// Layers whose error has to be estimated: because it is a layer too, or because it ends the render.
/// @param asked         names of layers  @param target_error  0: none
std::vector<std::string> layersWithError(const std::vector<std::string>& asked, double target_error);

/// Standard errors of several layers of a film. Memory: 192 bytes a pixel and layer (96 where only one direction adds).
class ErrorEstimate {
 public:
  /// @param film    must outlive it
  /// @param layers  that are sampled: names that planesOf() knows
  ErrorEstimate(const Film& film, const std::vector<std::string>& layers);

  bool empty() const { return layers_.empty(); }
  /// In every tile, what the film holds of passes from the eye is in closed batches from here on.
  /// @param passes  that the film holds, by tile
  void closeEyeBatches(std::span<const std::uint64_t> passes);
  /// The same only in tiles with `shortest` new passes or more, and in proportion to all that went before: aligned
  /// blocks of powers of two, which are what the sampler spreads well.
  void closeFullEyeBatches(std::span<const std::uint64_t> passes, std::uint64_t shortest);
  /// All batches of photons that the film holds are in closed batches from here on.
  void closeLightBatch(std::uint64_t passes);
  /// The same, but only in proportion to all that went before, as closeFullEyeBatches().
  void closeFullLightBatch(std::uint64_t passes);
  /// Of the direction and tile that has fewest, among the directions that were closed at all.
  std::uint64_t batches() const;
  /// From the eye, of the tile that has fewest.
  std::uint64_t eyeBatches() const;

  /// RGB, unit of the layer; infinite where a direction has but one batch.
  /// @param passes_from_eye  by tile, that the picture is the mean of  @param batches_from_lights  ditto
  Image standardError(std::string_view layer, std::span<const std::uint64_t> passes_from_eye,
                      std::uint64_t batches_from_lights) const;

  /// mean(σ² / (I² + (0.01·mean I)²)) over pixels and channels, σ² by the last generations: relMSE (DESIGN §6) with the
  /// picture in the place of the reference, at the last closed batches. Infinite while a direction has but one batch.
  RelativeError relMse(std::string_view layer) const;
  /// A layer and its estimate.
  struct OfLayer {
    std::string layer;
    RelativeError error;
  };
  /// Whose estimate is the largest.
  OfLayer worst() const;
  /// By tile: Σ σ₁²/(I² + (0.01·mean I)²) over pixels and channels, with σ₁² the variance of one pass from the eye as
  /// batches say. Two closed batches in every tile at least.
  std::vector<double> variancesOfPass(std::string_view layer) const;

  /// By pixel: 1/(I² + (0.01·mean I)²), of the mean over channels; empty while a tile has no closed batch.
  std::vector<float> relativeScales(std::string_view layer) const;

  /// Visits all that a checkpoint keeps of it, with `value(number)` and `values(span)`, in a fixed order.
  template <class State>
  void visitState(State& state) {
    state.values(std::span(eye_));
    state.value(lights_);
    for (LayerSpread& layer : layers_)
      for (LayerSpread::OfDirection* direction : {&layer.eye, &layer.lights}) {
        direction->spread.visitState(state);
        state.values(std::span(direction->recent));
      }
  }

 private:
  /// Batches that follow each other, and every two of which are a pair.
  struct Generation {
    std::uint64_t batches = 0, passes = 0;
    std::uint64_t paired = 0;  ///< passes in pairs

    std::uint64_t pairs() const { return batches / 2; }
    double passesPerBatch() const { return static_cast<double>(passes) / static_cast<double>(batches); }
  };
  /// How far a direction has come. Generations double the passes: each is of four batches or more.
  struct Direction {
    std::uint64_t batches = 0, passes = 0;  ///< closed
    Generation current, previous;

    void close(std::uint64_t gained);
    /// Did the batch that was closed last make a pair with the one before?
    bool closesPair() const { return current.batches % 2 == 0; }
    bool endsGeneration() const;
    void beginGeneration();
  };
  /// Squares of a tile by which the batches of a generation, and the pairs of them, deviate from its mean, relative to
  /// what is seen.
  struct Squares {
    double batches = 0.0, pairs = 0.0;
  };
  struct Recent {
    Squares current, previous;
  };
  /// Σ σ₁²/(I² + (0.01·mean I)²) over pixels and channels of a tile, where σ₁² is the variance of a mean over passes,
  /// times the passes.
  struct PassVariance {
    double by_batches = 0.0;  ///< as deviations of batches say
    double decline = 0.0;     ///< what it is less of a mean over all passes
    double least = 0.0;       ///< that it is at least of a mean over all passes
  };
  struct LayerSpread {
    struct OfDirection {
      BatchSpread spread;
      std::vector<Recent> recent;  ///< by tile
    };
    std::string name;
    std::vector<LayerPlanes> planes;
    OfDirection eye, lights;
  };
  const LayerSpread& find(std::string_view layer) const;
  template <class IsDue>
  void closeEyeBatchesWhere(std::span<const std::uint64_t> passes, const IsDue& is_due);
  dvec3 meanAt(const LayerSpread& layer, std::size_t tile, std::size_t pixel) const;
  double floorOf(const LayerSpread& layer) const;
  std::vector<double> floors() const;
  using OfDirection = LayerSpread::OfDirection;
  void closeTile(LayerSpread& layer, OfDirection LayerSpread::*direction, std::size_t tile, const Direction& before,
                 const Direction& closed, double floor) const;
  void beginGeneration(OfDirection LayerSpread::*direction, std::size_t tile);
  /// By the last generations: infinite of one batch.
  static PassVariance recentVarianceOfPass(const OfDirection& direction, std::size_t tile, const Direction& closed);
  static dvec3 varianceOfMean(const BatchSpread& spread, const Direction& closed, std::size_t pixel,
                              std::uint64_t passes);
  /// Calls `visit(tile, x, y, pixel)`, in parallel for different tiles.
  template <class Visit>
  void visitPixels(const Visit& visit) const;

  PictureTiles tiles_;
  std::vector<LayerSpread> layers_;
  std::vector<Direction> eye_;  ///< by tile
  Direction lights_;
};

}  // namespace nephroid
