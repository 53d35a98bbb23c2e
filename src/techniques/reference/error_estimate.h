// How far a progressive picture still is from its limit, from the spread of the batches that it is the mean of.
//
// Every layer is a mean over passes from the eye plus a mean over batches of photons. Both are cut into batches; a
// batch's mean is its sum over its count, and the spread of those means gives the variance of the whole: with sums S_b
// over n_b passes, S = Σ S_b and N = Σ n_b, the variance of the mean is (Σ S_b²/n_b − S²/N) / ((B − 1) N).
// What is summed is the layer, not its parts: paths of one pass (photons of one batch) are shared by all layers, so
// that the variance of `beauty` is not the sum of theirs.
// Limits: it knows noise alone, no kernel's blur, and nothing of light that no path has found yet. Low-discrepancy
// points err less than their spread says where the integrand is smooth, so it is rather too large there.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "core/image/image.h"
#include "techniques/reference/film.h"

namespace nephroid {

/// Spread of the batches of one layer in one direction, per pixel and channel.
class BatchSpread {
 public:
  /// @param pixels  0 for a direction that adds nothing to the layer
  explicit BatchSpread(std::size_t pixels);
  /// What the planes gained since the last call is a batch. Different pixels from any thread.
  /// @param count  of passes in it
  void close(std::size_t pixel, dvec3 sum, double count);
  /// Variance of one pass. @param batches  closed, >= 2  @param passes  in them
  dvec3 varianceOfPass(std::size_t pixel, std::uint64_t batches, std::uint64_t passes) const;

  bool active() const { return closed_.active(); }
  const FilmPlane& closedSum() const { return closed_; }
  template <class State>
  void visitState(State& state) {
    state.values(closed_.values());
    state.values(squares_.values());
  }

 private:
  FilmPlane closed_;   ///< sum of all closed batches
  FilmPlane squares_;  ///< Σ S_b²/n_b
};

/// relMSE of a picture by its own standard errors, in the parts that more passes from the eye or more photons lessen.
struct RelativeError {
  double from_eye = 0.0, from_lights = 0.0;
  double total() const { return from_eye + from_lights; }
};

/// Layers whose error has to be estimated: because it is a layer too, or because it ends the render.
/// @param asked         names of layers  @param target_error  0: none
std::vector<std::string> layersWithError(const std::vector<std::string>& asked, double target_error);

/// Standard errors of several layers of a film. Memory: 96 bytes a pixel and layer (48 where only one direction adds).
class ErrorEstimate {
 public:
  /// @param film    must outlive it
  /// @param layers  that are sampled: names that planesOf() knows
  ErrorEstimate(const Film& film, const std::vector<std::string>& layers);

  bool empty() const { return layers_.empty(); }
  /// Passes from the eye, batches of photons: all that the film holds of either is in closed batches from here on.
  void closeEyeBatch(std::uint64_t passes);
  void closeLightBatch(std::uint64_t passes);
  std::uint64_t closedEyePasses() const { return eye_.passes; }
  /// Of the direction that has fewest, among those that were closed at all.
  std::uint64_t batches() const;

  /// RGB, unit of the layer; infinite where a direction has but one batch.
  /// @param passes_from_eye, batches_from_lights  that the picture is the mean of
  Image standardError(std::string_view layer, std::uint64_t passes_from_eye, std::uint64_t batches_from_lights) const;

  /// mean(σ² / (I² + (0.01·mean I)²)) over pixels and channels: relMSE (DESIGN §6) with the picture in the place of the
  /// reference, at the last closed batches. Infinite while a direction has but one batch.
  RelativeError relMse(std::string_view layer) const;
  /// The layer whose estimate is the largest, and that.
  struct Worst {
    std::string layer;
    RelativeError error;
  };
  Worst worst() const;

  /// Visits all that a checkpoint keeps of it, with `value(number)` and `values(span)`, in a fixed order.
  template <class State>
  void visitState(State& state) {
    for (Direction* direction : {&eye_, &lights_}) {
      state.value(direction->batches);
      state.value(direction->passes);
    }
    for (LayerSpread& layer : layers_)
      for (BatchSpread* spread : {&layer.eye, &layer.lights}) spread->visitState(state);
  }

 private:
  struct Direction {
    std::uint64_t batches = 0, passes = 0;  ///< closed
  };
  struct LayerSpread {
    std::string name;
    std::vector<LayerPlanes> planes;
    BatchSpread eye, lights;
  };
  const LayerSpread& find(std::string_view layer) const;
  dvec3 meanAt(const LayerSpread& layer, std::size_t pixel) const;
  static dvec3 varianceOfMean(const BatchSpread& spread, const Direction& closed, std::size_t pixel,
                              std::uint64_t passes);
  template <class Visit>
  void visitRows(const Visit& visit) const;

  int width_, height_;
  std::vector<LayerSpread> layers_;
  Direction eye_, lights_;
};

}  // namespace nephroid
