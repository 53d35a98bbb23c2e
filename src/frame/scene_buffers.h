// The scene on the device: tables of triangles, instances, materials and textures, and what the rasteriser fetches.
#pragma once

#include <cstdint>
#include <vector>

#include "core/math.h"
#include "frame/frame.shared.h"
#include "gpu/commands.h"
#include "scene/classify.h"
#include "scene/scene_data.h"

namespace nephroid {

static_assert(sizeof(TriangleRecord) == 48);
static_assert(sizeof(InstanceRecord) == 80);
static_assert(sizeof(MaterialRecord) == 144);
static_assert(sizeof(TextureRecord) == 48);
static_assert(sizeof(ViewRecord) == 128);
static_assert(sizeof(LightRecord) == 112);
static_assert(sizeof(LampRecord) == 64);
static_assert(sizeof(GridNode) == 48);

/// What the materials of a scene have that bears on lobes of class S.
struct SpecularTraits {
  bool present = false;    ///< any
  bool metal = false;      ///< of any material
  bool rough = false;      ///< not all are mirrors
  bool transmits = false;  ///< panes, solids
  bool media = false;      ///< that absorb
  bool disperses = false;
};

/// What the materials of a scene have: shaders leave out the rest.
struct SceneTraits {
  bool metal = false, gloss = false, conductors = false;  ///< of lobes of class D
  bool textures = false;                                  ///< or colours of vertices
  bool passable = false;                                  ///< panes, cut-outs
  SpecularTraits specular;

  /// Specialisation constants of frame/tables.glsl.
  std::vector<gpu::Constant> constants() const;
  /// Of frame/path.glsl, and of frame/tables.glsl for what paths meet: lobes of class S.
  std::vector<gpu::Constant> pathConstants() const;
};

/// May some of it be an interface of class S, which reflects or lets through?
bool isSpecular(const Material& m, float specular_alpha);

class SceneBuffers {
 public:
  /// Bindings 0 to 6 of every pass that reads the scene (frame/tables.glsl).
  static constexpr std::uint32_t kBindings = 7;

  /// Records the upload.
  /// @param specular_alpha  finer interfaces are class S
  /// @throws ResourceError
  SceneBuffers(gpu::Device& device, gpu::CommandRecorder& recorder, const SceneData& scene, float specular_alpha);

  /// Records the upload of the instances alone, after some were moved.
  void updateInstances(gpu::Device& device, gpu::CommandRecorder& recorder, const SceneData& scene);

  const gpu::Buffer& positions() const { return positions_; }
  const gpu::Buffer& indices() const { return indices_; }
  /// Of each triangle those of its mesh beyond its edges (findNeighbours), and nothing: a table for those who walk on
  /// surfaces. Empty in scenes without generators.
  const gpu::Buffer& neighbours() const { return neighbours_; }
  /// `kBindings` of them and, behind, of `types`.
  static std::vector<gpu::Binding> bindings(std::initializer_list<VkDescriptorType> types);
  /// What is bound to them.
  std::vector<gpu::Bound> bound(std::initializer_list<gpu::Bound> more) const;
  std::vector<gpu::Use> uses(gpu::Access access, std::initializer_list<gpu::Use> more) const;

  /// One instance to draw.
  struct Draw {
    std::uint32_t instance = 0;
    std::uint32_t index_count = 0, first_index = 0;
    std::int32_t vertex_offset = 0;
    bool passable = false;   ///< light and sight may pass straight through it
    bool generates = false;  ///< casts caustics
    bool receives = false;   ///< catches them
    bool closed = false;     ///< its mesh has no open edges; known of scenes with generators
    Bounds bounds;           ///< world
    float longest_edge = 0;  ///< no edge of a triangle is longer; m, world
  };
  const std::vector<Draw>& draws() const { return draws_; }
  const SceneTraits& traits() const { return traits_; }
  /// For tables and texels: the nearest, unfiltered.
  const gpu::Sampler& sampler() const { return sampler_; }

 private:
  void uploadMeshes(gpu::Device& device, gpu::CommandRecorder& recorder, const SceneData& scene);
  void uploadNeighbours(gpu::Device& device, gpu::CommandRecorder& recorder, const SceneData& scene,
                        std::size_t triangles);
  void uploadMaterials(gpu::Device& device, gpu::CommandRecorder& recorder, const SceneData& scene,
                       float specular_alpha);

  /// Where a mesh lies in the tables.
  struct MeshPlace {
    std::uint32_t first_vertex = 0, first_triangle = 0;
    std::uint32_t texcoords[2] = {kNowhere, kNowhere}, colors = kNowhere, tangents = kNowhere;
    bool is_closed = false;
    float longest_edge = 0;  ///< of a triangle, in the mesh's space
  };

  gpu::Sampler sampler_;
  std::vector<MeshPlace> places_;        ///< by mesh
  std::vector<Classification> classes_;  ///< by material
  gpu::Buffer positions_, indices_;
  gpu::Buffer neighbours_;
  gpu::Buffer triangles_, instances_, materials_, attributes_, textures_, byte_texels_, float_texels_;
  std::vector<Draw> draws_;
  SceneTraits traits_;
};

}  // namespace nephroid
