#include "techniques/caustic_map/emission_views.h"

#include <algorithm>
#include <cmath>

#include "core/math.h"
#include "frame/view.h"
#include "scene/classify.h"

namespace nephroid {
namespace {

/// A point's view is fitted up to this half-angle of the generators; farther out a perspective picture wastes its
/// cells on the corners, and faces of a cube take over.
constexpr float kWidestTangent = 1.5F;
/// A fitted view is larger by so much than what it holds: rounding must not leave out an edge.
constexpr float kFitMargin = 1.0F + 1e-4F;

vec3 cornerOf(const Bounds& b, int corner) {
  return {(corner & 1) != 0 ? b.upper.x : b.lower.x, (corner & 2) != 0 ? b.upper.y : b.lower.y,
          (corner & 4) != 0 ? b.upper.z : b.lower.z};
}

/// Half the side of a square about `forward`, at distance 1, that holds the box; infinite if some of it is beside the
/// eye or behind it.
float tangentOf(const Bounds& box, vec3 eye, vec3 forward, vec3 right, vec3 up) {
  float largest = 0.0F;
  for (int corner = 0; corner < 8; ++corner) {
    const vec3 to = cornerOf(box, corner) - eye;
    const float depth = dot(to, forward);
    if (!(depth > 0.0F)) return kInfinity;
    largest = std::max({largest, std::abs(dot(to, right)) / depth, std::abs(dot(to, up)) / depth});
  }
  return largest;
}

/// Can a spot's cone reach a box? Conservative: by the sphere about it.
bool reaches(const LightRecord& light, const Bounds& box) {
  if (light.kind != kLightSpot) return true;
  const vec3 to = box.centre() - light.position;
  const float distance = length(to), radius = box.radius();
  if (distance <= radius) return true;
  const float angle = std::acos(std::clamp(dot(to, light.direction) / distance, -1.0F, 1.0F));
  return angle - std::asin(radius / distance) <= std::acos(std::clamp(light.cos_outer, -1.0F, 1.0F));
}

}  // namespace

Bounds generatorBounds(const SceneData& scene, float specular_alpha) {
  const std::vector<Classification> classes = classifyMaterials(scene, specular_alpha);
  Bounds bounds;
  for (const Instance& instance : scene.instances) {
    if (!instance.casts || !classes[scene.meshes[instance.mesh].material].is_generator) continue;
    for (const vec3& position : scene.meshes[instance.mesh].positions)
      bounds.add(transformPoint(instance.world_from_object, position));
  }
  return bounds;
}

std::vector<ViewRecord> makeEmissionViews(const LightRecord& light, const Bounds& generators, const Bounds& scene) {
  if (light.kind == kLightDirectional) return {makeParallelView(light.direction, generators, scene)};
  if (!reaches(light, generators)) return {};
  const vec3 to = generators.centre() - light.position;
  if (length(to) > 0.0F) {
    const Frame frame = Frame::fromZ(normalize(to));
    const float tangent = tangentOf(generators, light.position, frame.z, frame.x, frame.y) * kFitMargin;
    if (tangent <= kWidestTangent) {
      const DepthRange range = fitDepthRange(scene, light.position, frame.z);
      return {makePerspectiveView(light.position, frame.z, frame.y, tangent, range)};
    }
  }
  std::vector<ViewRecord> views;
  for (int face = 0; face < 6; ++face) {
    const ViewRecord view = makeCubeView(light.position, face, scene);
    if (mayShow(view, generators)) views.push_back(view);
  }
  return views;
}

}  // namespace nephroid
