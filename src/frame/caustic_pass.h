// The layer `caustic` of a frame: what surfaces make of the irradiance that a technique found.
#pragma once

#include <cstdint>

#include "frame/irradiance_images.h"
#include "frame/scene_buffers.h"
#include "gpu/commands.h"

namespace nephroid {

/// Not thread-safe. What it is made from must outlive it.
class CausticPass {
 public:
  struct Inputs {
    const gpu::Buffer& camera_view;
    const gpu::Image &seen, &tint;
  };

  /// For pictures of the size of `inputs.seen`. @throws ResourceError
  CausticPass(gpu::Device& device, const SceneBuffers& buffers, const Inputs& inputs, float specular_alpha);

  /// The frame's images have another size now. @throws ResourceError
  void fitPicture(gpu::Device& device);
  /// Of one sample: cleared before a technique adds to it.
  const IrradianceImages& target() const { return target_; }
  /// Adds what the target holds to the sums.
  void record(gpu::CommandRecorder& recorder, std::uint32_t frame);
  /// Sums over samples: W/m²/sr and W/m².
  const gpu::Image& radianceSum() const { return radiance_; }
  const gpu::Image& irradianceSum() const { return irradiance_; }

 private:
  const SceneBuffers& buffers_;
  Inputs inputs_;
  float specular_alpha_;
  IrradianceImages target_;
  gpu::Image radiance_, irradiance_;
  gpu::ComputePipeline pipeline_;
};

}  // namespace nephroid
