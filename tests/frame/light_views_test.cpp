// The mean over samples of a light's views against closed forms of the light itself, without shadows.
#include "frame/light_views.h"

#include <gtest/gtest.h>

#include <cmath>

#include "core/optics/lights.shared.h"
#include "support/tiny_scenes.h"

namespace nephroid {
namespace {

constexpr std::uint32_t kSamples = 4096;

/// As lights.glsl has it.
dvec3 irradianceOf(const LightRecord& light, vec3 place, vec3 normal) {
  if (light.kind == kLightDirectional)
    return dvec3(light.value) * static_cast<double>(std::max(-dot(light.direction, normal), 0.0F));
  const vec3 to_light = light.position - place;
  const vec3 dir = normalize(to_light);
  vec3 intensity = light.value;
  if (light.kind == kLightSpot) intensity *= spotFalloff(-dot(dir, light.direction), light.cos_inner, light.cos_outer);
  const float cos_surface = -dot(dir, light.normal);
  if (light.surface == kSurfaceFront) intensity *= std::max(cos_surface, 0.0F);
  if (light.surface == kSurfaceBoth) intensity *= std::abs(cos_surface);
  return dvec3(irradianceFromPoint(intensity, dot(to_light, to_light), dot(dir, normal)));
}

double meanIrradiance(const SceneData& scene, vec3 place, vec3 normal) {
  const LightViews views(scene, 7);
  dvec3 sum(0.0);
  for (std::uint32_t s = 0; s < kSamples; ++s)
    for (std::size_t i = 0; i < views.count(); ++i)
      if (const auto view = views.make(i, s)) sum += irradianceOf(view->light, place, normal);
  return sum.y / kSamples;
}

SceneData makeFloorScene() {
  SceneData scene;
  test::addObject(scene, test::makeFloor(4.0), test::makeDiffuse(vec3(0.5F)));
  return scene;
}

TEST(LightViews, PointsAndSpotsWithoutASizeAreThemselves) {
  SceneData scene = makeFloorScene();
  scene.lights.push_back(test::makePoint(vec3(0, 2, 0), vec3(8)));
  EXPECT_NEAR(meanIrradiance(scene, vec3(0), vec3(0, 1, 0)), 2.0, 1e-6);
  EXPECT_FALSE(LightViews(scene, 0).make(0, 5)->varies);
  Light& spot = scene.lights[0];
  spot.kind = LightKind::kSpot;
  spot.inner_cone = 0.1F, spot.outer_cone = 0.3F;
  EXPECT_NEAR(meanIrradiance(scene, vec3(0), vec3(0, 1, 0)), 2.0, 1e-6);
  EXPECT_EQ(meanIrradiance(scene, vec3(1, 0, 0), vec3(0, 1, 0)), 0.0);  // 26° off the axis
}

TEST(LightViews, ASphereShinesLikeAPointAtItsCentre) {
  // A sphere of uniform radiance I/(πr²), wholly above the plane of the receiver: E = I·cosθ/d², as for a point.
  SceneData scene = makeFloorScene();
  scene.lights.push_back(test::makePoint(vec3(0.5F, 2, 0), vec3(8), 0.4F));
  const double d2 = 4.25, expected = 8.0 * 2.0 / (d2 * std::sqrt(d2));
  EXPECT_NEAR(meanIrradiance(scene, vec3(0), vec3(0, 1, 0)), expected, 0.005 * expected);
}

TEST(LightViews, AWideSunKeepsItsIrradiance) {
  // Uniform over a disc of 10°, wholly above the horizon: the irradiance vector lies on the axis.
  SceneData scene = makeFloorScene();
  scene.lights.push_back(test::makeSun(vec3(1, -1, 0), vec3(10), 10.0F));
  EXPECT_NEAR(meanIrradiance(scene, vec3(0), normalize(vec3(-1, 1, 0))), 10.0, 0.01);
  EXPECT_NEAR(meanIrradiance(scene, vec3(0), vec3(0, 1, 0)), 10.0 / std::sqrt(2.0), 0.01);
}

TEST(LightViews, AnEmissiveSquareShinesByItsFormFactor) {
  // Above the middle of a square of side 2a at height h: E = 4L·(a/√(a²+h²))·atan(a/√(a²+h²)), four times the factor
  // of a corner.
  SceneData scene = makeFloorScene();
  Material lamp = test::makeDiffuse(vec3(0.0F));
  lamp.emission = vec3(3.0F);
  test::addObject(scene, makeRectangle("lamp", dvec3(0, 1, 0), dvec3(0.5, 0, 0), dvec3(0, 0, 0.5)), lamp);
  const double s = 0.5 / std::sqrt(0.25 + 1.0);
  const double expected = 3.0 * 4.0 * s * std::atan(s);
  EXPECT_NEAR(meanIrradiance(scene, vec3(0), vec3(0, 1, 0)), expected, 0.003 * expected);
}

TEST(LightViews, AnEvenEnvironmentGivesPiTimesItsRadiance) {
  SceneData scene = makeFloorScene();
  auto image = std::make_shared<Image>(16, 8, 3);
  for (int y = 0; y < 8; ++y)
    for (int x = 0; x < 16; ++x)
      for (int c = 0; c < 3; ++c) image->at(x, y)[c] = 0.5F;
  scene.environment = Environment{.radiance = image, .scale = 2.0F};
  EXPECT_NEAR(meanIrradiance(scene, vec3(0), normalize(vec3(1, 2, 0.3F))), static_cast<double>(kPi), 0.005 * kPi);
}

}  // namespace
}  // namespace nephroid
