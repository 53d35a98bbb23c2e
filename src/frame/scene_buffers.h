// The scene on the device: tables of vertices, triangles, instances and materials.
#pragma once

#include <cstdint>
#include <vector>

#include "core/math.h"
#include "frame/frame.shared.h"
#include "gpu/commands.h"
#include "scene/scene_data.h"

namespace nephroid {

static_assert(sizeof(InstanceRecord) == 64);
static_assert(sizeof(MaterialRecord) == 88);
static_assert(sizeof(ViewRecord) == 116);
static_assert(sizeof(LightRecord) == 72);
static_assert(sizeof(GridNode) == 48);

/// Bindings 0 to 4 of every pass that reads the scene (frame/scene_access.glsl).
std::vector<gpu::Binding> sceneBindings();

class SceneBuffers {
 public:
  /// Records the upload. @throws ResourceError
  SceneBuffers(gpu::Device& device, gpu::CommandRecorder& recorder, const SceneData& scene);

  const gpu::Buffer& instances() const { return instances_; }
  const gpu::Buffer& materials() const { return materials_; }
  const gpu::Buffer& positions() const { return positions_; }
  const gpu::Buffer& indices() const { return indices_; }
  /// For passes that bind `sceneBindings()`.
  std::vector<gpu::Bound> bound() const;
  std::vector<gpu::Use> uses(gpu::Access access) const;

  /// One instance to draw.
  struct Draw {
    std::uint32_t instance = 0;
    std::uint32_t index_count = 0, first_index = 0;
    std::int32_t vertex_offset = 0;
    Bounds bounds;  ///< world
  };
  const std::vector<Draw>& draws() const { return draws_; }

  /// What receivers there are: whether any has a class-D lobe of that kind.
  struct Receivers {
    bool metal = false, gloss = false, conductors = false;
  };
  /// @param specular_alpha  finer interfaces are class S
  Receivers inspectReceivers(float specular_alpha) const;

 private:
  gpu::Buffer instances_, materials_, positions_, normals_, indices_;
  std::vector<MaterialRecord> material_records_;
  std::vector<Draw> draws_;
};

}  // namespace nephroid
