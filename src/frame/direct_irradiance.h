// Irradiance of light that comes straight from the lights, shadows included, on the surfaces of any picture.
#pragma once

#include "frame/light_grids.h"
#include "frame/realtime_technique.h"
#include "frame/scene_buffers.h"

namespace nephroid {

/// Buffers and grids must outlive it.
class DirectIrradiance {
 public:
  /// @param foreign  the kind of surfaces that it will be given
  /// @throws ResourceError
  DirectIrradiance(gpu::Device& device, const SceneBuffers& buffers, const LightGrids& lights, bool foreign);

  /// Records a pass that adds the present sample of each light to the target.
  void record(gpu::CommandRecorder& recorder, const RealtimeSample& sample);

 private:
  const SceneBuffers& buffers_;
  const LightGrids& lights_;
  gpu::ComputePipeline pipeline_;
};

}  // namespace nephroid
