// What a view shows, and what is behind it: depth-peeled layers of surfaces, for tracing in image space.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

#include "frame/scene_buffers.h"
#include "gpu/commands.h"

namespace nephroid {

/// Layer 0 is what the view shows; layer k is what it would show if the surfaces of the layers before were not there.
/// Of surfaces that coincide one is kept. Device and buffers must outlive it.
class SurfaceLayers {
 public:
  /// @param size    texels along a side
  /// @param layers  >= 1
  /// @throws ResourceError
  SurfaceLayers(gpu::Device& device, const SceneBuffers& buffers, std::uint32_t size, std::uint32_t layers);

  /// @param view   its picture is square
  /// @param draws  of the scene, by index
  void record(gpu::CommandRecorder& recorder, const ViewRecord& view, std::span<const std::size_t> draws);

  std::uint32_t size() const { return seen_.desc().width; }
  std::uint32_t count() const { return seen_.desc().layers; }
  const gpu::Buffer& view() const { return view_; }
  /// R32G32_UINT array: instance + 1 (0: nothing), triangle of its mesh.
  const gpu::Image& seen() const { return seen_; }
  /// RGBA32F array: place in the world, and the bits of packUnitVector of the normal that points out of the solid.
  /// Where nothing is seen it is undefined.
  const gpu::Image& surfaces() const { return surfaces_; }

 private:
  void recordLayer(gpu::CommandRecorder& recorder, std::span<const std::size_t> draws, std::uint32_t layer);

  const SceneBuffers& buffers_;
  gpu::GraphicsPipeline first_, next_;
  gpu::ComputePipeline places_;
  gpu::Buffer view_;
  gpu::Image seen_, surfaces_;
  gpu::Image depths_[2];  ///< of the present layer and the one before, in turn
};

}  // namespace nephroid
