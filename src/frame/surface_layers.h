// What a view shows, and what is behind it: depth-peeled layers of surfaces, for tracing in image space.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

#include "frame/scene_buffers.h"
#include "gpu/commands.h"

namespace nephroid {

/// Layer 0 is what a view shows; layer k is what it would show if the surfaces of the layers before were not there. Of
/// surfaces that coincide one is kept. Several views, as the faces of a cube, lie one behind the other in the arrays:
/// view v has layers [v · layerCount(), (v + 1) · layerCount()). Device and buffers must outlive it.
class SurfaceLayers {
 public:
  enum class Sides : std::uint8_t {
    kBoth,    ///< whatever the view shows
    kFacing,  ///< of closed meshes the outside alone, and of all surfaces what faces a parallel view (kLeastFacing)
  };

  /// @param size    texels along a side
  /// @param views   >= 1
  /// @param layers  of each, >= 1
  /// @param sides   which are seen
  /// @throws ResourceError
  SurfaceLayers(gpu::Device& device, const SceneBuffers& buffers, std::uint32_t size, std::uint32_t views,
                std::uint32_t layers, Sides sides = Sides::kBoth);

  /// @param views  their pictures are square; as many as there is room for, or fewer
  /// @param draws  of the scene, by index
  void record(gpu::CommandRecorder& recorder, std::span<const ViewRecord> views, std::span<const std::size_t> draws);

  std::uint32_t size() const { return seen_.desc().width; }
  /// Views that the arrays have layers for.
  std::uint32_t roomForViews() const { return seen_.desc().layers / layer_count_; }
  std::uint32_t viewCount() const { return view_count_; }
  std::uint32_t layerCount() const { return layer_count_; }
  /// kMostViews ViewRecords, as uniforms or as a table.
  const gpu::Buffer& views() const { return views_; }
  /// R32G32_UINT array: instance + 1 (0: nothing), triangle of its mesh.
  const gpu::Image& seen() const { return seen_; }
  /// RGBA32F array: place in the world, and the bits of packUnitVector of the normal that points out of the solid.
  /// Infinity where nothing is seen.
  const gpu::Image& surfaces() const { return surfaces_; }
  /// RGBA32F array: the surfaces' places along the view's direction, dot(place, forward), in m; infinity where nothing
  /// is seen. Four layers to a texel: layer k of view v is channel k mod 4 of v · ceil(layerCount() / 4) + k / 4.
  const gpu::Image& depths() const { return depths_; }

 private:
  void recordLayer(gpu::CommandRecorder& recorder, const ViewRecord& view, std::span<const std::size_t> draws,
                   std::uint32_t view_index, std::uint32_t layer);

  const SceneBuffers& buffers_;
  Sides sides_;
  gpu::GraphicsPipeline first_, next_;
  gpu::ComputePipeline places_;
  std::uint32_t view_count_ = 0;  ///< of those that were recorded last
  std::uint32_t layer_count_;
  gpu::Buffer views_;
  gpu::Image seen_, surfaces_, depths_;
  gpu::Image drawn_depths_[2];  ///< of the present layer and the one before, in turn
};

}  // namespace nephroid
