#include "core/support_tree.h"

#include <algorithm>
#include <array>
#include <span>
#include <utility>

#include "core/assert.h"

namespace nephroid {
namespace {

/// Points of a leaf at most: as many as are looked at in about the time that two boxes take.
constexpr std::uint32_t kLeafPoints = 8;
/// Halves of 2^32 points are a leaf long before.
constexpr std::size_t kMostDepth = 40;

}  // namespace

double supportOf(const Bounds& box, const dvec3& d) {
  if (box.empty()) return -std::numeric_limits<double>::infinity();
  return (d.x > 0.0 ? box.upper.x : box.lower.x) * d.x + (d.y > 0.0 ? box.upper.y : box.lower.y) * d.y +
         (d.z > 0.0 ? box.upper.z : box.lower.z) * d.z;
}

SupportTree::SupportTree(std::vector<vec3> points) : points_(std::move(points)) {
  if (!points_.empty()) build(0, static_cast<std::uint32_t>(points_.size()));
}

Bounds SupportTree::bounds() const { return nodes_.empty() ? Bounds() : nodes_[0].box; }

std::uint32_t SupportTree::build(std::uint32_t first, std::uint32_t count) {
  const std::span<vec3> points = std::span(points_).subspan(first, count);
  Bounds box;
  for (const vec3& point : points) box.add(point);
  const auto index = static_cast<std::uint32_t>(nodes_.size());
  nodes_.push_back({box, first, count});
  if (count <= kLeafPoints) return index;
  const vec3 extent = box.extent();
  const int axis = extent.x >= extent.y && extent.x >= extent.z ? 0 : extent.y >= extent.z ? 1 : 2;
  const std::uint32_t half = count / 2;
  std::ranges::nth_element(points, points.begin() + half,
                           [axis](const vec3& a, const vec3& b) { return a[axis] < b[axis]; });
  build(first, half);
  const std::uint32_t second = build(first + half, count - half);
  nodes_[index].first = second;
  nodes_[index].count = 0;
  return index;
}

const vec3* SupportTree::farthest(const dvec3& d, double at_least) const {
  const vec3* best = nullptr;
  if (nodes_.empty()) return best;
  struct Waiting {
    std::uint32_t node;
    double reach;
  };
  std::array<Waiting, kMostDepth> stack;
  std::size_t waiting = 0;
  stack[waiting++] = {0, supportOf(nodes_[0].box, d)};
  while (waiting > 0) {
    const auto [index, reach] = stack[--waiting];
    if (reach <= at_least) continue;
    const Node& node = nodes_[index];
    if (node.count > 0) {
      for (std::uint32_t i = node.first; i < node.first + node.count; ++i)
        if (const double here = dot(dvec3(points_[i]), d); here > at_least) best = &points_[i], at_least = here;
      continue;
    }
    // The one that reaches farther is looked into first: most likely the other is then left out.
    Waiting one{index + 1, supportOf(nodes_[index + 1].box, d)};
    Waiting other{node.first, supportOf(nodes_[node.first].box, d)};
    if (one.reach > other.reach) std::swap(one, other);
    NEPHROID_ASSERT_LE(waiting + 2, stack.size());
    stack[waiting++] = one;
    stack[waiting++] = other;
  }
  return best;
}

}  // namespace nephroid
