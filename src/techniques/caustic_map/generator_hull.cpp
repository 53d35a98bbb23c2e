#include "techniques/caustic_map/generator_hull.h"

#include <cmath>
#include <limits>
#include <numbers>
#include <optional>
#include <utility>

#include "core/assert.h"
#include "scene/classify.h"

namespace nephroid {
namespace {

/// Directions of an outline: 13° between neighbours. More would be a choice that is little better.
constexpr int kOutlineDirections = 256;
constexpr double kNothing = -std::numeric_limits<double>::infinity();

/// Of an instance, in the world. @return  nothing if no p·d exceeds `at_least`
std::optional<dvec3> farthestOf(const GeneratorBody& body, const dvec3& d, double at_least) {
  const glm::dmat4 m(body.world_from_object);
  const dvec3 offset(m[3]);
  const vec3* point = body.points->farthest(transpose(glm::dmat3(m)) * d, at_least - dot(offset, d));
  if (point == nullptr) return std::nullopt;
  return glm::dmat3(m) * dvec3(*point) + offset;
}

Bounds boundsOf(const GeneratorBody& body) {
  Bounds bounds;
  for (int axis = 0; axis < 3; ++axis)
    for (const double sign : {-1.0, 1.0}) {
      dvec3 d(0.0);
      d[axis] = sign;
      if (const auto point = farthestOf(body, d, kNothing)) bounds.add(vec3(*point));
    }
  return bounds;
}

/// Fibonacci's spiral: directions that are spread evenly.
dvec3 spiralDirection(int i, int count) {
  const double golden_angle = std::numbers::pi * (3.0 - std::sqrt(5.0));
  const double y = 1.0 - 2.0 * (i + 0.5) / count, r = std::sqrt(1.0 - y * y);
  return {r * std::cos(golden_angle * i), y, r * std::sin(golden_angle * i)};
}

}  // namespace

GeneratorHull::GeneratorHull(const std::vector<GeneratorBody>& bodies) {
  addBodies(bodies);
  if (empty()) return;
  std::vector<vec3> points;
  for (int i = 0; i < kOutlineDirections; ++i) points.emplace_back(farthest(spiralDirection(i, kOutlineDirections)));
  auto outline = std::make_shared<GeneratorHull>();
  outline->addBodies({{std::make_shared<const SupportTree>(std::move(points)), mat4(1.0F)}});
  outline_ = std::move(outline);
}

void GeneratorHull::addBodies(const std::vector<GeneratorBody>& bodies) {
  for (const GeneratorBody& body : bodies) {
    bodies_.push_back({body, boundsOf(body)});
    bounds_.add(bodies_.back().bounds);
  }
}

dvec3 GeneratorHull::farthest(const dvec3& d) const {
  NEPHROID_ASSERT_GT(bodies_.size(), 0U);
  dvec3 best(0.0);
  double most = kNothing;
  for (const auto& [body, bounds] : bodies_) {
    if (supportOf(bounds, d) <= most) continue;
    const std::optional<dvec3> point = farthestOf(body, d, most);
    if (!point) continue;
    best = *point;
    most = dot(best, d);
  }
  return best;
}

GeneratorHull makeGeneratorHull(const SceneData& scene, float specular_alpha, MeshTrees& trees) {
  const std::vector<Classification> classes = classifyMaterials(scene, specular_alpha);
  std::vector<GeneratorBody> bodies;
  for (const Instance& instance : scene.instances) {
    const Mesh& mesh = scene.meshes[instance.mesh];
    if (!instance.casts || mesh.positions.empty() || !classes[mesh.material].is_generator) continue;
    std::shared_ptr<const SupportTree>& tree = trees[instance.mesh];
    if (!tree) tree = std::make_shared<const SupportTree>(mesh.positions);
    bodies.push_back({tree, instance.world_from_object});
  }
  return GeneratorHull(bodies);
}

}  // namespace nephroid
