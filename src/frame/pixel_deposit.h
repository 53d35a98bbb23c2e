// Photons into the camera's own picture: flux by pixel, and the irradiance that follows (a photon texture).
#pragma once

#include "frame/deposit.h"
#include "frame/realtime_technique.h"

namespace nephroid {

/// Not thread-safe. Device and buffers must outlive it.
class PixelDeposit {
 public:
  /// @param directions  also finds where the light comes from
  /// @throws ResourceError
  PixelDeposit(gpu::Device& device, const SceneBuffers& buffers, bool directions);

  /// Records where the sample's pixels lie, which the frame itself drew; nothing is deposited yet.
  /// @param most  as FluxMap::clear
  void begin(gpu::CommandRecorder& recorder, const RealtimeSample& sample, float most);
  /// What to deposit on, and into; valid until the next `begin`.
  DepositSurfaces surfaces(const RealtimeSample& sample) const { return {sample.surfaces.view(), places_, 1}; }
  const FluxMap& map() const { return map_; }
  /// Records that what was deposited is added to the sample's target.
  void finish(gpu::CommandRecorder& recorder, const RealtimeSample& sample);

 private:
  gpu::Device& device_;
  const SceneBuffers& buffers_;
  bool directions_;
  gpu::ComputePipeline places_pipeline_, irradiance_pipeline_;
  gpu::Image places_;
  FluxMap map_;
};

}  // namespace nephroid
