// Walks on the specular manifold, with photons for the rest, against estimators that share little with them.
#include "techniques/reference/manifold/manifold.h"

#include <gtest/gtest.h>

#include "support/block_means.h"

namespace nephroid {
namespace {

using test::addObject;
using test::blockMeans;
using test::expectAgreement;
using test::makeGlass;
using test::makeLamp;
using test::makeMetal;
using test::renderReference;
using test::settingsOf;

Material makeColouredGlass() {
  Material m = makeGlass(1.33F);
  m.attenuation_color = vec3(0.2F, 0.7F, 0.9F);
  m.attenuation_distance = 0.5F;
  return m;
}
Material makeVarnish() {
  Material varnish = test::makeDiffuse(vec3(0.7F, 0.2F, 0.1F));
  varnish.roughness = 0.0F;
  return varnish;
}
Material makePrism() {
  Material prism = makeGlass(1.5F);
  prism.dispersion = 1.0F;
  return prism;
}

/// A slab above the floor and the camera.
SceneData makeRoof(const Material& material) {
  SceneData scene;
  addObject(scene, test::makeFloor(8.0), test::makeDiffuse(vec3(0.6F)));
  addObject(scene, makeBox("slab", dvec3(-6, 5, -6), dvec3(6, 5.5, 6)), material);
  return scene;
}

struct Lighting {
  std::string name;
  Material material;
  std::uint64_t samples, photons;
  friend void PrintTo(const Lighting& lighting, std::ostream* out) { *out << lighting.name; }
  SceneData scene() const {
    // Beside a ball of glass light is focused, and a test has power with many samples only: most glass is flat.
    const bool is_slab = name.starts_with("slab");
    if (name.ends_with("lamp") && !is_slab) return test::makeLampScene(material);
    SceneData scene = is_slab ? makeRoof(material) : test::makeBallScene(material, 128);
    const vec3 towards(-0.4F, -1, -0.2F);
    if (name.ends_with("lamp"))
      addObject(scene, makeRectangle("lamp", dvec3(0, 8, 0), dvec3(2, 0, 0), dvec3(0, 0, 2)), makeLamp(vec3(5.0F)));
    if (name.ends_with("overhead")) scene.lights.push_back(test::makePoint(vec3(1, 9, 1), vec3(90.0F), 0.8F));
    if (name.ends_with("star")) scene.lights.push_back(test::makePoint(vec3(1, 9, 1), vec3(90.0F)));
    if (name.ends_with("point")) scene.lights.push_back(test::makePoint(vec3(2, 4, 1), vec3(40.0F)));
    if (name.ends_with("bulb")) scene.lights.push_back(test::makePoint(vec3(2, 4, 1), vec3(40.0F), 0.8F));
    if (name.ends_with("sun")) scene.lights.push_back(test::makeSun(towards, vec3(3.0F)));
    if (name.ends_with("disc")) scene.lights.push_back(test::makeSun(towards, vec3(3.0F), 30.0F));
    if (name.ends_with("pair")) {
      // What one ball sends to the other takes three events and more.
      addObject(scene, makeSphere("other", dvec3(0.9, 1.0, 1.9), 0.6, 96), makeMetal(vec3(0.8F)));
      scene.lights.push_back(test::makeSun(towards, vec3(3.0F), 30.0F));
    }
    if (name.ends_with("sky")) {
      scene.environment = Environment{std::make_shared<Image>(16, 8, 3, 2.0F), 0.0F, 1.0F, "test"};
      scene.lights.push_back(test::makeSun(towards, vec3(3.0F), 30.0F));
    }
    return scene;
  }
};

class ManifoldCaustics : public testing::TestWithParam<Lighting> {};

TEST_P(ManifoldCaustics, AgreeWithLightTracing) {
  const SceneData scene = GetParam().scene();
  expectAgreement(
      blockMeans(scene, settingsOf("manifold", 16, GetParam().samples, GetParam().photons, {"irradiance_caustic"}),
                 "irradiance_caustic"),
      blockMeans(scene, settingsOf("light", 16, 1, 1 << 16, {"irradiance_caustic"}), "irradiance_caustic"));
}

INSTANTIATE_TEST_SUITE_P(Scenes, ManifoldCaustics,
                         testing::Values(Lighting{"metal_point", makeMetal(vec3(0.9F, 0.7F, 0.4F)), 16, 1 << 12},
                                         Lighting{"metal_sun", makeMetal(vec3(0.9F)), 16, 1 << 12},
                                         Lighting{"metal_bulb", makeMetal(vec3(0.9F)), 64, 1 << 12},
                                         Lighting{"metal_lamp", makeMetal(vec3(0.9F)), 64, 1 << 12},
                                         Lighting{"metal_pair", makeMetal(vec3(0.9F)), 64, 1 << 14},
                                         Lighting{"varnish_point", makeVarnish(), 64, 1 << 12},
                                         Lighting{"slab_star", makeGlass(1.5F), 16, 1 << 13},
                                         Lighting{"slab_lamp", makeColouredGlass(), 32, 1 << 13},
                                         Lighting{"slab_overhead", makeGlass(1.5F), 32, 1 << 13},
                                         Lighting{"slab_disc", makeGlass(1.33F), 32, 1 << 13},
                                         Lighting{"glass_disc", makeGlass(1.5F), 256, 1 << 13},
                                         Lighting{"glass_sky", makeGlass(1.5F), 64, 1 << 15},
                                         Lighting{"rough_glass_disc", makeGlass(1.5F, 0.3F), 1, 1 << 16},
                                         Lighting{"dispersive_glass_disc", makePrism(), 1, 1 << 16}),
                         [](const auto& tested) { return tested.param.name; });

/// A slab over the floor: light through it, seen through it.
SceneData makeSlabScene() {
  SceneData scene;
  addObject(scene, test::makeFloor(8.0), test::makeDiffuse(vec3(0.6F)));
  addObject(scene, makeBox("slab", dvec3(-3, 0.5, -3), dvec3(3, 0.8, 3)), makeGlass(1.5F));
  return scene;
}
Camera lookThroughSlab() { return makeCamera("through", vec3(0.3F, 2.5F, 0.2F), vec3(0, 0, 0), radians(30)); }

TEST(Manifold, AgreesWithPathsThroughASlab) {
  SceneData scene = makeSlabScene();
  addObject(scene, makeRectangle("lamp", dvec3(0, 4, 0), dvec3(2.5, 0, 0), dvec3(0, 0, 2.5)), makeLamp(vec3(5.0F)));
  const auto mean = [&](const RenderSettings& settings) {
    return test::meanOf(renderReference(scene, lookThroughSlab(), settings).image.layers[0].image).x;
  };
  const double walks = mean(settingsOf("manifold", 16, 1024, 1 << 18, {"specular_caustic"}));
  const double paths = mean(settingsOf("path", 16, 8192, 0, {"specular_caustic"}));
  EXPECT_GT(paths, 0.0);
  EXPECT_NEAR(walks / paths, 1.0, 0.015);
}

TEST(Manifold, SeesThroughAPaneWhatIsBehindIt) {
  // A pane between light and ball is no event, and takes as much from walks as from photons.
  SceneData scene = test::makeBallScene(makeMetal(vec3(0.9F)), 128);
  Material pane = makeGlass(1.5F);
  pane.thickness = 0.0F;
  pane.base_color = vec4(0.5F, 0.5F, 0.5F, 1.0F);
  addObject(scene, makeRectangle("pane", dvec3(0, 3, 0), dvec3(4, 0, 0), dvec3(0, 0, 4)), pane);
  scene.lights.push_back(test::makePoint(vec3(2, 4, 1), vec3(40.0F)));
  expectAgreement(blockMeans(scene, settingsOf("manifold", 16, 16, 1 << 15, {"caustic"}), "caustic"),
                  blockMeans(scene, settingsOf("light", 16, 1, 1 << 16, {"caustic"}), "caustic"));
}

TEST(Manifold, MakesTheOtherLayersAsTheyAre) {
  const SceneData scene = test::makeLampScene(makeMetal(vec3(0.9F)));
  const std::vector<std::string> layers{"beauty", "direct", "caustic", "specular", "indirect", "emission"};
  const auto render = [&](const char* estimator) {
    return renderReference(scene, test::lookAtCaustic(), settingsOf(estimator, 16, 64, 1 << 18, layers));
  };
  const RenderResult walks = render("manifold"), light = render("light");
  // Layers that it has nothing to do with are the same to the last bit.
  for (const char* layer : {"direct", "indirect"})
    EXPECT_EQ(walks.image.find(layer)->pixels, light.image.find(layer)->pixels) << layer;
  for (const std::string& layer : layers) {
    const double expected = test::meanOf(*light.image.find(layer)).x;
    EXPECT_NEAR(test::meanOf(*walks.image.find(layer)).x, expected, 0.03 * expected) << layer;
  }
  EXPECT_EQ(walks.image.metadata.at("estimator.caustic"), "manifold");
  EXPECT_EQ(walks.image.metadata.at("estimator.specular_caustic"), "manifold");
  EXPECT_LE(walks.ledgers.at(0).residual(), 1e-5);
}

TEST(Manifold, IsTheSameForAnyNumberOfThreads) {
  const SceneData scene = test::makeLampScene(makeGlass(1.5F));
  RenderSettings settings = settingsOf("manifold", 24, 4, 40'000, {"caustic", "specular_caustic", "irradiance"});
  settings.threads = 1;
  const RenderResult one = renderReference(scene, test::lookAtCaustic(), settings);
  settings.threads = 5;
  const RenderResult five = renderReference(scene, test::lookAtCaustic(), settings);
  for (std::size_t i = 0; i < one.image.layers.size(); ++i)
    EXPECT_EQ(one.image.layers[i].image.pixels, five.image.layers[i].image.pixels) << one.image.layers[i].name;
}

TEST(Manifold, StatesItsStandardErrors) {
  // The spread of independent renders is what a render says of itself.
  const SceneData scene = test::makeLampScene(makeMetal(vec3(0.9F)));
  double said = 0.0, spread = 0.0;
  std::vector<Image> images;
  for (int s = 0; s < 8; ++s) {
    RenderSettings settings = settingsOf("manifold", 16, 64, 1 << 16, {"caustic", "caustic_error"});
    settings.seed = static_cast<std::uint64_t>(s);
    RenderResult result = renderReference(scene, test::lookAtCaustic(), settings);
    for (const float error : result.image.find("caustic_error")->pixels) said += error * error / 8.0;
    images.push_back(*result.image.find("caustic"));
  }
  for (std::size_t i = 0; i < images[0].pixels.size(); ++i) {
    std::vector<double> values;
    for (const Image& image : images) values.push_back(image.pixels[i]);
    spread += 8.0 * test::momentsOf(values).variance_of_mean;
  }
  // Points that are well spread err less than the spread of their batches; eight renders know their own to a tenth.
  EXPECT_GT(said / spread, 0.8);
  EXPECT_LT(said / spread, 2.0);
}

}  // namespace
}  // namespace nephroid
