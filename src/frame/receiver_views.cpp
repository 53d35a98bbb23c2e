#include "frame/receiver_views.h"

#include <algorithm>
#include <array>

#include "frame/receiver_map.shared.h"
#include "frame/view.h"

namespace nephroid {
namespace {

constexpr int kAxes = 6;
constexpr float kMargin = 1.001F, kSliver = 1e-6F;

/// Unit, out of the surfaces that are seen along it: +x, −x, +y, −y, +z, −z.
vec3 axisOf(int i) {
  vec3 axis(0.0F);
  axis[i / 2] = i % 2 == 0 ? 1.0F : -1.0F;
  return axis;
}

int mostFacing(vec3 normal) {
  const vec3 size = glm::abs(normal);
  int axis = size.y > size.x ? 1 : 0;
  if (size.z > size[axis]) axis = 2;
  return 2 * axis + (normal[axis] < 0.0F ? 1 : 0);
}

/// Does some of the box lie on the side of a plane that its normal points to?
bool liesBefore(const Bounds& box, vec3 normal, vec3 on_plane) {
  const vec3 farthest = glm::mix(box.lower, box.upper, glm::greaterThan(normal, vec3(0.0F)));
  return dot(normal, farthest - on_plane) > 0.0F;
}

/// What is to be seen along each axis.
struct Sides {
  std::array<bool, kAxes> seen{};
  Bounds bounds;

  void add(const SceneData& scene, const SceneBuffers::Draw& draw, const Bounds& generators) {
    const Instance& instance = scene.instances[draw.instance];
    const Mesh& mesh = scene.meshes[instance.mesh];
    const float out = glm::determinant(mat3(instance.world_from_object)) < 0.0F ? -1.0F : 1.0F;
    const auto placed = [&](std::uint32_t i) { return transformPoint(instance.world_from_object, mesh.positions[i]); };
    for (const uvec3& triangle : mesh.triangles) {
      const vec3 a = placed(triangle.x), b = placed(triangle.y), c = placed(triangle.z);
      const vec3 normal = out * cross(b - a, c - a);
      for (const float side : {1.0F, -1.0F}) {
        if ((side < 0.0F && draw.closed) || !liesBefore(generators, side * normal, a)) continue;
        seen[mostFacing(side * normal)] = true;
        for (const vec3& corner : {a, b, c}) bounds.add(corner);
      }
    }
  }

  /// Of the square that is as large as needed along every axis, m.
  float side() const {
    float largest = 0.0F;
    for (int i = 0; i < kAxes; ++i) {
      if (!seen[i]) continue;
      vec3 across = bounds.extent();
      across[i / 2] = 0.0F;
      largest = std::max({largest, across.x, across.y, across.z});
    }
    return largest;
  }
};

}  // namespace

ReceiverViews makeReceiverViews(const SceneData& scene, std::span<const SceneBuffers::Draw> draws) {
  ReceiverViews made;
  Bounds generators;
  for (const SceneBuffers::Draw& draw : draws)
    if (draw.generates) generators.add(draw.bounds);
  if (generators.empty()) return made;
  Sides sides;
  for (const SceneBuffers::Draw& draw : draws)
    if (draw.receives) sides.add(scene, draw, generators);
  made.centre = sides.bounds.centre();
  // A little more than they need: what lies on the edge is seen. Where there is but a point, a sliver.
  made.half = std::max(0.5F * kMargin * sides.side(), kSliver * scene.bounds().radius());
  for (int i = 0; i < kAxes; ++i) {
    const auto view = static_cast<std::uint32_t>(made.views.size());
    made.views_by_axis |= (sides.seen[i] ? view : kNoView) << (4 * i);
    if (!sides.seen[i]) continue;
    made.axes |= static_cast<std::uint32_t>(i) << (4 * view);
    // As seenAlong: up is against the picture's second coordinate.
    vec3 right(0.0F), up(0.0F);
    right[(i / 2 + 1) % 3] = made.half;
    up[(i / 2 + 2) % 3] = -made.half;
    made.views.push_back(makeParallelView(-axisOf(i), right, up, made.centre, scene.bounds()));
  }
  return made;
}

}  // namespace nephroid
