// Light on the surfaces of somebody else's picture, which he tells by depths and normals.
#pragma once

#include <memory>
#include <optional>

#include "frame/direct_irradiance.h"
#include "frame/pixel_surfaces.h"
#include "frame/realtime_technique.h"

namespace nephroid {

/// The scene's surfaces as somebody else drew them, or others within its bounds.
struct ForeignPicture {
  ForeignView view;
  const gpu::Image& depth;
  const gpu::Image& normal;  ///< world space; where it is not of length 1, there is nothing
};

/// Which light is wanted.
struct ForeignLight {
  bool direct = true;
  bool caustic = true;
};

/// Buffers and grids must outlive it.
class ForeignLighting {
 public:
  ForeignLighting(gpu::Device& device, const SceneBuffers& buffers, const LightGrids& lights);

  /// Adds one sample of the light to `target`, of the size of the picture.
  /// @param view       the picture's
  /// @param technique  null: no caustic
  void record(gpu::CommandRecorder& recorder, const ForeignPicture& picture, const ForeignViewRecord& view,
              const IrradianceImages& target, const ForeignLight& light, RealtimeTechnique* technique,
              std::uint32_t sample, float weight);

 private:
  gpu::Device& device_;
  const SceneBuffers& buffers_;
  const LightGrids& lights_;
  std::unique_ptr<DirectIrradiance> direct_;  ///< once it is asked for
  gpu::Buffer view_;
  gpu::Image nothing_;
};

}  // namespace nephroid
