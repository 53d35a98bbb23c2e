#include "frame/triangle_tree.h"

#include <algorithm>
#include <span>

#include "core/math.h"
#include "core/parallel.h"
#include "frame/table.h"
#include "nephroid/error.h"

namespace nephroid {
namespace {

/// Of frame/triangle_tree.glsl.
constexpr std::uint32_t kCompactConstant = 20, kOrdersConstant = 25;
/// What a shader's turn of triangle_tree.glsl takes for each.
constexpr BoxTreeCosts kCosts{.max_leaf_size = 3, .box = 1.0F, .primitive = 1.0F};
/// More triangles than this have one order only, for the sake of memory.
constexpr std::size_t kMaxOrdered = 400'000;
/// Widening of boxes, relative to the coordinates: the rounding of a shader's test.
constexpr float kBoxMargin = 1.0F / 1048576.0F;
/// Cells of the grid along the scene's longest side; what is left of 2^16 takes the margins.
constexpr float kGridCells = 65'000.0F;
/// On the grid, a shader's rounding is less than this many cells.
constexpr float kGridMargin = 0.25F;
/// With what chance a ray meets the boxes that a walk asks for, at the most.
constexpr double kMostMet = 0.5;
/// Areas of boxes on the grid may be so many times those of the true ones, in the mean over all: as many more are met.
constexpr double kMaxGrowth = 1.25;

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

vec3 marginOf(const Bounds& box) { return kBoxMargin * glm::max(glm::abs(box.lower), glm::abs(box.upper)); }

/// The grid of compact nodes.
struct Grid {
  vec3 lower{0};
  float scale = 1.0F;

  explicit Grid(const Bounds& scene) {
    const vec3 extent = scene.extent();
    const float longest = std::max({extent.x, extent.y, extent.z});
    if (longest > 0.0F) scale = kGridCells / longest;
    lower = scene.lower - 0.5F * (kTreeGridEnd - kGridCells) / scale;
  }

