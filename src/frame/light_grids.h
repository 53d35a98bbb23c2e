// The triangles before each light, by cell of what it sees (light_grid.comp.glsl): what shadows are asked from.
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "frame/light_views.h"
#include "frame/scene_buffers.h"
#include "gpu/commands.h"

namespace nephroid {

/// Not thread-safe. Device, scene and buffers must outlive it.
class LightGrids {
 public:
  /// @param grid_size  cells along a side of each view of a light that varies, half as many as of one that stays; fewer
  ///                   are taken if the lights are many
  /// @throws ResourceError
  LightGrids(gpu::Device& device, const SceneData& scene, const SceneBuffers& buffers, std::uint32_t grid_size,
             std::uint32_t seed);

  /// Makes the views of sample `sample`, and the grids of those lights whose views are new. Submits and waits for what
  /// it records.
  /// @param times  the passes' are added to it
  /// @throws ResourceError
  void update(gpu::CommandRecorder& recorder, std::uint32_t sample, std::vector<gpu::PassTime>& times);

  /// One of SceneData::lights is another now: its grid is made again, and no other.
  void lightChanged(std::size_t index) { lights_[index].built = false; }
  /// What casts shadows has moved: all grids are made again.
  void geometryChanged();

  /// Sources of light, whether or not they shine in this sample.
  std::uint32_t lightCount() const { return static_cast<std::uint32_t>(lights_.size()); }

  /// Bindings of frame/lights.glsl, from `first` on.
  static constexpr std::uint32_t kBindings = 4;
  /// What those passes are compiled for.
  LightTraits traits() const { return light_views_->traits(); }
  std::vector<gpu::Bound> bound(std::uint32_t first) const;
  std::vector<gpu::Use> uses() const;

 private:
  struct Light {
    LightRecord record{};
    std::vector<ViewRecord> views;
    std::uint32_t first_view = 0;  ///< of all lights' views
    std::uint32_t first_node = 0, node_capacity = 0;
    bool built = false;  ///< and still true
    bool varies = true;
  };
  /// Room for as many lights as there are, none of them built.
  void makeHeads();
  void allocate();
  /// @return  whether some view is new
  bool makeViews(std::uint32_t sample);
  void uploadTables(gpu::CommandRecorder& recorder);
  void build(gpu::CommandRecorder& recorder, std::uint32_t index);
  /// @return  whether all nodes found room; else there is room now
  bool checkCapacity();

  gpu::Device& device_;
  const SceneBuffers& buffers_;
  const SceneData& scene_;
  std::uint32_t seed_;
  Bounds bounds_;
  std::optional<LightViews> light_views_;
  std::uint32_t grid_size_;
  gpu::ComputePipeline pipeline_;
  gpu::Buffer light_table_, view_table_, heads_, nodes_;
  gpu::Buffer lights_buffer_, counters_;
  std::vector<Light> lights_;
};

}  // namespace nephroid
