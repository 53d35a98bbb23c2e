// All triangles of the scene in a tree of boxes, for rays of any origin and direction (triangle_tree.glsl).
//
// A shader walks it without a stack: nodes lie in the order of a depth-first walk, and each knows where the walk goes
// on if its box is missed. Such an order suits rays of one octant of directions, in which it meets near boxes first;
// small scenes have one for each of the eight. The boxes themselves come from a builder that the frame is given.
#pragma once

#include <cstdint>
#include <vector>

#include "core/box_tree.h"
#include "frame/frame.shared.h"
#include "gpu/commands.h"
#include "scene/scene_data.h"

namespace nephroid {

static_assert(sizeof(TreeNode) == 32);
static_assert(sizeof(TreeTriangle) == 48);

/// The tree as the tables hold it.
struct TreeTables {
  std::vector<TreeNode> nodes;  ///< order by order
  std::vector<TreeTriangle> triangles;
  std::uint32_t node_count = 0;   ///< of one order
  std::uint32_t order_count = 1;  ///< 8: by the signs of the direction, bit k set where coordinate k is below 0
};

/// @throws ResourceError if the triangles are too many to be numbered, or as the builder does
TreeTables makeTreeTables(const SceneData& scene, const BoxTreeBuilder& builder);

class TriangleTree {
 public:
  /// Builds the tree and records its upload. @throws ResourceError
  TriangleTree(gpu::Device& device, gpu::CommandRecorder& recorder, const SceneData& scene,
               const BoxTreeBuilder& builder);

  std::uint32_t nodeCount() const { return node_count_; }
  std::uint32_t orderCount() const { return order_count_; }
  const gpu::Image& nodes() const { return nodes_; }
  const gpu::Image& triangles() const { return triangles_; }

 private:
  std::uint32_t node_count_ = 0, order_count_ = 1;
  gpu::Image nodes_, triangles_;
};

}  // namespace nephroid