  /// In cells, rounded outwards.
  Bounds place(const Bounds& box) const {
    const vec3 margin = marginOf(box);
    Bounds placed;
    placed.lower = glm::max(glm::floor((box.lower - margin - lower) * scale - kGridMargin), vec3(0.0F));
    placed.upper = glm::min(glm::ceil((box.upper + margin - lower) * scale + kGridMargin), vec3(kTreeGridEnd));
    return placed;
  }
};

/// Half the area of a box.
double halfAreaOf(vec3 extent) {
  const glm::dvec3 e(extent);
  return e.x * e.y + e.y * e.z + e.z * e.x;
}

/// How many times its true area a box has on the grid, in the mean: a ray meets it in proportion. Not of all areas
/// together, which those of a wide floor outweigh, while rays go from thing to thing.
double growthOn(const Grid& grid, const BoxTree& tree) {
  double sum = 0.0;
  // A cell's face more is no growth to speak of, and some boxes are lines.
  for (const BoxTree::Node& node : tree.nodes)
    sum += halfAreaOf(grid.place(node.box).extent()) / (halfAreaOf(node.box.extent() * grid.scale) + 1.0);
  return tree.nodes.empty() ? 1.0 : sum / static_cast<double>(tree.nodes.size());
}

/// Which nodes a walk asks for. A box is left out if a ray that met the next one around it meets it more often than
/// not, by their areas: then asking for its two children costs less.
std::vector<bool> chooseNodes(const BoxTree& tree) {
  std::vector<bool> kept(tree.nodes.size(), true);
  std::vector<double> around(tree.nodes.size(), double{kInfinity});  // half the area of the next box around a node
  for (std::size_t i = 0; i < tree.nodes.size(); ++i) {
    const BoxTree::Node& node = tree.nodes[i];
    if (node.isLeaf()) continue;
    const double area = halfAreaOf(node.box.extent());
    kept[i] = area <= kMostMet * around[i];
    around[i + 1] = around[node.first] = kept[i] ? area : around[i];
  }
  return kept;
}

/// Along directions of an octant: coordinates that fall are told the other way, from `end`.
Bounds mirror(const Bounds& box, std::uint32_t octant, float end) {
  Bounds mirrored = box;
  for (int axis = 0; axis < 3; ++axis)
    if ((octant >> static_cast<unsigned>(axis) & 1U) != 0) {
      mirrored.lower[axis] = end - box.upper[axis];
      mirrored.upper[axis] = end - box.lower[axis];
    }
  return mirrored;
}

TreeNode makeNode(const Bounds& box, std::uint32_t octant, std::uint32_t link) {
  const vec3 margin = marginOf(box);
  const Bounds placed = mirror({box.lower - margin, box.upper + margin}, octant, 0.0F);
  return {placed.lower, link, placed.upper, 0};
}

CompactTreeNode makeCompactNode(const Grid& grid, const Bounds& box, std::uint32_t octant, std::uint32_t link) {
  const Bounds placed = mirror(grid.place(box), octant, kTreeGridEnd);
  const uvec3 lower(placed.lower), upper(placed.upper);
  return {lower.x | lower.y << 16U, lower.z | upper.x << 16U, upper.y | upper.z << 16U, link};
}

/// Writes the nodes in the order that rays of one octant of directions walk them.
/// @param kept   of each node of the tree, whether it is written
/// @param nodes  as many as are
/// @param make   (box, octant, link) -> node
template <class Node, class Make>
void writeOrder(const BoxTree& tree, const std::vector<bool>& kept, std::uint32_t octant, std::span<Node> nodes,
                const Make& make) {
  std::uint32_t next = 0;
  // Below it is written: what follows is where a walk that misses the node goes on.
  struct Task {
    std::uint32_t node, written;
    bool done;
  };
  std::vector<Task> tasks;
  if (!tree.nodes.empty()) tasks.push_back({0, 0, false});
  while (!tasks.empty()) {
    const Task task = tasks.back();
    tasks.pop_back();
    if (task.done) {
      nodes[task.written].link = next;
      continue;
    }
    const BoxTree::Node& node = tree.nodes[task.node];
    if (kept[task.node]) {
      nodes[next] = make(node.box, octant, node.isLeaf() ? kTreeLeaf | node.first << 2U | node.count : 0U);
      if (!node.isLeaf()) tasks.push_back({task.node, next, true});
      ++next;
    }
    if (node.isLeaf()) continue;
    const std::uint32_t first = task.node + 1, second = node.first;
    const bool turned = meetsSecondFirst(tree.nodes[first].box, tree.nodes[second].box, octant);
    tasks.push_back({turned ? first : second, 0, false});
    tasks.push_back({turned ? second : first, 0, false});
  }
}

/// @param make  as above; @return  order by order
template <class Node, class Make>
std::vector<Node> writeOrders(const BoxTree& tree, const std::vector<bool>& kept, std::uint32_t orders,
                              const Make& make) {
  const auto count = static_cast<std::size_t>(std::ranges::count(kept, true));
  std::vector<Node> nodes(count * orders);
  parallelFor(orders, [&](std::size_t octant) {
    writeOrder(tree, kept, static_cast<std::uint32_t>(octant), std::span(nodes).subspan(octant * count, count), make);
  });
  return nodes;
}

}  // namespace

TreeTables makeTreeTables(const SceneData& scene, const BoxTreeBuilder& builder) {
  const Triangles triangles = placeTriangles(scene);
  const BoxTree tree = builder(triangles.boxes, kCosts);
  TreeTables tables;
  tables.triangles.resize(tree.primitives.size());
  parallelFor(tree.primitives.size(), [&](std::size_t i) { tables.triangles[i] = triangles.all[tree.primitives[i]]; });
  const std::vector<bool> kept = chooseNodes(tree);
  tables.node_count = static_cast<std::uint32_t>(std::ranges::count(kept, true));
  tables.order_count = triangles.all.size() <= kMaxOrdered ? 8 : 1;
  const Grid grid(tree.nodes.empty() ? Bounds{vec3(0.0F), vec3(0.0F)} : tree.nodes.front().box);
  tables.compact = growthOn(grid, tree) <= kMaxGrowth;
  if (tables.compact) {
    tables.grid_lower = grid.lower;
    tables.grid_scale = grid.scale;
    const auto make = [&](const Bounds& box, std::uint32_t octant, std::uint32_t link) {
      return makeCompactNode(grid, box, octant, link);
    };
    tables.compact_nodes = writeOrders<CompactTreeNode>(tree, kept, tables.order_count, make);
  } else {
    tables.nodes = writeOrders<TreeNode>(tree, kept, tables.order_count, makeNode);
  }
  return tables;
}

TriangleTree::TriangleTree(gpu::Device& device, gpu::CommandRecorder& recorder, const SceneData& scene,
                           const BoxTreeBuilder& builder) {
  const TreeTables tables = makeTreeTables(scene, builder);
  compact_ = tables.compact;
  has_orders_ = tables.order_count > 1;
  walk_ = {.nodes = tables.node_count, .grid_lower = tables.grid_lower, .grid_scale = tables.grid_scale};
  nodes_ = compact_ ? makeTable<CompactTreeNode>(device, recorder, tables.compact_nodes, "tree of triangles")
                    : makeTable<TreeNode>(device, recorder, tables.nodes, "tree of triangles");
  triangles_ = makeTable<TreeTriangle>(device, recorder, tables.triangles, "triangles of the tree");
}

std::vector<gpu::Constant> TriangleTree::constants() const {
  return {{kCompactConstant, compact_}, {kOrdersConstant, has_orders_}};
}

}  // namespace nephroid
