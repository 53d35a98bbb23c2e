#include "scene/load.h"

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>

#include "nephroid/error.h"
#include "scene/classify.h"

namespace nephroid {
namespace {

std::string writeTemporary(const std::string& name, const std::string& content) {
  const std::string path = ::testing::TempDir() + "nephroid_load_" + name;
  std::ofstream(path, std::ios::binary) << content;
  return path;
}

template <class E>
std::string messageOf(const std::string& source) {
  try {
    loadScene(source);
  } catch (const E& error) {
    return error.what();
  }
  return "not thrown";
}

/// One triangle of the given material at height 3, nothing else.
SceneData makeBareScene(const Material& material) {
  SceneData scene;
  scene.materials = {material};
  Mesh mesh;
  mesh.positions = {{0, 3, 0}, {2, 3, 0}, {0, 4, 0}};
  mesh.triangles = {{0, 1, 2}};
  scene.meshes = {mesh};
  scene.instances = {Instance{}};
  return scene;
}

Material makeMetal() {
  Material m;
  m.metallic = 1;
  m.roughness = 0;
  return m;
}

TEST(LoadScene, BuildsBuiltinScenesAtATime) {
  const SceneData scene = loadScene("builtin:pool?segments=10", {.time = 2});
  EXPECT_EQ(scene.name, "builtin:pool?segments=10");
  const SceneData later = loadScene("builtin:pool?segments=10", {.time = 3});
  EXPECT_NE(scene.meshes[1].positions, later.meshes[1].positions);
}

TEST(LoadScene, UnknownBuiltinIsAUsageError) {
  EXPECT_NE(messageOf<UsageError>("builtin:rign").find("did you mean 'ring'"), std::string::npos);
}

TEST(LoadScene, MissingFileIsBadInputAndHintsAtTheBuiltinOfThatName) {
  EXPECT_NE(messageOf<InputError>("ring").find("builtin:ring"), std::string::npos);
  EXPECT_NE(messageOf<InputError>("/nowhere/x.glb").find("no such file"), std::string::npos);
}

TEST(LoadScene, BareMeshIsSentToTheObjectScene) {
  const std::string path = writeTemporary("mesh.PLY", "ply\n");
  EXPECT_NE(messageOf<UsageError>(path).find("builtin:object?mesh=" + path), std::string::npos);
  std::filesystem::remove(path);
}

TEST(LoadScene, FileOfAnotherKindIsBadInput) {
  const std::string path = writeTemporary("scene.txt", "hello");
  EXPECT_NE(messageOf<InputError>(path).find(".glb or .gltf"), std::string::npos);
  std::filesystem::remove(path);
}

TEST(CompleteScene, AddsSunFloorAndCameraAndSaysSo) {
  SceneData scene = makeBareScene(makeMetal());
  completeScene(scene);
  ASSERT_EQ(scene.lights.size(), 1U);
  EXPECT_EQ(scene.lights[0].kind, LightKind::kSun);
  EXPECT_NEAR(scene.lights[0].direction.y, -std::sqrt(0.5F), 1e-6F);
  EXPECT_EQ(scene.lights[0].intensity, vec3(10));
  ASSERT_EQ(scene.instances.size(), 2U);
  const Mesh& floor = scene.meshes[scene.instances[1].mesh];
  EXPECT_LT(floor.bounds().upper.y, 3.0F);
  EXPECT_GT(floor.bounds().lower.y, 2.9F);
  EXPECT_TRUE(classify(scene.materialOf(scene.instances[1])).is_receiver);
  EXPECT_EQ(scene.cameras.size(), 1U);
  EXPECT_EQ(scene.warnings.size(), 3U);
}

TEST(CompleteScene, LeavesACompleteSceneAlone) {
  SceneData scene = loadScene("builtin:cube");
  const std::size_t instances = scene.instances.size();
  completeScene(scene);
  EXPECT_EQ(scene.instances.size(), instances);
  EXPECT_EQ(scene.lights.size(), 1U);
  EXPECT_EQ(scene.cameras.size(), 1U);
  EXPECT_TRUE(scene.warnings.empty());
}

TEST(CompleteScene, CountsEmissionAndEnvironmentAsLight) {
  Material lamp = makeMetal();
  lamp.emission = vec3(1);
  SceneData scene = makeBareScene(lamp);
  completeScene(scene);
  EXPECT_TRUE(scene.lights.empty());
  SceneData outside = makeBareScene(makeMetal());
  outside.environment = Environment{};
  completeScene(outside);
  EXPECT_TRUE(outside.lights.empty());
}

TEST(CompleteScene, FloorModeDecides) {
  SceneData off = makeBareScene(makeMetal());
  completeScene(off, FloorMode::kOff);
  EXPECT_EQ(off.instances.size(), 1U);
  SceneData on = loadScene("builtin:cube");
  completeScene(on, FloorMode::kOn);
  EXPECT_EQ(on.instances.size(), 3U);
  EXPECT_EQ(on.instances.back().name, "floor 2");
}

TEST(CompleteScene, CameraSeesAllOfTheBounds) {
  SceneData scene = makeBareScene(makeMetal());
  completeScene(scene, FloorMode::kOff);
  const Camera& camera = scene.cameras[0];
  const vec3 right = cross(camera.forward, camera.up);
  for (const vec3 p : scene.meshes[0].positions) {
    const vec3 d = p - camera.eye;
    const float limit = std::tan(0.5F * camera.fov_y) * dot(d, camera.forward);
    EXPECT_LT(std::abs(dot(d, camera.up)), limit);
    EXPECT_LT(std::abs(dot(d, right)), limit);
  }
}

}  // namespace
}  // namespace nephroid
