// Every kind of light as points and directions that shine: one view of each light for each sample.
//
// A lamp without a size is one point and the same for all samples. Of what has a size (spheres, suns with an angle,
// emissive meshes, the environment) each sample takes one place or direction, chosen by how much it shines, and the
// mean over samples converges to the light.
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "core/sampling/distribution.h"
#include "frame/frame.shared.h"
#include "gpu/pipeline.h"
#include "scene/environment_map.h"
#include "scene/scene_data.h"

namespace nephroid {

struct LightView {
  LightRecord light{};            ///< its grid not yet
  std::vector<ViewRecord> views;  ///< 1, or 6 of a cube
  bool varies = false;            ///< from sample to sample: else its grid may be kept
};

/// What lights there are: shaders leave out the rest.
struct LightTraits {
  bool points = false, directionals = false, spots = false;
  bool surfaces = false;  ///< points of something with a size
  std::uint32_t count = 0;

  /// How many there are if they are so few that shaders have code for each, else 0.
  std::uint32_t fewCount() const;
  /// Specialisation constants of frame/lights.glsl.
  std::vector<gpu::Constant> constants() const;
  /// Whether what was compiled for these serves for `others` too.
  bool cover(const LightTraits& others) const;
};

class LightViews {
 public:
  /// Keeps a reference to the scene.
  LightViews(const SceneData& scene, std::uint32_t seed);

  /// Sources of light: as many views has each sample, in the same order. Those of SceneData::lights come first.
  std::size_t count() const { return sources_.size(); }
  /// Of all sources, whether or not they shine; reads the scene's lights as they are now.
  LightTraits traits() const;
  /// Whether a source does not shine in any sample, until the scene's lights are others.
  bool isOut(std::size_t index) const;
  /// View `index` of sample `sample`; nothing if it does not shine. Reads the scene's lights as they are now.
  std::optional<LightView> make(std::size_t index, std::uint32_t sample) const;

 private:
  /// An emissive mesh, its triangles in world space.
  struct MeshLight {
    std::uint32_t instance = 0;
    Distribution1D triangles;
    double area = 0;
  };
  enum class Kind : std::uint8_t { kPunctual, kMesh, kEnvironment };
  struct Source {
    Kind kind;
    std::size_t index;
  };
  LightView makePunctual(const Light& light, vec2 u) const;
  std::optional<LightView> makeMesh(const MeshLight& light, vec2 u) const;
  std::optional<LightView> makeEnvironment(vec2 u) const;
  void addCube(LightView& view) const;
  void addParallel(LightView& view) const;

  const SceneData& scene_;
  Bounds bounds_;
  std::uint32_t seed_;
  std::vector<MeshLight> mesh_lights_;
  std::optional<EnvironmentMap> environment_;
  std::vector<Source> sources_;
};

}  // namespace nephroid
