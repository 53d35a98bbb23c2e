// What must not change, or must change in a known way, whatever the truth is.
#include <gtest/gtest.h>

#include <glm/gtc/matrix_transform.hpp>

#include "support/tiny_scenes.h"

namespace nephroid {
namespace {

using test::addObject;
using test::makeGlass;
using test::makeSettings;
using test::meanOf;
using test::relativeDifference;
using test::renderReference;

/// Sees the floor from the side, the ball's caustic in the middle.
Camera lookAtFloor(float scale = 1.0F, float mirror = 1.0F) {
  return makeCamera("floor", scale * vec3(mirror * 3.5F, 3.0F, 2.5F), scale * vec3(mirror * 0.5F, 0, 0.3F),
                    radians(50));
}

SceneData makeSunlitBall(Material material) {
  SceneData scene = test::makeBallScene(std::move(material), 128);
  scene.lights.push_back(test::makeSun(vec3(0.3F, -1, 0.1F), vec3(5.0F, 4.0F, 3.0F), 0.5F));
  return scene;
}

TEST(Identity, IndexOneLeavesDirectPlusCausticAsWithoutTheObject) {
  const SceneData with = makeSunlitBall(makeGlass(1.0F));
  SceneData without = with;
  without.instances.pop_back();
  const RenderResult a = renderReference(with, lookAtFloor(), makeSettings(48, 64, 2000000, {"direct", "caustic"}));
  const RenderResult b = renderReference(without, lookAtFloor(), makeSettings(48, 64, 0, {"direct"}));
  Image sum = *a.image.find("direct");
  const Image& caustic = *a.image.find("caustic");
  // Where the ball itself is seen, its own picture of the floor is `specular`: compare on the floor.
  double with_mean = 0.0, without_mean = 0.0;
  for (int y = 24; y < 48; ++y)
    for (int x = 0; x < 48; ++x)
      if (sum.rgb(x, y).x + caustic.rgb(x, y).x > 0.0F) {
        with_mean += sum.rgb(x, y).x + caustic.rgb(x, y).x;
        without_mean += b.image.find("direct")->rgb(x, y).x;
      }
  EXPECT_GT(meanOf(caustic).x, 0.02 * meanOf(sum).x);
  // At the silhouette pixels are half ball, half floor: they differ, and are 1 % of the picture.
  EXPECT_NEAR(with_mean / without_mean, 1.0, 0.01);
}

TEST(Identity, ThreadCountChangesNoPixel) {
  const SceneData scene = makeSunlitBall(makeGlass(1.5F));
  RenderSettings settings = makeSettings(40, 4, 300000, {"beauty", "caustic", "irradiance", "normal"});
  settings.threads = 1;
  const RenderResult one = renderReference(scene, lookAtFloor(), settings);
  for (const int threads : {2, 8}) {
    settings.threads = threads;
    const RenderResult many = renderReference(scene, lookAtFloor(), settings);
    for (std::size_t layer = 0; layer < one.image.layers.size(); ++layer)
      EXPECT_EQ(one.image.layers[layer].image.pixels, many.image.layers[layer].image.pixels)
          << one.image.layers[layer].name << " with " << threads;
    EXPECT_EQ(one.ledgers[0].deposited, many.ledgers[0].deposited);
  }
}

TEST(Identity, SeedsAreIndependentAndRepeatable) {
  const SceneData scene = makeSunlitBall(makeGlass(1.5F));
  RenderSettings settings = makeSettings(24, 2, 50000, {"beauty"});
  const Image first = renderReference(scene, lookAtFloor(), settings).image.layers[0].image;
  EXPECT_EQ(first.pixels, renderReference(scene, lookAtFloor(), settings).image.layers[0].image.pixels);
  settings.seed = 1;
  EXPECT_NE(first.pixels, renderReference(scene, lookAtFloor(), settings).image.layers[0].image.pixels);
}

TEST(Identity, TwoLightsAdd) {
  SceneData both = makeSunlitBall(makeGlass(1.5F));
  both.lights.push_back(test::makePoint(vec3(-2, 4, 1), vec3(20.0F, 10.0F, 30.0F), 0.3F));
  SceneData first = both, second = both;
  first.lights.pop_back();
  second.lights.erase(second.lights.begin());
  const auto render = [](const SceneData& s) {
    return renderReference(s, lookAtFloor(), makeSettings(16, 512, 2000000, {"direct", "caustic"}));
  };
  const RenderResult a = render(first), b = render(second), c = render(both);
  for (const char* layer : {"direct", "caustic"}) {
    Image sum = *a.image.find(layer);
    for (std::size_t i = 0; i < sum.pixels.size(); ++i) sum.pixels[i] += b.image.find(layer)->pixels[i];
    EXPECT_LT(relativeDifference(*c.image.find(layer), sum), 0.02) << layer;
    for (int channel = 0; channel < 3; ++channel)
      EXPECT_NEAR(meanOf(*c.image.find(layer))[channel] / meanOf(sum)[channel], 1.0, 0.004) << layer;
  }
}

TEST(Identity, ScaleOfTheSceneChangesNothingUnderASun) {
  const RenderSettings settings = makeSettings(24, 32, 400000, {"direct", "caustic", "irradiance"});
  Material glass = makeGlass(1.5F);
  glass.attenuation_color = vec3(0.3F, 0.6F, 0.9F);
  glass.attenuation_distance = 1.0F;
  const RenderResult reference = renderReference(makeSunlitBall(glass), lookAtFloor(), settings);
  for (const float scale : {0.01F, 100.0F}) {
    SceneData scaled = makeSunlitBall(glass);
    for (Instance& instance : scaled.instances) instance.world_from_object = glm::scale(mat4(1.0F), vec3(scale));
    for (Material& material : scaled.materials) material.attenuation_distance *= scale;
    const RenderResult result = renderReference(scaled, lookAtFloor(scale), settings);
    // The same numbers draw the same paths, but for rounding: far below the noise.
    for (const char* layer : {"direct", "caustic", "irradiance"})
      EXPECT_LT(relativeDifference(*result.image.find(layer), *reference.image.find(layer)), 0.02)
          << layer << ' ' << scale;
  }
}

TEST(Identity, MirroredSceneGivesTheMirroredPicture) {
  SceneData scene = makeSunlitBall(makeGlass(1.5F));
  SceneData mirrored = scene;
  for (Instance& instance : mirrored.instances) instance.world_from_object = glm::scale(mat4(1.0F), vec3(-1, 1, 1));
  mirrored.lights[0].direction.x = -mirrored.lights[0].direction.x;
  const RenderSettings settings = makeSettings(16, 512, 4000000, {"direct", "caustic"});
  const RenderResult a = renderReference(scene, lookAtFloor(), settings);
  const RenderResult b = renderReference(mirrored, lookAtFloor(1.0F, -1.0F), settings);
  for (const char* layer : {"direct", "caustic"}) {
    Image flipped = *b.image.find(layer);
    for (int y = 0; y < flipped.height; ++y)
      for (int x = 0; x < flipped.width; ++x) flipped.setRgb(x, y, b.image.find(layer)->rgb(flipped.width - 1 - x, y));
    EXPECT_LT(relativeDifference(flipped, *a.image.find(layer)), 0.02) << layer;
  }
}

}  // namespace
}  // namespace nephroid
