// The passes over a map's coarser levels (frame/flux_levels.h): what they show, before large cells are deposited there,
// and their sums.
//
// Flux goes down from a texel to those of the next finer level by a tent, and so lies smooth over each cell. Of two
// texels that show different surfaces neither gives anything to the other's: flux stays on its surface, none is lost,
// and even light stays even.
#pragma once

#include "frame/flux_map.h"
#include "gpu/commands.h"

namespace nephroid {

struct DepositSurfaces;

/// Not thread-safe. The device must outlive it.
class DepositLevels {
 public:
  /// @param directions  of maps that keep them
  /// @throws ResourceError
  DepositLevels(gpu::Device& device, bool directions);

  /// Records that the map's levels are made ready if large cells are listed that cover much, unless they are already.
  /// @param lists        of Deposit
  /// @param flux_layers  of each view that have flux
  void prepare(gpu::CommandRecorder& recorder, const gpu::Buffer& lists, const DepositSurfaces& surfaces,
               std::uint32_t flux_layers, const FluxMap& map) const;
  /// Records that what is in the levels is added to the map.
  void finish(gpu::CommandRecorder& recorder, const FluxMap& map) const;

 private:
  gpu::ComputePipeline plan_, describe_first_, describe_, sum_;
};

}  // namespace nephroid
