// Coarser pictures over those of a FluxMap: for cells of photons that spread over many texels.
//
// A texel of level k is 2^k of the picture's wide. A cell is deposited where it spans few texels, so that its cost does
// not grow with its area; in the end each level is added to the next finer one (deposit_levels.h).
#pragma once

#include <cstdint>

#include "frame/deposit.shared.h"
#include "gpu/commands.h"

namespace nephroid {

/// Move-only.
class FluxLevels {
 public:
  FluxLevels() = default;
  /// @param width, height  texels of each picture
  /// @param pictures       one behind the other
  /// @param channels       of each picture
  /// @throws ResourceError
  FluxLevels(gpu::Device& device, std::uint32_t width, std::uint32_t height, std::uint32_t pictures,
             std::uint32_t channels);

  /// Records that nothing is in them, nor is it known what they show.
  void clear(gpu::CommandRecorder& recorder) const;

  /// Levels; 0 for pictures so small that they need none.
  std::uint32_t count() const { return count_; }
  std::uint32_t pictureCount() const { return surfaces_.desc().layers; }

  // All levels of a picture lie in one layer, where flux_levels.glsl says.

  /// R32_SINT array, as FluxMap::flux.
  const gpu::Image& flux() const { return flux_; }
  /// RGBA32F array, a layer a picture: of the first of its texels, as SurfaceLayers::surfaces.
  const gpu::Image& surfaces() const { return surfaces_; }
  /// R32_UINT array: kNode….
  const gpu::Image& kinds() const { return kinds_; }
  /// R32_UINT array: kLink….
  const gpu::Image& links() const { return links_; }
  /// A FluxLevelsState.
  const gpu::Buffer& state() const { return state_; }

 private:
  std::uint32_t count_ = 0;
  gpu::Image flux_, surfaces_, kinds_, links_;
  gpu::Buffer state_;
};

}  // namespace nephroid
