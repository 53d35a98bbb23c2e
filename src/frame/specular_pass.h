// The layer `specular` of a frame: what mirrors, glass and water show, followed surface by surface.
//
// Chains of surfaces are followed through the tree of triangles, not from every pixel: the picture is divided into
// cells of a few pixels. Of a cell that shows one specular thing all over they are followed at its corners, along the
// ways that carry most; if those end alike (specular_agreement.comp.glsl) all pixels of the cell show what lies between
// (specular_lit.comp.glsl), and some, drawn for it, what the other ways carry. All other pixels follow their own.
#pragma once

#include <cstdint>
#include <vector>

#include "core/math.h"
#include "frame/receiver_map.h"
#include "frame/sample_push.shared.h"
#include "frame/scene_buffers.h"
#include "frame/shading_inputs.h"
#include "frame/triangle_tree.h"
#include "gpu/commands.h"

namespace nephroid {

/// Not thread-safe. What it is made from must outlive it.
class SpecularPass {
 public:
  struct Inputs : ShadingInputs {
    const TriangleTree& tree;
    const ReceiverMap* receivers;  ///< caustics on what is seen; null: there are none
  };
  /// How chains are followed.
  struct Following {
    std::uint32_t max_events = 0;
    std::uint32_t spacing = 1;  ///< pixels along a side of a cell, 1 to 4; 1: all pixels follow their own
  };

  /// Records the upload of tables. @param lights  constants of frame/sky.glsl and frame/lights.glsl: what shines
  /// @throws ResourceError
  SpecularPass(gpu::Device& device, gpu::CommandRecorder& recorder, const SceneBuffers& buffers, const Inputs& inputs,
               const std::vector<gpu::Constant>& lights, const Following& following);

  /// The frame's images have another size now. @throws ResourceError
  void fitPicture(gpu::Device& device);
  /// Adds a sample to the sum, once the frame's visibility is drawn.
  void record(gpu::CommandRecorder& recorder, const SamplePush& sample);
  /// Sum over samples, W/m²/sr.
  const gpu::Image& sum() const { return sum_; }
  /// The caustics in it; null where there are none.
  const gpu::Image* causticSum() const { return inputs_.receivers ? &caustic_sum_ : nullptr; }

 private:
  struct Push;
  Push pushOf(const SamplePush& sample) const;
  /// Whether the picture is divided into cells.
  bool hasCells() const;
  void recordPixels(gpu::CommandRecorder& recorder, const Push& push);
  void recordCells(gpu::CommandRecorder& recorder, const Push& push);
  void recordAgreement(gpu::CommandRecorder& recorder, const Push& push);
  void recordLit(gpu::CommandRecorder& recorder, Push push);
  void recordFollowing(gpu::CommandRecorder& recorder, const gpu::ComputePipeline& pipeline, const char* name,
                       std::uint32_t list, const Push& push);
  uvec2 pointCount() const;
  /// What frame/receiver_map.glsl reads and writes.
  void appendReceivers(std::uint32_t first, std::vector<gpu::Bound>& bound, std::vector<gpu::Use>& uses) const;

  const SceneBuffers& buffers_;
  Inputs inputs_;
  Following following_;
  gpu::ComputePipeline pixels_, show_;
  gpu::ComputePipeline cells_, mixed_, follow_most_, agreement_, lit_;  ///< where there are cells
  ReceiverMap no_receivers_;                                            ///< bound where there are none
  gpu::Buffer bands_, ends_, bends_;
  gpu::Image sum_, caustic_sum_;
  std::uint32_t stamp_ = 0;       ///< of the latest sample; 0: nothing is noted in `ends_` yet
  gpu::Buffer no_lists_, lists_;  ///< the heads of empty lists; heads and lists
};

}  // namespace nephroid
