// From the sums of IrradianceImages::direction to mean directions, for whoever wants them as such.
#pragma once

#include "gpu/commands.h"

namespace nephroid {

class MeanDirection {
 public:
  /// @throws ResourceError
  explicit MeanDirection(gpu::Device& device);
  /// Records that each texel's RGB is divided by its A, in place; 0 where no light falls.
  void record(gpu::CommandRecorder& recorder, const gpu::Image& direction);

 private:
  gpu::ComputePipeline pipeline_;
};

}  // namespace nephroid
