// Trees as shaders walk them: a walk in any order that misses no box comes to every triangle, and what is in a leaf
// lies in the boxes of all nodes above it, on their grid or off it.
#include "frame/triangle_tree.h"

#include <gtest/gtest.h>

#include <array>
#include <set>

#include "scene/load.h"
#include "trace/box_tree_builder.h"

namespace nephroid {
namespace {

/// As fetchBox of frame/triangle_tree.glsl.
struct Box {
  vec3 lower, upper;
  std::uint32_t link = 0;
};

Box boxOf(const TreeTables& tables, std::size_t node) {
  if (!tables.compact) {
    const TreeNode& n = tables.nodes[node];
    return {n.lower, n.upper, n.link};
  }
  const CompactTreeNode& n = tables.compact_nodes[node];
  const std::uint32_t m = 0xFFFFU;
  return {vec3(uvec3(n.lower_xy & m, n.lower_xy >> 16U, n.lower_z_upper_x & m)),
          vec3(uvec3(n.lower_z_upper_x >> 16U, n.upper_yz & m, n.upper_yz >> 16U)), n.link};
}

/// @param octant  of directions along which the box is told
bool holds(const TreeTables& tables, std::uint32_t octant, const Box& box, vec3 corner) {
  vec3 placed = (corner - tables.grid_lower) * tables.grid_scale;
  for (int axis = 0; axis < 3; ++axis)
    if ((octant >> static_cast<unsigned>(axis) & 1U) != 0)
      placed[axis] = (tables.compact ? kTreeGridEnd : 0.0F) - placed[axis];
  return glm::all(glm::lessThanEqual(box.lower, placed)) && glm::all(glm::lessThanEqual(placed, box.upper));
}

/// Walks one order with every box met. @return  triangles that were found, by place in the table
std::set<std::uint32_t> walk(const TreeTables& tables, std::uint32_t order) {
  std::set<std::uint32_t> found;
  std::vector<std::pair<std::uint32_t, Box>> above;  // with where each ends
  for (std::uint32_t node = 0; node < tables.node_count; ++node) {
    const Box box = boxOf(tables, std::size_t{order} * tables.node_count + node);
    while (!above.empty() && above.back().first <= node) above.pop_back();
    if (box.link < kTreeLeaf) {
      EXPECT_GT(box.link, node);
      EXPECT_LE(box.link, tables.node_count);
      above.emplace_back(box.link, box);
      continue;
    }
    const std::uint32_t first = (box.link - kTreeLeaf) >> 2U, count = box.link & 3U;
    for (std::uint32_t i = first; i < first + count; ++i) {
      const TreeTriangle& t = tables.triangles[i];
      EXPECT_TRUE(found.insert(i).second);
      for (const vec3& corner : {t.a, t.b, t.c}) {
        EXPECT_TRUE(holds(tables, order, box, corner));
        for (const auto& [end, outer] : above) EXPECT_TRUE(holds(tables, order, outer, corner));
      }
    }
  }
  return found;
}

void expectWhole(const TreeTables& tables) {
  for (std::uint32_t order = 0; order < tables.order_count; ++order)
    EXPECT_EQ(walk(tables, order).size(), tables.triangles.size()) << "order " << order;
}

TEST(TriangleTreeTest, BoxesOnTheGridHoldWhatIsInThem) {
  const TreeTables tables = makeTreeTables(loadScene("builtin:sphere?segments=16"), buildBoxTree);
  EXPECT_TRUE(tables.compact);
  EXPECT_TRUE(tables.nodes.empty());
  EXPECT_EQ(tables.order_count, 8U);
  expectWhole(tables);
}

TEST(TriangleTreeTest, SmallThingsOnAWideFloorKeepTheirBoxes) {
  SceneData scene = loadScene("builtin:sphere?segments=16");
  for (Instance& instance : scene.instances)
    if (instance.name == "floor") instance.world_from_object = glm::scale(mat4(1.0F), vec3(1e5F));
  const TreeTables tables = makeTreeTables(scene, buildBoxTree);
  EXPECT_FALSE(tables.compact);
  EXPECT_TRUE(tables.compact_nodes.empty());
  expectWhole(tables);
}

TEST(TriangleTreeTest, LargeScenesHaveOneOrder) {
  const TreeTables tables = makeTreeTables(loadScene("builtin:sphere?segments=650"), buildBoxTree);
  EXPECT_EQ(tables.order_count, 1U);
  expectWhole(tables);
}

TEST(TriangleTreeTest, BoxesThatAreMostlyMetAreLeftOut) {
  const SceneData scene = loadScene("builtin:sphere?segments=16");
  std::size_t boxes = 0;
  const TreeTables tables = makeTreeTables(scene, [&](std::span<const Bounds> bounds, const BoxTreeCosts& costs) {
    BoxTree tree = buildBoxTree(bounds, costs);
    boxes = tree.nodes.size();
    return tree;
  });
  EXPECT_LT(tables.node_count, boxes);
  EXPECT_GT(2 * tables.node_count, boxes);  // the leaves alone are half of them
}

TEST(TriangleTreeTest, AnEmptySceneHasNone) {
  const TreeTables tables = makeTreeTables(SceneData{}, buildBoxTree);
  EXPECT_EQ(tables.node_count, 0U);
}

}  // namespace
}  // namespace nephroid
