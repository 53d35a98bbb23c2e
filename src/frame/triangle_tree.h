// All triangles of the scene in a tree of boxes, for rays of any origin and direction (triangle_tree.glsl).
//
// A shader walks it without a stack: nodes lie in the order of a depth-first walk, and each knows where the walk goes
// on if its box is missed. Such an order suits rays of one octant of directions, in which it meets near boxes first;
// small scenes have one for each of the eight, and tell coordinates so that they rise along its directions. The boxes
// themselves come from a builder that the frame is given; those are left out that a ray which met the box around them
// mostly meets.
//
// Most of a walk's time goes into fetching nodes, so boxes lie on a grid of 16 bits over the scene and take a texel
// each, unless that would make them much larger: things that are small in a wide scene keep boxes of floats, two texels
// each.
#pragma once

#include <cstdint>
#include <vector>

#include "core/box_tree.h"
#include "frame/frame.shared.h"
#include "gpu/commands.h"
#include "gpu/pipeline.h"
#include "scene/scene_data.h"

namespace nephroid {

static_assert(sizeof(TreeNode) == 32);
static_assert(sizeof(CompactTreeNode) == 16);
static_assert(sizeof(TreeTriangle) == 48);

/// The tree as the tables hold it.
struct TreeTables {
  bool compact = false;  ///< which of the next two there are, order by order
  std::vector<CompactTreeNode> compact_nodes;
  std::vector<TreeNode> nodes;
  vec3 grid_lower{0};       ///< m, world; where the grid of compact nodes begins
  float grid_scale = 1.0F;  ///< its cells a metre
  std::vector<TreeTriangle> triangles;
  std::uint32_t node_count = 0;   ///< of one order: boxes that are not left out
  std::uint32_t order_count = 1;  ///< 8: by the signs of the direction, bit k set where coordinate k is below 0
};

/// @throws ResourceError if the triangles are too many to be numbered, or as the builder does
TreeTables makeTreeTables(const SceneData& scene, const BoxTreeBuilder& builder);

class TriangleTree {
 public:
  /// Builds the tree and records its upload. @throws ResourceError
  TriangleTree(gpu::Device& device, gpu::CommandRecorder& recorder, const SceneData& scene,
               const BoxTreeBuilder& builder);

  /// What a shader is pushed.
  struct Walk {
    std::uint32_t nodes;
    vec3 grid_lower;
    float grid_scale;
  };
  const Walk& walk() const { return walk_; }
  /// Of frame/triangle_tree.glsl.
  std::vector<gpu::Constant> constants() const;
  const gpu::Buffer& nodes() const { return nodes_; }
  const gpu::Buffer& triangles() const { return triangles_; }

 private:
  bool compact_ = false, has_orders_ = false;
  Walk walk_;
  gpu::Buffer nodes_, triangles_;
};

}  // namespace nephroid
