#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "nephroid/error.h"
#include "support/gltf_builder.h"

namespace nephroid::gltf {
namespace {

using testing::Contains;
using testing::HasSubstr;
using testing_support::GltfBuilder;
using testing_support::json;

TEST(Nodes, MultiplyTheirTransformsDownTheTree) {
  GltfBuilder builder;
  const int child = builder.append("nodes", {{"mesh", builder.addTriangleMesh()}, {"translation", {1, 0, 0}}});
  builder.addNode({{"children", {child}}, {"scale", {2, 2, 2}}, {"translation", {0, 5, 0}}});
  const SceneData scene = builder.load();
  EXPECT_EQ(transformPoint(scene.instances.at(0).world_from_object, vec3(0)), vec3(2, 5, 0));
}

TEST(Nodes, ThatAreMirroredKeepTheirMesh) {
  GltfBuilder builder;
  const int mesh = builder.addTriangleMesh();
  builder.addNode({{"mesh", mesh}});
  builder.addNode({{"mesh", mesh}, {"scale", {-1, 1, 1}}});
  const SceneData scene = builder.load();
  ASSERT_EQ(scene.instances.size(), 2U);
  EXPECT_EQ(scene.meshes.size(), 1U);
  EXPECT_LT(glm::determinant(scene.instances[1].world_from_object), 0.0F);
}

TEST(Nodes, InACycleAreRefused) {
  GltfBuilder builder;
  builder.append("nodes", {{"children", {1}}});
  builder.append("nodes", {{"children", {0}}});
  EXPECT_THROW(builder.load(), InputError);
}

TEST(Nodes, WithTwoParentsAreRefused) {
  GltfBuilder builder;
  const int child = builder.append("nodes", json::object());
  builder.addNode({{"children", {child}}});
  builder.addNode({{"children", {child}}});
  EXPECT_THROW(builder.load(), InputError);
}

TEST(Nodes, ThatDoNotExistAreRefused) {
  GltfBuilder builder;
  builder.root["scenes"][0]["nodes"] = {3};
  EXPECT_THROW(builder.load(), InputError);
}

TEST(Nodes, MayNestDeeply) {
  GltfBuilder builder;
  const int mesh = builder.addTriangleMesh();
  constexpr int kDepth = 20000;
  for (int i = 1; i < kDepth; ++i) builder.append("nodes", {{"children", {i}}});
  builder.append("nodes", {{"mesh", mesh}});
  builder.root["scenes"][0]["nodes"] = {0};
  EXPECT_EQ(builder.load().instances.size(), 1U);
}

TEST(Nodes, FlattenedByTheirScaleAreSkippedWithAWarning) {
  GltfBuilder builder;
  builder.addNode({{"mesh", builder.addTriangleMesh()}, {"scale", {1, 0, 1}}});
  const SceneData scene = builder.load();
  EXPECT_TRUE(scene.instances.empty());
  EXPECT_THAT(scene.warnings, Contains(HasSubstr("flattened")));
}

TEST(Nodes, OfTinyScaleAreShown) {
  GltfBuilder builder;
  builder.addNode({{"mesh", builder.addTriangleMesh()}, {"scale", {1e-6, 1e-6, 1e-6}}});
  EXPECT_EQ(builder.load().instances.size(), 1U);
}

TEST(Nodes, OutsideTheSceneAreNotShown) {
  GltfBuilder builder;
  const int mesh = builder.addTriangleMesh();
  builder.append("nodes", {{"mesh", mesh}});
  builder.addNode({{"mesh", mesh}});
  EXPECT_EQ(builder.load().instances.size(), 1U);
}

TEST(Nodes, WithInstancingArePlacedOncePerElement) {
  GltfBuilder builder;
  const int mesh = builder.addTriangleMesh();
  const int places = builder.addVec3({{1, 0, 0}, {2, 0, 0}});
  builder.addNode({{"mesh", mesh},
                   {"translation", {0, 1, 0}},
                   {"extensions", {{"EXT_mesh_gpu_instancing", {{"attributes", {{"TRANSLATION", places}}}}}}}});
  const SceneData scene = builder.load();
  ASSERT_EQ(scene.instances.size(), 2U);
  EXPECT_EQ(vec3(scene.instances[1].world_from_object[3]), vec3(2, 1, 0));
  EXPECT_NE(scene.instances[0].object, scene.instances[1].object);
}

TEST(Cameras, LookAlongMinusZOfTheirNode) {
  GltfBuilder builder;
  builder.root["cameras"] = {
      {{"type", "orthographic"}, {"orthographic", {{"xmag", 1}, {"ymag", 2}, {"zfar", 9}, {"znear", 0}}}}};
  // A quarter turn about Y takes -Z to -X.
  const double h = std::sqrt(0.5);
  builder.addNode({{"name", "eye"}, {"camera", 0}, {"rotation", {0, h, 0, h}}, {"scale", {3, 3, 3}}});
  const Camera camera = builder.load().cameras.at(0);
  EXPECT_LT(length(camera.forward - vec3(-1, 0, 0)), 1e-6F);
  EXPECT_LT(length(camera.up - vec3(0, 1, 0)), 1e-6F);
  EXPECT_EQ(camera.ortho_height, 4.0F);
  EXPECT_EQ(camera.name, "eye");
}

/// One light on a node.
SceneData loadLight(const json& light) {
  GltfBuilder builder;
  builder.root["extensions"] = {{"KHR_lights_punctual", {{"lights", {light}}}}};
  builder.addNode(
      {{"name", "lamp"}, {"translation", {1, 2, 3}}, {"extensions", {{"KHR_lights_punctual", {{"light", 0}}}}}});
  return builder.load();
}

TEST(Lights, ArePlacedAndNamedByTheirNode) {
  const Light light =
      loadLight({{"type", "point"}, {"intensity", 5}, {"color", {1, 0.5, 0}}, {"extras", {{"radius", 0.1}}}})
          .lights.at(0);
  EXPECT_EQ(light.name, "lamp");
  EXPECT_EQ(light.kind, LightKind::kPoint);
  EXPECT_EQ(light.position, vec3(1, 2, 3));
  EXPECT_EQ(light.intensity, vec3(5, 2.5F, 0));
  EXPECT_FLOAT_EQ(light.radius, 0.1F);
}

TEST(Lights, ShineAlongMinusZ) {
  const Light sun = loadLight({{"type", "directional"}, {"extras", {{"angle", 0.53}}}}).lights.at(0);
  EXPECT_EQ(sun.direction, vec3(0, 0, -1));
  EXPECT_FLOAT_EQ(sun.angle_deg, 0.53F);
  const Light spot =
      loadLight({{"type", "spot"}, {"spot", {{"innerConeAngle", 0.2}, {"outerConeAngle", 0.3}}}}).lights.at(0);
  EXPECT_FLOAT_EQ(spot.inner_cone, 0.2F);
  EXPECT_FLOAT_EQ(spot.outer_cone, 0.3F);
}

TEST(Lights, WithARangeAreWarnedAbout) {
  EXPECT_THAT(loadLight({{"type", "point"}, {"range", 10}}).warnings, Contains(HasSubstr("range")));
}

}  // namespace
}  // namespace nephroid::gltf
