// Which of a set of points is the farthest in a direction, without looking at all of them.
#pragma once

#include <cstdint>
#include <vector>

#include "core/math.h"

namespace nephroid {

/// A binary tree of boxes over points. Immutable, so safe to share.
class SupportTree {
 public:
  /// Sorts the points: n log n, once. @param points  finite
  explicit SupportTree(std::vector<vec3> points);

  bool empty() const { return points_.empty(); }
  /// Of all points; empty without any.
  Bounds bounds() const;
  /// The point whose p·d is the largest. It looks at the more boxes, the more points lie nearly as far out as the
  /// farthest: some dozen of most bodies, 1800 of a million points on a sphere.
  /// @param d         need not be a unit vector
  /// @param at_least  null is returned if no p·d exceeds it
  const vec3* farthest(const dvec3& d, double at_least = -std::numeric_limits<double>::infinity()) const;

 private:
  struct Node {
    Bounds box;
    std::uint32_t first = 0, count = 0;  ///< points, of a leaf; else where the second child is, and 0
  };
  std::uint32_t build(std::uint32_t first, std::uint32_t count);

  std::vector<vec3> points_;
  std::vector<Node> nodes_;  ///< the root first; a node's first child follows it
};

/// The largest p·d of a box. @return  -infinity if it is empty
double supportOf(const Bounds& box, const dvec3& d);

}  // namespace nephroid
