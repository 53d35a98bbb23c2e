// A low-pass of a map of flux, whether the map is a light's or a camera's.
#pragma once

#include <cstdint>

#include "frame/deposit.h"
#include "frame/flux_map.h"
#include "gpu/commands.h"

namespace nephroid {

/// Blurs what was deposited, against the noise of cells and splats ([shah-caustics-mapping] §III-F). Each surface keeps
/// its flux exactly. Not thread-safe. The device must outlive it.
class LowPass {
 public:
  /// @param views       of the pictures: one, or so many faces of a cube, each of which is blurred by itself
  /// @param directions  for maps that keep them
  /// @throws ResourceError
  LowPass(gpu::Device& device, std::uint32_t views, bool directions);

  /// Records two passes, along rows and along columns.
  /// @param deviation  of the Gaussian, texels, > 0
  void record(gpu::CommandRecorder& recorder, const DepositSurfaces& surfaces, float deviation, const FluxMap& map);

 private:
  gpu::Device& device_;
  std::uint32_t views_;
  gpu::ComputePipeline pipeline_;
  gpu::Image between_;  ///< the flux after the first pass
};

}  // namespace nephroid
