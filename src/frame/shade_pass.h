// The layers `direct` and `emission` of a frame: the light that comes straight to what the camera sees, and what
// shines.
#pragma once

#include <vector>

#include "frame/sample_push.shared.h"
#include "frame/scene_buffers.h"
#include "frame/shading_inputs.h"
#include "gpu/commands.h"

namespace nephroid {

/// Which pixels one thread lights.
enum class Shading {
  kAuto,    ///< what is faster on the device
  kPixels,  ///< one: as many threads as a GPU wants
  kBlocks,  ///< those of a block that sees one triangle all over, for which the triangle is fetched once
};

/// Not thread-safe. What it is made from must outlive it.
class ShadePass {
 public:
  /// @param lights  constants of frame/sky.glsl and frame/lights.glsl: what shines
  /// @throws ResourceError
  ShadePass(gpu::Device& device, const SceneBuffers& buffers, const ShadingInputs& inputs,
            const std::vector<gpu::Constant>& lights, Shading shading);

  /// The frame's images have another size now. @throws ResourceError
  void fitPicture(gpu::Device& device);
  /// Adds a sample to the sums, once the frame's visibility is drawn.
  void record(gpu::CommandRecorder& recorder, const SamplePush& sample);
  /// Sums over samples, W/m²/sr.
  const gpu::Image& direct() const { return direct_; }
  const gpu::Image& emission() const { return emission_; }

 private:
  std::vector<gpu::Use> uses() const;
  std::vector<gpu::Bound> bound() const;

  const SceneBuffers& buffers_;
  ShadingInputs inputs_;
  gpu::ComputePipeline pixels_;                    ///< of all, or of those of mixed blocks
  gpu::ComputePipeline blocks_, shadowed_blocks_;  ///< where there are blocks
  gpu::Image direct_, emission_;
  gpu::Buffer lists_;  ///< heads and lists of blocks: frame/shade.glsl
  bool has_blocks_ = false;
};

}  // namespace nephroid
