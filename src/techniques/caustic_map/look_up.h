// The irradiance of a caustic map, by pixel.
#pragma once

#include "frame/deposit.h"
#include "frame/realtime_technique.h"

namespace nephroid {

/// Buffers must outlive it.
class LookUp {
 public:
  /// @param foreign     the kind of surfaces that it will be given
  /// @param views       of each map: one, or so many faces of a cube
  /// @param directions  whether the maps keep them; else no mean direction is added
  /// @throws ResourceError
  LookUp(gpu::Device& device, const SceneBuffers& buffers, bool foreign, std::uint32_t views, bool directions);

  /// Records a pass that adds what the map holds to the sample's target, between the texels linearly; nothing where the
  /// map's view shows another surface than the pixel does, or its other side.
  /// @param weight  times which it is added
  void record(gpu::CommandRecorder& recorder, const RealtimeSample& sample, float weight,
              const DepositSurfaces& surfaces, const FluxMap& map);

 private:
  const SceneBuffers& buffers_;
  gpu::ComputePipeline pipeline_;
};

}  // namespace nephroid
