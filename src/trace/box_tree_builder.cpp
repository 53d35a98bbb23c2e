#include "trace/box_tree_builder.h"

#include <fmt/format.h>

#include <algorithm>
#include <atomic>
#include <limits>
#include <new>

#include "nephroid/error.h"
#include "trace/embree.h"

namespace nephroid {
namespace {

/// Embree gives up on deeper trees. In a bad case, boxes in a geometric series, each level parts some of the 254
/// octaves of single precision from the rest; boxes in one place are halved, in 32 levels at the most.
constexpr unsigned kMaxDepth = 128;

/// A node while Embree builds: in its memory, which goes with the RTCBVH.
struct Built {
  std::uint32_t primitive_count;  ///< 0: this is an Inner, else a Leaf
};
struct Inner : Built {
  Bounds child_boxes[2];
  const Built* children[2];
};
struct Leaf : Built {
  const std::uint32_t* primitives;  ///< behind it
};

/// Callbacks tell by this that memory ran out: no exception may pass through Embree.
struct BuildState {
  std::atomic<bool> failed{false};
};

void* allocate(RTCThreadLocalAllocator allocator, std::size_t bytes, std::size_t alignment, void* state) noexcept {
  void* memory = rtcThreadLocalAlloc(allocator, bytes, alignment);
  if (!memory) static_cast<BuildState*>(state)->failed = true;
  return memory;
}

void* createNode(RTCThreadLocalAllocator allocator, unsigned /*child_count*/, void* state) noexcept {
  void* memory = allocate(allocator, sizeof(Inner), alignof(Inner), state);
  return memory ? new (memory) Inner{} : nullptr;
}

void setChildren(void* node, void** children, unsigned count, void* /*state*/) noexcept {
  if (!node) return;
  for (unsigned i = 0; i < count; ++i) static_cast<Inner*>(node)->children[i] = static_cast<const Built*>(children[i]);
}

void setBounds(void* node, const RTCBounds** bounds, unsigned count, void* /*state*/) noexcept {
  if (!node) return;
  for (unsigned i = 0; i < count; ++i) {
    const RTCBounds& b = *bounds[i];
    static_cast<Inner*>(node)->child_boxes[i] = {vec3(b.lower_x, b.lower_y, b.lower_z),
                                                 vec3(b.upper_x, b.upper_y, b.upper_z)};
  }
}

void* createLeaf(RTCThreadLocalAllocator allocator, const RTCBuildPrimitive* primitives, std::size_t count,
                 void* state) noexcept {
  void* memory = allocate(allocator, sizeof(Leaf) + count * sizeof(std::uint32_t), alignof(Leaf), state);
  if (!memory) return nullptr;
  Leaf* leaf = new (memory) Leaf{};
  auto* indices = new (leaf + 1) std::uint32_t[count];
  for (std::size_t i = 0; i < count; ++i) indices[i] = primitives[i].primID;
  leaf->primitive_count = static_cast<std::uint32_t>(count);
  leaf->primitives = indices;
  return leaf;
}

bool isUsable(const Bounds& box) {
  const vec3 size = glm::max(glm::abs(box.lower), glm::abs(box.upper));
  // NaN is never below.
  return glm::all(glm::lessThanEqual(box.lower, box.upper)) && size.x <= kMaxBoxCoordinate &&
         size.y <= kMaxBoxCoordinate && size.z <= kMaxBoxCoordinate;
}

std::vector<RTCBuildPrimitive> makePrimitives(std::span<const Bounds> boxes) {
  std::vector<RTCBuildPrimitive> primitives;
  primitives.reserve(boxes.size());
  for (std::size_t i = 0; i < boxes.size(); ++i) {
    const Bounds& b = boxes[i];
    if (!isUsable(b)) continue;
    primitives.push_back(
        {b.lower.x, b.lower.y, b.lower.z, 0, b.upper.x, b.upper.y, b.upper.z, static_cast<unsigned>(i)});
  }
  return primitives;
}

/// Lays nodes out one behind the other, in an order that does not depend on which thread made them.
class Flattening {
 public:
  Flattening(BoxTree& tree, std::span<const Bounds> boxes) : tree_(tree), boxes_(boxes) {}

