#include "scene/edit.h"

#include <gtest/gtest.h>

#include <cmath>

#include "nephroid/error.h"
#include "scene/edit_text.h"

namespace nephroid {
namespace {

/// Two instances of one mesh ("left", "right") and one of another ("lid"), all of material "steel"; material "sand"
/// unused.
SceneData makeScene() {
  SceneData scene;
  scene.materials.resize(2);
  scene.materials[0].name = "steel";
  scene.materials[1].name = "sand";
  Mesh mesh;
  mesh.positions = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
  mesh.triangles = {{0, 1, 2}};
  scene.meshes = {mesh, mesh};
  scene.instances.resize(3);
  scene.instances[0].name = "left";
  scene.instances[1].name = "right";
  scene.instances[2].name = "lid";
  scene.instances[2].mesh = 1;
  Light lamp;
  lamp.name = "lamp";
  lamp.intensity = vec3(4, 2, 1);
  scene.lights = {lamp};
  scene.cameras = {makeCamera("front", {0, 0, 5}, {0, 0, 0}, 0.5F), makeCamera("top", {0, 5, 0}, {0, 0, 0}, 0.5F)};
  return scene;
}

template <class Call>
std::string usageMessageOf(Call call) {
  try {
    call();
  } catch (const UsageError& error) {
    EXPECT_EQ(error.exitCode(), ExitCode::kUsage);
    return error.what();
  }
  return "not thrown";
}

TEST(Glob, StarsAndQuestionMarksMatchRuns) {
  EXPECT_TRUE(matchesGlob("*", ""));
  EXPECT_TRUE(matchesGlob("a*c", "abbbc"));
  EXPECT_TRUE(matchesGlob("a*b*c", "a-b-b-c"));
  EXPECT_TRUE(matchesGlob("?lass", "glass"));
  EXPECT_FALSE(matchesGlob("?lass", "lass"));
  EXPECT_FALSE(matchesGlob("a*c", "abbb"));
  EXPECT_FALSE(matchesGlob("glass", "Glass"));
  EXPECT_FALSE(matchesGlob("", "a"));
}

TEST(MaterialEdit, SetsEveryKeyOfAMaterialByName) {
  SceneData scene = makeScene();
  applyMaterialEdit(
      scene,
      "steel:ior=1.6,transmission=0.5,thickness=2,roughness=0.1,metallic=0.3,baseColor=0.1,0.2,0.3,abbe=40,"
      "attenuation=0.4,0.5,0.6,attenuationDistance=0.7,emission=1,2,3,specular=0.8,priority=5,eta=0.2,0.3,0.4,k=3,2,1");
  const Material& m = scene.materials[0];
  EXPECT_EQ(m.ior, 1.6F);
  EXPECT_EQ(m.transmission, 0.5F);
  EXPECT_EQ(m.thickness, 2.0F);
  EXPECT_EQ(m.roughness, 0.1F);
  EXPECT_EQ(m.metallic, 0.3F);
  EXPECT_EQ(vec3(m.base_color), vec3(0.1F, 0.2F, 0.3F));
  EXPECT_EQ(m.dispersion, 0.5F);
  EXPECT_EQ(m.attenuation_color, vec3(0.4F, 0.5F, 0.6F));
  EXPECT_EQ(m.attenuation_distance, 0.7F);
  EXPECT_EQ(m.emission, vec3(1, 2, 3));
  EXPECT_EQ(m.specular_factor, 0.8F);
  EXPECT_EQ(m.priority, 5);
  EXPECT_EQ(m.conductor_ior, vec3(0.2F, 0.3F, 0.4F));
  EXPECT_EQ(m.conductor_k, vec3(3, 2, 1));
  EXPECT_EQ(scene.materials[1].ior, 1.5F);
}

TEST(MaterialEdit, LeavesKeysThatAreNotGiven) {
  SceneData scene = makeScene();
  scene.materials[0].ior = 1.9F;
  applyMaterialEdit(scene, "*:roughness=0.25");
  EXPECT_EQ(scene.materials[0].ior, 1.9F);
  EXPECT_EQ(scene.materials[1].roughness, 0.25F);
}

TEST(MaterialEdit, ByNodeGivesThatNodeAMaterialOfItsOwn) {
  SceneData scene = makeScene();
  applyMaterialEdit(scene, "right:ior=1.8");
  EXPECT_EQ(scene.materialOf(scene.instances[1]).ior, 1.8F);
  EXPECT_EQ(scene.materialOf(scene.instances[0]).ior, 1.5F);
  EXPECT_EQ(scene.materialOf(scene.instances[2]).ior, 1.5F);
  EXPECT_NE(scene.instances[0].mesh, scene.instances[1].mesh);
}

TEST(MaterialEdit, ByNodeSharesWhatTheMatchedNodesShare) {
  SceneData scene = makeScene();
  applyMaterialEdit(scene, "?i*t:ior=1.8");  // "right"
  applyMaterialEdit(scene, "l*:ior=1.7");    // "left", "lid"
  EXPECT_EQ(scene.materialOf(scene.instances[0]).ior, 1.7F);
  EXPECT_EQ(scene.materialOf(scene.instances[1]).ior, 1.8F);
  EXPECT_EQ(scene.materialOf(scene.instances[2]).ior, 1.7F);
  EXPECT_EQ(scene.materials.size(), 4U);
}

TEST(MaterialEdit, NamesWhatThereIsWhenNothingMatches) {
  SceneData scene = makeScene();
  const std::string message = usageMessageOf([&] { applyMaterialEdit(scene, "gold:ior=1.5"); });
  EXPECT_NE(message.find("steel, sand"), std::string::npos) << message;
  EXPECT_NE(message.find("left, right, lid"), std::string::npos) << message;
}

TEST(MaterialEdit, RefusesSlips) {
  SceneData scene = makeScene();
  for (const char* edit : {"steel:iro=1.5", "steel:ior=-1", "steel:roughness=2", "steel", "steel:", ":ior=1",
                           "steel:ior", "steel:abbe=30,dispersion=1", "steel:k=1,1,1"})
    EXPECT_NE(usageMessageOf([&] { applyMaterialEdit(scene, edit); }), "not thrown") << edit;
  EXPECT_NE(usageMessageOf([&] { applyMaterialEdit(scene, "steel:iro=1.5"); }).find("ior"), std::string::npos);
}

TEST(ObjectEdit, TurnsAndScalesAboutTheObjectsOwnOrigin) {
  SceneData scene = makeScene();
  scene.instances[0].world_from_object[3] = vec4(5, 0, 0, 1);
  applyObjectEdit(scene, "left:translate=0,1,0,rotate=0,0,90,scale=2");
  const vec3 origin = transformPoint(scene.instances[0].world_from_object, vec3(0));
  const vec3 x = transformVector(scene.instances[0].world_from_object, vec3(1, 0, 0));
  EXPECT_NEAR(length(origin - vec3(5, 1, 0)), 0, 1e-6F);
  EXPECT_NEAR(length(x - vec3(0, 2, 0)), 0, 1e-6F);
  EXPECT_EQ(scene.instances[1].world_from_object, mat4(1.0F));
}

TEST(ObjectEdit, TurnsAboutXThenYThenZ) {
  SceneData scene = makeScene();
  applyObjectEdit(scene, "left:rotate=90,90,0");
  // +Y goes to +Z about X, then to +X about Y.
  const vec3 y = transformVector(scene.instances[0].world_from_object, vec3(0, 1, 0));
  EXPECT_NEAR(length(y - vec3(1, 0, 0)), 0, 1e-6F);
}

TEST(ObjectEdit, SwitchesCastingByPattern) {
  SceneData scene = makeScene();
  applyObjectEdit(scene, "l*:cast=false");
  EXPECT_FALSE(scene.instances[0].casts);
  EXPECT_TRUE(scene.instances[1].casts);
  EXPECT_FALSE(scene.instances[2].casts);
  EXPECT_NE(usageMessageOf([&] { applyObjectEdit(scene, "cup:cast=true"); }).find("left, right, lid"),
            std::string::npos);
}

TEST(LightEdit, ChangesMagnitudeAndColourApart) {
  SceneData scene = makeScene();
  applyLightEdit(scene, "lamp:intensity=8");
  EXPECT_EQ(scene.lights[0].intensity, vec3(8, 4, 2));
  applyLightEdit(scene, "lamp:color=1,1,0.5,position=1,2,3,radius=0.1");
  EXPECT_EQ(scene.lights[0].intensity, vec3(8, 8, 4));
  EXPECT_EQ(scene.lights[0].position, vec3(1, 2, 3));
  EXPECT_EQ(scene.lights[0].radius, 0.1F);
}

TEST(LightEdit, AddsASunAndThenChangesIt) {
  SceneData scene = makeScene();
  applyLightEdit(scene, "sun:azimuth=90,elevation=30,irradiance=5,angle=0.53");
  ASSERT_EQ(scene.lights.size(), 2U);
  EXPECT_EQ(scene.lights[1].kind, LightKind::kSun);
  EXPECT_NEAR(length(scene.lights[1].direction - vec3(-std::sqrt(0.75F), -0.5F, 0)), 0, 1e-6F);
  EXPECT_EQ(scene.lights[1].intensity, vec3(5));
  applyLightEdit(scene, "sun:elevation=60");
  ASSERT_EQ(scene.lights.size(), 2U);
  EXPECT_NEAR(length(scene.lights[1].direction - vec3(-0.5F, -std::sqrt(0.75F), 0)), 0, 1e-5F);
}

TEST(LightEdit, AddsASpotThatFacesTheScene) {
  SceneData scene = makeScene();
  applyLightEdit(scene, "spot:position=10,0.5,0,inner=10,outer=20");
  const Light& spot = scene.lights.back();
  EXPECT_EQ(spot.kind, LightKind::kSpot);
  EXPECT_NEAR(spot.direction.x, -1.0F, 1e-5F);
  EXPECT_NEAR(spot.outer_cone, radians(20), 1e-6F);
  EXPECT_THROW(applyLightEdit(scene, "spot:inner=30"), UsageError);
}

TEST(LightEdit, RemovesALight) {
  SceneData scene = makeScene();
  applyLightEdit(scene, "lamp:off");
  EXPECT_TRUE(scene.lights.empty());
  EXPECT_NE(usageMessageOf([&] { applyLightEdit(scene, "lamp:off"); }).find("lights: none"), std::string::npos);
}

TEST(LightEdit, RefusesKeysThatTheKindDoesNotHave) {
  SceneData scene = makeScene();
  EXPECT_NE(usageMessageOf([&] { applyLightEdit(scene, "lamp:irradiance=3"); }).find("give intensity"),
            std::string::npos);
  EXPECT_NE(usageMessageOf([&] { applyLightEdit(scene, "sun:position=1,2,3"); }).find("azimuth"), std::string::npos);
  EXPECT_NE(usageMessageOf([&] { applyLightEdit(scene, "lantern:intensity=3"); }).find("lamp"), std::string::npos);
}

TEST(SelectCamera, ByNameByIndexAndByPlace) {
  const SceneData scene = makeScene();
  EXPECT_EQ(selectCamera(scene, "top").eye, vec3(0, 5, 0));
  EXPECT_EQ(selectCamera(scene, "0").name, "front");
  const Camera placed = selectCamera(scene, "eye=1,2,3:target=1,2,0:fov=30:ortho=4");
  EXPECT_EQ(placed.eye, vec3(1, 2, 3));
  EXPECT_EQ(placed.forward, vec3(0, 0, -1));
  EXPECT_NEAR(placed.fov_y, radians(30), 1e-6F);
  EXPECT_EQ(placed.ortho_height, 4.0F);
  const Camera rolled = selectCamera(scene, "eye=0,0,3:target=0,0,0:up=1,1,0");
  EXPECT_NEAR(length(rolled.up - normalize(vec3(1, 1, 0))), 0, 1e-6F);
  EXPECT_EQ(rolled.ortho_height, 0.0F);
}

TEST(SelectCamera, ListsTheCamerasThereAre) {
  const SceneData scene = makeScene();
  for (const char* choice : {"side", "2", "-1"})
    EXPECT_NE(usageMessageOf([&] { selectCamera(scene, choice); }).find("front, top"), std::string::npos) << choice;
  for (const char* choice : {"target=0,0,0", "eye=0,0,0:target=0,0,0", "eye=0,0,3:target=0,0,0:up=0,0,1", "eye=1,2"})
    EXPECT_NE(usageMessageOf([&] { selectCamera(scene, choice); }), "not thrown") << choice;
}

}  // namespace
}  // namespace nephroid
