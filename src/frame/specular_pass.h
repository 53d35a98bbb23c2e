// The layer `specular` of a frame: what mirrors, glass and water show, followed surface by surface.
//
// Two passes over pixels: one lists those that show an interface of class S, the other follows chains of surfaces from
// each of them through the tree of triangles.
#pragma once

#include <cstdint>
#include <vector>

#include "frame/light_grids.h"
#include "frame/sample_push.shared.h"
#include "frame/scene_buffers.h"
#include "frame/triangle_tree.h"
#include "gpu/commands.h"

namespace nephroid {

/// Not thread-safe. What it is made from must outlive it.
class SpecularPass {
 public:
  /// Of the frame, which makes them before.
  struct Inputs {
    const gpu::Buffer& camera_view;
    const gpu::Image &seen, &tint, &lamps, &environment;
    const gpu::Sampler& environment_sampler;
    const LightGrids& grids;
    const TriangleTree& tree;
  };

  /// Records the upload of tables. @param lights  constants of frame/sky.glsl and frame/lights.glsl: what shines
  /// @throws ResourceError
  SpecularPass(gpu::Device& device, gpu::CommandRecorder& recorder, const SceneBuffers& buffers, const Inputs& inputs,
               const std::vector<gpu::Constant>& lights, std::uint32_t max_events);

  /// The frame's images have another size now. @throws ResourceError
  void fitPicture(gpu::Device& device);
  /// Adds a sample to the sum, once the frame's visibility is drawn.
  void record(gpu::CommandRecorder& recorder, const SamplePush& sample);
  /// Sum over samples, W/m²/sr.
  const gpu::Image& sum() const { return sum_; }

 private:
  void recordList(gpu::CommandRecorder& recorder);

  const SceneBuffers& buffers_;
  Inputs inputs_;
  std::uint32_t max_events_;
  gpu::ComputePipeline list_, follow_;
  gpu::Image bands_, sum_;
  gpu::Buffer pixels_;
};

}  // namespace nephroid
