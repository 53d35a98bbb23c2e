// What a pass needs of the frame to light what it sees: the frame makes these before the pass.
#pragma once

#include "frame/light_grids.h"
#include "gpu/resources.h"

namespace nephroid {

/// All must outlive the pass.
struct ShadingInputs {
  const gpu::Buffer& camera_view;
  const gpu::Image &seen, &tint;
  const gpu::Buffer& lamps;
  const gpu::Image& environment;
  const gpu::Sampler& environment_sampler;
  const LightGrids& grids;
};

}  // namespace nephroid
