#include "scene/mesh_topology.h"

#include <gtest/gtest.h>

#include <array>

#include "scene/builtin/shapes.h"

namespace nephroid {
namespace {

std::array<vec3, 2> edgeOf(const Mesh& mesh, std::uint32_t triangle, int edge) {
  const uvec3 t = mesh.triangles[triangle];
  return {mesh.positions[t[edge]], mesh.positions[t[(edge + 1) % 3]]};
}

TEST(FindNeighbours, ShareTheEdgeInTheOtherSense) {
  for (const Mesh& mesh : {makeSphere("s", dvec3(0, 1, 0), 1.0, 16), makeBox("b", dvec3(-1), dvec3(1), 2)}) {
    const std::vector<uvec3> neighbours = findNeighbours(mesh);
    ASSERT_EQ(neighbours.size(), mesh.triangles.size());
    for (std::uint32_t t = 0; t < neighbours.size(); ++t)
      for (int edge = 0; edge < 3; ++edge) {
        const std::uint32_t beyond = neighbours[t][edge];
        ASSERT_LT(beyond, neighbours.size());
        bool shared = false;
        for (int other = 0; other < 3; ++other) {
          const auto mine = edgeOf(mesh, t, edge), its = edgeOf(mesh, beyond, other);
          shared = shared || (neighbours[beyond][other] == t && mine[0] == its[1] && mine[1] == its[0]);
        }
        EXPECT_TRUE(shared) << t << " " << edge;
      }
  }
}

TEST(FindNeighbours, EndAtOpenEdges) {
  const std::vector<uvec3> neighbours = findNeighbours(makeRectangle("r", dvec3(0), dvec3(0, 0, 1), dvec3(1, 0, 0)));
  ASSERT_EQ(neighbours.size(), 2U);
  int open = 0;
  for (const uvec3& n : neighbours)
    for (int edge = 0; edge < 3; ++edge) open += n[edge] == kNoNeighbour ? 1 : 0;
  EXPECT_EQ(open, 4);
}

TEST(FindNeighbours, EndWhereMoreThanTwoMeet) {
  Mesh mesh;
  mesh.positions = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}, {0, -1, 0}};
  mesh.triangles = {{0, 1, 2}, {1, 0, 3}, {0, 1, 4}};
  for (const uvec3& n : findNeighbours(mesh)) EXPECT_EQ(n, uvec3(kNoNeighbour));
}

}  // namespace
}  // namespace nephroid
