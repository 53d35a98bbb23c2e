// Trees of boxes: each box is below one leaf and inside every node above it, whatever the boxes are.
#include "trace/box_tree_builder.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <random>

#include "core/parallel.h"

namespace nephroid {
namespace {

std::vector<Bounds> makeBoxes(std::size_t count, float size) {
  std::mt19937 random(7);
  std::uniform_real_distribution<float> unit(0.0F, 1.0F);
  std::vector<Bounds> boxes(count);
  for (Bounds& box : boxes) {
    box.lower = vec3(unit(random), 3.0F * unit(random), unit(random));
    box.upper = box.lower + size * vec3(unit(random), unit(random), unit(random));
  }
  return boxes;
}

bool holds(const Bounds& outer, const Bounds& inner) {
  return glm::all(glm::lessThanEqual(outer.lower, inner.lower)) &&
         glm::all(glm::lessThanEqual(inner.upper, outer.upper));
}

/// @param left_out  boxes that no leaf has
void expectTree(const BoxTree& tree, const std::vector<Bounds>& boxes, std::uint32_t max_leaf_size,
                std::size_t left_out = 0) {
  std::vector<int> found(boxes.size(), 0);
  std::vector<int> parents(tree.nodes.size(), 0);
  for (std::size_t i = 0; i < tree.nodes.size(); ++i) {
    const BoxTree::Node& node = tree.nodes[i];
    Bounds below;
    if (node.isLeaf()) {
      ASSERT_LE(node.count, max_leaf_size);
      ASSERT_LE(node.first + node.count, tree.primitives.size());
      for (std::uint32_t k = node.first; k < node.first + node.count; ++k) {
        ASSERT_LT(tree.primitives[k], boxes.size());
        ++found[tree.primitives[k]];
        below.add(boxes[tree.primitives[k]]);
      }
    } else {
      ASSERT_GT(node.first, i + 1);
      ASSERT_LT(node.first, tree.nodes.size());
      for (const std::size_t child : {i + 1, std::size_t{node.first}}) {
        ++parents[child];
        below.add(tree.nodes[child].box);
      }
    }
    // No smaller and no larger than what it holds, so that no ray that meets it is lost or led astray.
    ASSERT_TRUE(holds(node.box, below)) << i;
    ASSERT_TRUE(holds(below, node.box)) << i;
  }
  for (std::size_t i = 0; i < parents.size(); ++i) ASSERT_EQ(parents[i], i == 0 ? 0 : 1) << i;
  EXPECT_EQ(tree.primitives.size(), boxes.size() - left_out);
  for (const int times : found) ASSERT_LE(times, 1);
}

/// Expected cost of a ray through the root's box: the chance to meet each node times what it asks for.
double costOf(const BoxTree& tree, const BoxTreeCosts& costs) {
  const auto area = [](const Bounds& b) {
    const dvec3 d(b.extent());
    return d.x * d.y + d.y * d.z + d.z * d.x;
  };
  double sum = 0;
  for (const BoxTree::Node& node : tree.nodes)
    sum += area(node.box) * (static_cast<double>(costs.box) + node.count * static_cast<double>(costs.primitive));
  return sum / area(tree.nodes[0].box);
}

TEST(BoxTreeBuilder, EachBoxIsInOneLeafAndInsideAllAbove) {
  for (const std::uint32_t leaf : {1U, 3U, 8U})
    for (const std::size_t count : {1U, 2U, 3U, 4U, 9U, 100U, 20000U}) {
      SCOPED_TRACE(count);
      const std::vector<Bounds> boxes = makeBoxes(count, 0.02F);
      expectTree(buildBoxTree(boxes, {.max_leaf_size = leaf}), boxes, leaf);
    }
}

TEST(BoxTreeBuilder, NoBoxesMakeNoTree) {
  const BoxTree tree = buildBoxTree({}, {});
  EXPECT_TRUE(tree.nodes.empty());
  EXPECT_TRUE(tree.primitives.empty());
}

TEST(BoxTreeBuilder, ManyBoxesInOnePlaceAreHalved) {
  const std::vector<Bounds> boxes(1'000'000, Bounds{vec3(1, 2, 3), vec3(1, 2, 3)});
  expectTree(buildBoxTree(boxes, {.max_leaf_size = 3}), boxes, 3);
}

TEST(BoxTreeBuilder, BoxesOfAllSizesAreParted) {
  // A geometric series is the worst case of bins, which are even.
  std::vector<Bounds> boxes;
  for (int k = -40; k < 18; ++k)
    for (int copy = 0; copy < 50; ++copy) {
      const float at = std::pow(10.0F, static_cast<float>(k));
      boxes.push_back({vec3(at), vec3(at * 1.01F)});
    }
  boxes.back().upper = vec3(kMaxBoxCoordinate);
  expectTree(buildBoxTree(boxes, {.max_leaf_size = 2}), boxes, 2);
}

TEST(BoxTreeBuilder, BoxesWithoutAPlaceAreLeftOut) {
  constexpr float kNan = std::numeric_limits<float>::quiet_NaN();
  std::vector<Bounds> boxes = makeBoxes(100, 0.02F);
  boxes[3].upper.y = kNan;
  boxes[14].lower.x = kNan;
  boxes[15].upper.z = kInfinity;
  boxes[92].lower = vec3(-kInfinity);
  boxes[65] = Bounds();
  boxes[35].upper.x = 2.0F * kMaxBoxCoordinate;
  expectTree(buildBoxTree(boxes, {.max_leaf_size = 3}), boxes, 3, 6);
  EXPECT_TRUE(buildBoxTree(std::vector<Bounds>(5), {}).nodes.empty());
}

TEST(BoxTreeBuilder, TheSameBoxesMakeTheSameTreeOnAnyNumberOfThreads) {
  const std::vector<Bounds> boxes = makeBoxes(200'000, 0.01F);
  BoxTree trees[3];
  int i = 0;
  for (const int threads : {1, 2, 5})
    runWithThreads(threads, [&] { trees[i++] = buildBoxTree(boxes, {.max_leaf_size = 3}); });
  for (const BoxTree& tree : trees) {
    ASSERT_EQ(tree.primitives, trees[0].primitives);
    ASSERT_EQ(tree.nodes.size(), trees[0].nodes.size());
    for (std::size_t k = 0; k < tree.nodes.size(); ++k) {
      ASSERT_EQ(tree.nodes[k].box.lower, trees[0].nodes[k].box.lower);
      ASSERT_EQ(tree.nodes[k].box.upper, trees[0].nodes[k].box.upper);
      ASSERT_EQ(tree.nodes[k].first, trees[0].nodes[k].first);
      ASSERT_EQ(tree.nodes[k].count, trees[0].nodes[k].count);
    }
  }
}

TEST(BoxTreeBuilder, LeavesFollowTheCosts) {
  const std::vector<Bounds> boxes = makeBoxes(20'000, 0.02F);
  const BoxTreeCosts dear_boxes{.max_leaf_size = 8, .box = 4.0F, .primitive = 1.0F};
  const BoxTreeCosts dear_primitives{.max_leaf_size = 8, .box = 1.0F, .primitive = 4.0F};
  const BoxTree few = buildBoxTree(boxes, dear_boxes), many = buildBoxTree(boxes, dear_primitives);
  EXPECT_LT(few.nodes.size(), many.nodes.size());
  EXPECT_LT(costOf(many, dear_primitives), costOf(few, dear_primitives));
  // Halving by the order in which boxes come would leave each node nearly as large as the root.
  EXPECT_LT(costOf(many, dear_primitives), 500.0);
}

}  // namespace
}  // namespace nephroid
