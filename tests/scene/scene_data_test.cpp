#include "scene/scene_data.h"

#include <gtest/gtest.h>

#include <cmath>

namespace nephroid {
namespace {

TEST(SigmaA, TransmitsTheColourAtTheAttenuationDistance) {
  Material material;
  material.attenuation_color = {0.25F, 0.5F, 1.0F};
  material.attenuation_distance = 0.1F;
  const vec3 sigma_a = material.sigmaA();
  for (int c = 0; c < 3; ++c) EXPECT_NEAR(std::exp(-sigma_a[c] * 0.1F), material.attenuation_color[c], 1e-6F);
  EXPECT_EQ(sigma_a.z, 0.0F);
}

TEST(SigmaA, IsZeroForAnInfiniteOrMissingDistance) {
  Material material;
  material.attenuation_color = vec3(0.0F);
  EXPECT_EQ(material.sigmaA(), vec3(0.0F));
  material.attenuation_distance = 0.0F;
  EXPECT_EQ(material.sigmaA(), vec3(0.0F));
}

TEST(SigmaA, StaysFiniteForBlack) {
  Material material;
  material.attenuation_color = vec3(0.0F);
  material.attenuation_distance = 1e-38F;
  EXPECT_TRUE(isFinite(material.sigmaA()));
  EXPECT_EQ(std::exp(-material.sigmaA().x * 1e-3F), 0.0F);
}

TEST(SceneBounds, FollowTheInstancesAndNotTheMeshes) {
  SceneData scene;
  scene.meshes.resize(2);
  scene.meshes[0].positions = {{0, 0, 0}, {1, 1, 1}, {1, 0, 0}};
  scene.meshes[0].triangles = {{0, 1, 2}};
  scene.meshes[1].positions = {{1000, 0, 0}};
  mat4 moved(1.0F);
  moved[3] = vec4(10, 0, 0, 1);
  scene.instances = {{"a", 0, mat4(1.0F), 0, true}, {"b", 0, moved, 1, true}};
  EXPECT_EQ(scene.bounds().lower, vec3(0, 0, 0));
  EXPECT_EQ(scene.bounds().upper, vec3(11, 1, 1));
  EXPECT_EQ(scene.triangleCount(), 2U);
  EXPECT_TRUE(SceneData().bounds().empty());
}

TEST(MakeCamera, LooksAtItsTargetUpright) {
  const Camera camera = makeCamera("c", {0, 1, 5}, {0, 1, 0}, 0.5F);
  EXPECT_EQ(camera.forward, vec3(0, 0, -1));
  EXPECT_EQ(camera.up, vec3(0, 1, 0));
  EXPECT_EQ(camera.ortho_height, 0.0F);
}

TEST(MakeCamera, HasANormalUpWhenLookingStraightDown) {
  const Camera camera = makeCamera("c", {0, 5, 0}, {0, 0, 0}, 0.5F);
  EXPECT_EQ(camera.forward, vec3(0, -1, 0));
  EXPECT_EQ(camera.up, vec3(0, 0, -1));
}

}  // namespace
}  // namespace nephroid