  void add(const Built& built, const Bounds& box) {
    const std::size_t index = tree_.nodes.size();
    tree_.nodes.push_back({box, 0, built.primitive_count});
    if (built.primitive_count > 0) {
      tree_.nodes[index].first = static_cast<std::uint32_t>(tree_.primitives.size());
      const std::span primitives = primitivesOf(built);
      tree_.primitives.insert(tree_.primitives.end(), primitives.begin(), primitives.end());
      std::sort(tree_.primitives.end() - built.primitive_count, tree_.primitives.end());
      return;
    }
    const auto& inner = static_cast<const Inner&>(built);
    add(*inner.children[0], inner.child_boxes[0]);
    tree_.nodes[index].first = static_cast<std::uint32_t>(tree_.nodes.size());
    add(*inner.children[1], inner.child_boxes[1]);
  }

  void addRoot(const Built& root) {
    Bounds box;
    if (root.primitive_count > 0) {
      for (const std::uint32_t i : primitivesOf(root)) box.add(boxes_[i]);
    } else {
      for (const Bounds& child : static_cast<const Inner&>(root).child_boxes) box.add(child);
    }
    add(root, box);
  }

 private:
  static std::span<const std::uint32_t> primitivesOf(const Built& leaf) {
    return {static_cast<const Leaf&>(leaf).primitives, leaf.primitive_count};
  }

  BoxTree& tree_;
  std::span<const Bounds> boxes_;
};

[[noreturn]] void fail(RTCDevice device) {
  const RTCError code = rtcGetDeviceError(device);
  throw ResourceError(fmt::format("the tree of boxes could not be built, probably for lack of memory (Embree error {})",
                                  static_cast<int>(code)));
}

}  // namespace

BoxTree buildBoxTree(std::span<const Bounds> boxes, const BoxTreeCosts& costs) {
  if (boxes.size() > std::numeric_limits<std::uint32_t>::max())
    throw ResourceError("a tree has at most 2^32 - 1 boxes");
  BoxTree tree;
  std::vector<RTCBuildPrimitive> primitives = makePrimitives(boxes);
  if (primitives.empty()) return tree;
  const EmbreeDevice device(rtcNewDevice(kEmbreeConfig));
  if (!device.get()) fail(nullptr);
  const EmbreeHandle<RTCBVH, rtcReleaseBVH> bvh(rtcNewBVH(device.get()));
  if (!bvh.get()) fail(device.get());
  BuildState state;
  RTCBuildArguments arguments = rtcDefaultBuildArguments();
  arguments.maxDepth = kMaxDepth;
  arguments.maxLeafSize = std::clamp(costs.max_leaf_size, 1U, unsigned{RTC_BUILD_MAX_PRIMITIVES_PER_LEAF});
  arguments.traversalCost = costs.box;
  arguments.intersectionCost = costs.primitive;
  arguments.bvh = bvh.get();
  arguments.primitives = primitives.data();
  arguments.primitiveCount = arguments.primitiveArrayCapacity = primitives.size();
  arguments.createNode = createNode;
  arguments.setNodeChildren = setChildren;
  arguments.setNodeBounds = setBounds;
  arguments.createLeaf = createLeaf;
  arguments.userPtr = &state;
  const auto* root = static_cast<const Built*>(rtcBuildBVH(&arguments));
  if (!root || state.failed) fail(device.get());
  tree.primitives.reserve(primitives.size());
  tree.nodes.reserve(2 * primitives.size());
  Flattening(tree, boxes).addRoot(*root);
  return tree;
}

}  // namespace nephroid
