#include "frame/triangle_tree.h"

#include <span>

#include "core/math.h"
#include "core/parallel.h"
#include "frame/table.h"
#include "nephroid/error.h"

namespace nephroid {
namespace {

/// What a shader's turn of triangle_tree.glsl takes for each.
constexpr BoxTreeCosts kCosts{.max_leaf_size = 3, .box = 1.0F, .primitive = 1.0F};
/// More triangles than this have one order only, for the sake of memory.
constexpr std::size_t kMaxOrdered = 400'000;
/// Widening of boxes, relative to the coordinates: the rounding of a shader's test.
constexpr float kBoxMargin = 1.0F / 1048576.0F;

/// All triangles of the scene, and the boxes of each.
struct Triangles {
  std::vector<TreeTriangle> all;
  std::vector<Bounds> boxes;
};

Triangles placeTriangles(const SceneData& scene) {
  std::vector<std::size_t> first{0};
  for (const Instance& instance : scene.instances)
    first.push_back(first.back() + scene.meshes[instance.mesh].triangles.size());
  if (first.back() >= 1U << 29U) throw ResourceError("the scene has too many triangles for one tree");
  Triangles triangles{std::vector<TreeTriangle>(first.back()), std::vector<Bounds>(first.back())};
  for (std::size_t i = 0; i < scene.instances.size(); ++i) {
    const Instance& instance = scene.instances[i];
    const Mesh& mesh = scene.meshes[instance.mesh];
    parallelFor(mesh.triangles.size(), [&](std::size_t t) {
      vec3 p[3];
      for (int k = 0; k < 3; ++k)
        p[k] = transformPoint(instance.world_from_object, mesh.positions[mesh.triangles[t][k]]);
      for (const vec3& corner : p) triangles.boxes[first[i] + t].add(corner);
      triangles.all[first[i] + t] = {p[0], static_cast<std::uint32_t>(i), p[1], static_cast<std::uint32_t>(t), p[2], 0};
    });
  }
  return triangles;
}

/// Do rays of an octant of directions meet the second child first, going by the axis along which they lie farthest
/// apart?
bool meetsSecondFirst(const Bounds& first, const Bounds& second, std::uint32_t octant) {
  const vec3 apart = second.centre() - first.centre(), size = glm::abs(apart);
  const int axis = size.x >= size.y && size.x >= size.z ? 0 : size.y >= size.z ? 1 : 2;
  const bool backwards = (octant >> static_cast<unsigned>(axis) & 1U) != 0;
  return backwards != (apart[axis] < 0.0F);
}

/// Writes the nodes in the order that rays of one octant of directions walk them.
/// @param nodes  as many as the tree has
void writeOrder(const BoxTree& tree, std::uint32_t octant, std::span<TreeNode> nodes) {
  std::size_t next = 0;
  // Below it is written: what follows is where a walk that misses the node goes on.
  struct Task {
    std::uint32_t node;
    std::size_t written;
    bool done;
  };
  std::vector<Task> tasks;
  if (!tree.nodes.empty()) tasks.push_back({0, 0, false});
  while (!tasks.empty()) {
    const Task task = tasks.back();
    tasks.pop_back();
    if (task.done) {
      nodes[task.written].skip = static_cast<std::uint32_t>(next);
      continue;
    }
    const BoxTree::Node& node = tree.nodes[task.node];
    const vec3 margin = kBoxMargin * glm::max(glm::abs(node.box.lower), glm::abs(node.box.upper));
    const std::uint32_t leaf = node.isLeaf() ? node.first << 2U | node.count : kNowhere;
    nodes[next] = {node.box.lower - margin, 0, node.box.upper + margin, leaf};
    tasks.push_back({task.node, next++, true});
    if (node.isLeaf()) continue;
    const std::uint32_t first = task.node + 1, second = node.first;
    const bool turned = meetsSecondFirst(tree.nodes[first].box, tree.nodes[second].box, octant);
    tasks.push_back({turned ? first : second, 0, false});
    tasks.push_back({turned ? second : first, 0, false});
  }
}

}  // namespace

TreeTables makeTreeTables(const SceneData& scene, const BoxTreeBuilder& builder) {
  const Triangles triangles = placeTriangles(scene);
  const BoxTree tree = builder(triangles.boxes, kCosts);
  TreeTables tables;
  tables.triangles.resize(tree.primitives.size());
  parallelFor(tree.primitives.size(), [&](std::size_t i) { tables.triangles[i] = triangles.all[tree.primitives[i]]; });
  const std::size_t count = tree.nodes.size();
  tables.node_count = static_cast<std::uint32_t>(count);
  tables.order_count = triangles.all.size() <= kMaxOrdered ? 8 : 1;
  tables.nodes.resize(count * tables.order_count);
  parallelFor(tables.order_count, [&](std::size_t octant) {
    writeOrder(tree, static_cast<std::uint32_t>(octant), std::span(tables.nodes).subspan(octant * count, count));
  });
  return tables;
}

TriangleTree::TriangleTree(gpu::Device& device, gpu::CommandRecorder& recorder, const SceneData& scene,
                           const BoxTreeBuilder& builder) {
  const TreeTables tables = makeTreeTables(scene, builder);
  node_count_ = tables.node_count;
  order_count_ = tables.order_count;
  nodes_ = makeTable<TreeNode>(device, recorder, tables.nodes, "tree of triangles");
  triangles_ = makeTable<TreeTriangle>(device, recorder, tables.triangles, "triangles of the tree");
}

}  // namespace nephroid
