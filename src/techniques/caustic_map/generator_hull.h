// How far what casts caustics reaches, in any direction: what emission is fitted to.
#pragma once

#include <cstdint>
#include <map>
#include <memory>
#include <vector>

#include "core/support_tree.h"
#include "scene/scene_data.h"

namespace nephroid {

/// Points, and where they stand.
struct GeneratorBody {
  std::shared_ptr<const SupportTree> points;  ///< not empty
  mat4 world_from_object{1.0F};
};

/// The convex hull of bodies, by its points that are farthest in a direction.
///
/// When instances move, it is made anew from the same trees: as many questions to each as its outline has directions.
/// What is asked afterwards does not depend on how many triangles there are but by the depth of their trees, and by how
/// many of them are nearly as far out as the farthest.
class GeneratorHull {
 public:
  GeneratorHull() = default;
  explicit GeneratorHull(const std::vector<GeneratorBody>& bodies);

  bool empty() const { return bodies_.empty(); }
  const Bounds& bounds() const { return bounds_; }
  /// The point whose p·d is the largest, in the world. @pre not empty
  dvec3 farthest(const dvec3& d) const;
  /// Points of the hull that are the farthest in directions all around; not all of them. For choices that have to be
  /// good and not exact. Of an outline, itself. @pre not empty
  const GeneratorHull& outline() const { return outline_ ? *outline_ : *this; }

 private:
  struct Body {
    GeneratorBody body;
    Bounds bounds;  ///< in the world
  };
  void addBodies(const std::vector<GeneratorBody>& bodies);

  std::vector<Body> bodies_;
  Bounds bounds_;
  std::shared_ptr<const GeneratorHull> outline_;
};

/// Trees over the vertices of meshes, by their index. They do not know where their instances are.
using MeshTrees = std::map<std::uint32_t, std::shared_ptr<const SupportTree>>;

/// Of the instances that cast caustics; empty if there are none.
/// @param trees  those that it lacks are made: once for each mesh, n log n of its vertices
GeneratorHull makeGeneratorHull(const SceneData& scene, float specular_alpha, MeshTrees& trees);

}  // namespace nephroid
