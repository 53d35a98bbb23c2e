#include "scene/builtin/shapes.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <numbers>

#include "scene/mesh_topology.h"

namespace nephroid {
namespace {

void expectClosedSolid(const Mesh& mesh) {
  const MeshTopology topology = analyseMesh(mesh);
  EXPECT_TRUE(topology.closed()) << topology.open_edge_count << " open";
  EXPECT_EQ(topology.inconsistent_edge_count, 0U);
  EXPECT_EQ(topology.degenerate_count, 0U);
  EXPECT_EQ(topology.flipped_normal_count, 0U);
  EXPECT_GT(topology.volume, 0.0);
}

TEST(Shapes, SolidsAreClosedForAnyTessellation) {
  const std::array<dvec2, 4> quad{{{0, 0}, {2, 0}, {2.5, 1}, {0, 1}}};
  for (const int segments : {3, 4, 7, 32}) {
    SCOPED_TRACE(segments);
    expectClosedSolid(makeSphere("s", {0.1, 0.7, -3}, 0.123, segments));
    expectClosedSolid(makeBox("b", {-0.1, -0.3, 0.7}, {0.2, 0.1, 1.3}, segments));
    expectClosedSolid(makePrism("p", quad, -0.3, 0.9, segments));
    expectClosedSolid(makeBentRod("r", {0.3, 0.1, 0}, 0.5, 0.07, -1.1, 0.9, segments));
  }
  expectClosedSolid(makeBasin("basin", 3, 2, -0.5, 1.2, 0.2));
}

TEST(Shapes, BasinHoldsWhatItsSizesSay) {
  // Outer box minus inside: (3.4)(2.4)(1.9) − 3·2·1.7.
  EXPECT_NEAR(analyseMesh(makeBasin("basin", 3, 2, -0.5, 1.2, 0.2)).volume, 3.4 * 2.4 * 1.9 - 3 * 2 * 1.7, 1e-5);
}

TEST(Shapes, BentRodHasTheVolumeOfPappus) {
  // Area of the section × path of its centroid.
  const double exact = std::numbers::pi * 0.07 * 0.07 * 0.5 * 2.0;
  EXPECT_NEAR(analyseMesh(makeBentRod("r", {0, 0, 0}, 0.5, 0.07, -1, 1, 512)).volume, exact, 1e-3 * exact);
}

TEST(Shapes, RevolutionTurnsBezierProfilesSmoothly) {
  // A quarter arc and its mirror image: the normals where the pieces meet agree, so no vertex is doubled there.
  std::vector<ProfilePoint> profile;
  appendBezier(profile, {{0, -1}, {0.5523, -1}, {1, -0.5523}, {1, 0}}, 16);
  appendBezier(profile, {{1, 0}, {1, 0.5523}, {0.5523, 1}, {0, 1}}, 16);
  EXPECT_EQ(profile.size(), 33U);
  const Mesh mesh = makeRevolution("ball", profile, 64);
  expectClosedSolid(mesh);
  EXPECT_NEAR(analyseMesh(mesh).volume, 4.0 / 3.0 * std::numbers::pi, 0.02);
}

TEST(Shapes, RevolutionKeepsSharpEdgesSharp) {
  std::vector<ProfilePoint> profile;
  appendLine(profile, {0, 0}, {1, 0});
  appendLine(profile, {1, 0}, {1, 2});
  appendLine(profile, {1, 2}, {0, 2});
  const Mesh mesh = makeRevolution("can", profile, 16);
  expectClosedSolid(mesh);
  for (const vec3 n : mesh.normals) EXPECT_TRUE(std::abs(n.y) == 1.0F || n.y == 0.0F);
}

TEST(Shapes, RectangleFacesAlongTheCrossProduct) {
  const Mesh mesh = makeRectangle("r", {1, 2, 3}, {2, 0, 0}, {0, 0, -1});
  EXPECT_EQ(mesh.normals[0], vec3(0, 1, 0));
  EXPECT_EQ(mesh.bounds().extent(), vec3(4, 0, 2));
}

TEST(Shapes, BezierOffsetKeepsItsDistance) {
  const Bezier curve{{0, 0}, {1, 0}, {2, 1}, {2, 2}};
  for (const double t : {0.0, 0.3, 0.8, 1.0}) {
    EXPECT_NEAR(glm::distance(curve.at(t), curve.offsetAt(t, 0.1).position), 0.1, 1e-12);
    EXPECT_NEAR(glm::dot(curve.tangentAt(t), curve.offsetAt(t, 0.1).normal), 0.0, 1e-12);
  }
}

}  // namespace
}  // namespace nephroid
