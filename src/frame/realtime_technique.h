// What a real-time technique gets from the frame and gives to it. The frame draws everything but the caustic; a
// technique says how much light reaches each pixel on its way through glass, water and mirrors and, if it can, each
// place that mirrors and glass show.
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>

#include "frame/irradiance_images.h"
#include "frame/light_grids.h"
#include "frame/pixel_surfaces.h"
#include "frame/receiver_map.h"
#include "frame/scene_buffers.h"
#include "frame/triangle_tree.h"
#include "gpu/commands.h"
#include "scene/scene_data.h"

namespace nephroid {

/// Given once; all of it outlives the technique.
struct RealtimeInputs {
  gpu::Device& device;
  const SceneData& scene;
  const SceneBuffers& buffers;  ///< the scene on the device
  const LightGrids& lights;     ///< its lights in the present sample, and what casts shadows from them
  float specular_alpha;         ///< microfacets finer than this are class S
  std::uint32_t seed;
  /// What any ray meets; another one once objects have moved. Not to be asked for while passes are recorded.
  /// Empty: there is no builder for it. @throws ResourceError
  std::function<const TriangleTree&()> tree;
};

/// Given for each sample.
struct RealtimeSample {
  const PixelSurfaces& surfaces;   ///< what each pixel shows
  const IrradianceImages& target;  ///< to add to, of the size of `surfaces`
  std::uint32_t index = 0;
  float weight = 1.0F;  ///< times which it is added
};

/// Not thread-safe.
class RealtimeTechnique {
 public:
  RealtimeTechnique() = default;
  virtual ~RealtimeTechnique() = default;
  RealtimeTechnique(const RealtimeTechnique&) = delete;
  RealtimeTechnique& operator=(const RealtimeTechnique&) = delete;

  /// Records passes that add the irradiance of light LS⁺, on the side of each surface that is seen, to the target.
  /// @throws ResourceError
  virtual void record(gpu::CommandRecorder& recorder, const RealtimeSample& sample) = 0;

  /// Asked by who shows caustics in mirrors and through glass. From now on `record` of the frame's own pictures also
  /// says what falls on all receivers; the map is remade when objects move, and then asked for again.
  /// @return  null: the technique knows of pixels alone
  /// @throws ResourceError
  virtual const ReceiverMap* lightReceivers() { return nullptr; }

  /// Flux of the last sample that fell on receivers where none of their views shows them, W: the map of lightReceivers
  /// lacks it. Waits for the device. @throws ResourceError
  virtual dvec3 lostByReceivers() { return dvec3(0.0); }

  /// SceneData::lights[index] is another now.
  virtual void lightChanged(std::size_t index) = 0;
  /// Instances stand elsewhere now; the buffers know it already.
  virtual void objectsMoved() = 0;
};

/// @return  null if there is nothing to draw: no light that could make a caustic, or no technique
using MakeRealtimeTechnique = std::function<std::unique_ptr<RealtimeTechnique>(const RealtimeInputs&)>;

}  // namespace nephroid
