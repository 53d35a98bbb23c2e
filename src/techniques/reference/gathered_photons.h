// Photons that paths from the eye gather: those of the latest batch, under kernels that shrink from batch to batch.
//
// Each batch is blurred by its kernels, but the mean over batches converges (Knaus & Zwicker 2011). Caustics, and what
// they light in turn, have a map and a kernel each: a caustic is narrow and bright, what it lights is spread evenly, so
// that few photons under a wide kernel show it.
#pragma once

#include <cstdint>
#include <vector>

#include "techniques/reference/photon_batch.h"
#include "trace/photon_grid.h"

namespace nephroid {

class GatheredPhotons {
 public:
  /// Takes the place of the batch before, under a smaller kernel. @param batches  taken so far, this one included
  void take(const PhotonBatch& batch, std::uint64_t batches);
  /// The latest batch, traced again: under the same kernels.
  void retake(const PhotonBatch& batch);

  /// Where photons first met a diffuse surface. Flux in W, as of all of these.
  const PhotonGrid& caustics() const { return caustics_.grid; }
  /// Where they did so again.
  const PhotonGrid& indirect() const { return indirect_.grid; }

  /// All that the next batch depends on.
  template <class State>
  void visitState(State& state) {
    state.value(caustics_.radius_squared);
    state.value(indirect_.radius_squared);
  }

 private:
  struct Map {
    PhotonGrid grid;
    double radius_squared = 0.0;  ///< m²; 0 until there are photons

    void shrink(std::uint64_t batches);
    void replace(const std::vector<GridPhoton>& deposits);
  };

  Map caustics_, indirect_;
};

/// A first radius under which half of the photons have about `expected` others, however unevenly they lie: a few that
/// are far from the rest do not widen it.
/// @return  m; 0 if there are fewer than two
float chooseTypicalRadius(const std::vector<GridPhoton>& photons, int expected);

}  // namespace nephroid
