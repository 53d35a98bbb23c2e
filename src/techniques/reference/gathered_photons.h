// Photons that paths from the eye gather: those of the latest batch, under kernels that shrink from batch to batch.
//
// Each batch is blurred by its kernels, but the mean over batches converges (Knaus & Zwicker 2011). Caustics, and what
// they light in turn, have a map each: a caustic is narrow and bright, what it lights is spread evenly. Kernels of
// caustics are the photons' footprints (see footprint.h), those of what they light discs, wide where photons are sparse
// (see kernel_radii.h), so that dim places are as smooth as bright ones.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "techniques/reference/photon_batch.h"
#include "trace/kernel_map.h"
#include "trace/kernel_radii.h"

namespace nephroid {

/// Of kernels, m; 0 if there are too few photons to tell.
struct RadiusRange {
  float narrowest = 0.0F, widest = 0.0F;
};
/// Of a caustic, most of whose photons may be in a focus that is far smaller than all that it lights.
/// @param expected  photons under a kernel
RadiusRange chooseRangeOfCaustics(std::span<const GridPhoton> photons, float expected);
/// Of what caustics light.
RadiusRange chooseRangeOfIndirect(std::span<const GridPhoton> photons, float expected);

class GatheredPhotons {
 public:
  GatheredPhotons();
  /// Takes the place of the batch taken before, under smaller kernels. How wide kernels are where is decided by that
  /// batch, or by its own photons where there was none: chance that is in the widths must not be in those that they
  /// spread, nor be the same in all batches. @param batch_index  from 0; not all batches need be taken
  void take(const PhotonBatch& batch, std::uint64_t batch_index);
  /// Is this the batch taken last?
  bool holds(std::uint64_t batch_index) const { return taken_ > 0 && latest_ == batch_index; }

  /// Where photons first met a diffuse surface. Flux in W, as of all of these.
  const KernelMap& caustics() const { return caustics_.kernels; }
  /// Where they did so again.
  const KernelMap& indirect() const { return indirect_.kernels; }

  /// After a checkpoint was read, which knows batches by their numbers alone: those to give to retake(), in order.
  std::vector<std::uint64_t> batchesToRetake() const;
  void retake(const PhotonBatch& batch, std::uint64_t batch_index);
  template <class State>
  void visitState(State& state) {
    for (Map* map : {&caustics_, &indirect_})
      for (std::uint64_t* batch : {&map->decided_by, &map->next_by}) state.value(*batch);
    state.value(latest_);
    state.value(taken_);
  }

 private:
  static constexpr std::uint64_t kUndecided = ~std::uint64_t{0};
  struct Map {
    float expected = 0.0F;  ///< photons under a kernel
    RadiusRange (*choose_range)(std::span<const GridPhoton> photons, float expected) = nullptr;
    KernelRadii radii, next_radii;
    std::uint64_t decided_by = kUndecided, next_by = kUndecided;  ///< the batches that these two are by
    KernelMap kernels;

    void take(const std::vector<GridPhoton>& photons, std::uint64_t batch, float scale);
    void retake(const std::vector<GridPhoton>& photons, std::uint64_t batch);
    std::optional<KernelRadii> radiiBy(const std::vector<GridPhoton>& photons) const;
    void spread(const std::vector<GridPhoton>& photons, float scale);
  };

  Map caustics_, indirect_;
  std::uint64_t latest_ = 0, taken_ = 0;  ///< batch, and how many were taken
};

/// Areas of kernels of a batch over those of the first: the product of (j + α)/(j + 1) over batches j from 1 to this
/// one (Knaus & Zwicker 2011, eq. 15). @param batch  of those that are gathered, from 0
float shrinkAreas(std::uint64_t batch);

/// A first radius under which half of the photons have about `expected` others, however unevenly they lie: a few that
/// are far from the rest do not widen it.
/// @return  m; 0 if there are fewer than two
float chooseTypicalRadius(std::span<const GridPhoton> photons, float expected);

}  // namespace nephroid
