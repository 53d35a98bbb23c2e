// A binary tree of boxes over boxes: what is built by whoever has a builder, for whoever walks it elsewhere.
#pragma once

#include <cstdint>
#include <functional>
#include <span>
#include <vector>

#include "core/math.h"

namespace nephroid {

/// Plain data. The first node is the root; without primitives there is none.
struct BoxTree {
  struct Node {
    Bounds box;  ///< of all that is below
    /// Of a leaf: into `primitives`. Of any other node: where its second child is; the first one follows the node.
    std::uint32_t first = 0;
    std::uint32_t count = 0;  ///< primitives of a leaf; 0: it has two children
    bool isLeaf() const { return count > 0; }
  };
  std::vector<Node> nodes;                ///< parents before children, the first child's before the second's
  std::vector<std::uint32_t> primitives;  ///< indices of the boxes that the tree was built over, leaf by leaf
};

/// What the tree is built for.
struct BoxTreeCosts {
  std::uint32_t max_leaf_size = 1;
  float box = 1.0F;        ///< of testing a ray against a node's box, in any unit
  float primitive = 1.0F;  ///< of testing a ray against a primitive, in the same one
};

/// A tree over `boxes`, the same for the same boxes; each is in one leaf, but for those that are not finite or whose
/// coordinates exceed `kMaxBoxCoordinate`: they are in none.
/// @throws ResourceError
using BoxTreeBuilder = std::function<BoxTree(std::span<const Bounds> boxes, const BoxTreeCosts& costs)>;

/// Areas of larger boxes are beyond single precision.
inline constexpr float kMaxBoxCoordinate = 1e18F;

}  // namespace nephroid
