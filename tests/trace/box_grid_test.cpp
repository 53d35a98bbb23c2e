// Boxes by place: all that hold it, each once, and few others.
#include "trace/box_grid.h"

#include <gtest/gtest.h>

#include <random>

namespace nephroid {
namespace {

struct Corners {
  vec3 low, high;
  bool hold(vec3 at) const { return glm::all(glm::lessThanEqual(low, at)) && glm::all(glm::lessThanEqual(at, high)); }
};

/// As long as cells are wide at most, and flat as on a floor.
std::vector<Corners> makeBoxes(std::size_t count, float cell, unsigned seed) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<float> place(-1.0F, 1.0F), size(0.05F, 1.0F);
  std::vector<Corners> boxes;
  while (boxes.size() < count) {
    const vec3 middle(place(random), 0.03F * place(random), place(random));
    const vec3 half = 0.5F * cell * vec3(size(random), 0.3F * size(random), size(random));
    boxes.push_back({middle - half, middle + half});
  }
  return boxes;
}

BoxGrid makeGrid(const std::vector<Corners>& boxes, float cell, std::size_t promised) {
  BoxGrid grid(cell, promised);
  std::vector<BoxGrid::Entry> entries;
  for (std::uint32_t id = 0; id < boxes.size(); ++id) {
    BoxGrid::Box box(grid, id, boxes[id].low, boxes[id].high, entries);
    const glm::ivec3 first = grid.cellAt(boxes[id].low), last = grid.cellAt(boxes[id].high);
    glm::ivec3 cell_of_box;
    for (cell_of_box.x = first.x; cell_of_box.x <= last.x; ++cell_of_box.x)
      for (cell_of_box.y = first.y; cell_of_box.y <= last.y; ++cell_of_box.y)
        for (cell_of_box.z = first.z; cell_of_box.z <= last.z; ++cell_of_box.z) box.enter(cell_of_box);
  }
  // In two chunks, as of two tasks.
  const auto half = entries.begin() + static_cast<std::ptrdiff_t>(entries.size() / 2);
  const std::vector<std::vector<BoxGrid::Entry>> chunks{{entries.begin(), half}, {half, entries.end()}};
  grid.close(chunks);
  return grid;
}

/// Looks at places in and around the boxes. @return boxes that were visited in vain, over those that were not
double countIn(const std::vector<Corners>& boxes, const BoxGrid& grid, unsigned seed) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<float> place(-1.1F, 1.1F);
  double held = 0.0, in_vain = 0.0;
  for (int i = 0; i < 2000; ++i) {
    const vec3 at(place(random), 0.03F * place(random), place(random));
    std::vector<int> visits(boxes.size(), 0);
    grid.visitBoxesAt(at, [&](std::uint32_t id) { ++visits[id]; });
    for (std::size_t id = 0; id < boxes.size(); ++id) {
      const bool holds = boxes[id].hold(at);
      EXPECT_LE(visits[id], 1);
      EXPECT_GE(visits[id], holds ? 1 : 0);
      (holds ? held : in_vain) += visits[id];
    }
  }
  return in_vain / held;
}

TEST(BoxGrid, FindsAllBoxesThatHoldAPlaceOnceAndFewOthers) {
  constexpr float kCell = 0.2F;
  const std::vector<Corners> boxes = makeBoxes(1000, kCell, 1);
  // So many buckets that cells hardly share any: what is left is that sides are rounded.
  EXPECT_LT(countIn(boxes, makeGrid(boxes, kCell, 16 * boxes.size()), 2), 0.1);
}

TEST(BoxGrid, FindsThemWhereCellsShareBuckets) {
  // One bucket for all cells: whatever was said of each box in its cells is one entry.
  constexpr float kCell = 0.2F;
  const std::vector<Corners> boxes = makeBoxes(100, kCell, 3);
  countIn(boxes, makeGrid(boxes, kCell, 1), 4);
}

TEST(BoxGrid, HoldsItsOwnCorners) {
  // Corners round as places do: far from the origin, where steps of a float are a hundredth of a cell.
  constexpr float kCell = 0.01F;
  std::vector<Corners> boxes = makeBoxes(200, kCell, 5);
  for (Corners& box : boxes) box.low += 1000.0F, box.high += 1000.0F;
  const BoxGrid grid = makeGrid(boxes, kCell, boxes.size());
  for (std::uint32_t id = 0; id < boxes.size(); ++id)
    for (const vec3 corner : {boxes[id].low, boxes[id].high}) {
      bool found = false;
      grid.visitBoxesAt(corner, [&](std::uint32_t visited) { found |= visited == id; });
      EXPECT_TRUE(found) << id;
    }
}

TEST(BoxGrid, WithoutBoxesFindsNone) {
  BoxGrid grid(1.0F, 1);
  grid.close({});
  grid.visitBoxesAt(vec3(0.0F), [](std::uint32_t) { FAIL(); });
}

}  // namespace
}  // namespace nephroid
