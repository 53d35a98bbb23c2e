// Photons that paths from the eye gather: those of the latest batch, under kernels that shrink from batch to batch.
//
// Each batch is blurred by its kernels, but the mean over batches converges (Knaus & Zwicker 2011). Caustics, and what
// they light in turn, have a map each: a caustic is narrow and bright, what it lights is spread evenly. Within a map
// kernels are wide where photons are sparse (see kernel_radii.h), so that dim places are as smooth as bright ones.
#pragma once

#include <cstdint>
#include <vector>

#include "techniques/reference/photon_batch.h"
#include "trace/kernel_map.h"
#include "trace/kernel_radii.h"

namespace nephroid {

class GatheredPhotons {
 public:
  /// Takes the place of the batch before, under smaller kernels. The first that has photons decides how wide kernels
  /// are where. @param batch_index  from 0
  void take(const PhotonBatch& batch, std::uint64_t batch_index);

  /// Where photons first met a diffuse surface. Flux in W, as of all of these.
  const KernelMap& caustics() const { return caustics_.kernels; }
  /// Where they did so again.
  const KernelMap& indirect() const { return indirect_.kernels; }

  /// Batches that decided, in order. Whoever takes them, and then the latest, has what this has.
  std::vector<std::uint64_t> decisiveBatches() const;
  /// Only which batches those are.
  template <class State>
  void visitState(State& state) {
    state.value(caustics_.decided_by);
    state.value(indirect_.decided_by);
  }

 private:
  static constexpr std::uint64_t kUndecided = ~std::uint64_t{0};
  struct Map {
    KernelRadii radii;
    KernelMap kernels;
    std::uint64_t decided_by = kUndecided;  ///< batch

    template <class ChooseRadius>
    void take(const std::vector<GridPhoton>& photons, std::uint64_t batch, float expected,
              ChooseRadius&& choose_radius);
  };

  Map caustics_, indirect_;
};

/// Areas of kernels of a batch over those of the first: the product of (j + α)/(j + 1) over batches j from 1 to this
/// one (Knaus & Zwicker 2011, eq. 15). @param batch  from 0
float shrinkAreas(std::uint64_t batch);

/// A first radius under which half of the photons have about `expected` others, however unevenly they lie: a few that
/// are far from the rest do not widen it.
/// @return  m; 0 if there are fewer than two
float chooseTypicalRadius(const std::vector<GridPhoton>& photons, float expected);

}  // namespace nephroid
