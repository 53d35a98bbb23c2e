// Vertex connection and merging against estimators that share little with it.
#include "techniques/reference/vcm/vcm.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "nephroid/error.h"
#include "support/block_means.h"

namespace nephroid {
namespace {

using test::addObject;
using test::blockMeans;
using test::makeDiffuse;
using test::makeGlass;
using test::makeLamp;
using test::makeMetal;
using test::renderReference;
using test::settingsOf;

/// The kernel blurs, the less the more photons there are; the whole is hardly touched.
constexpr double kOfBlock = 0.08, kOfWhole = 0.015;

struct Lighting {
  std::string name;
  Material material;
  /// Tests are listed by what is printed here.
  friend void PrintTo(const Lighting& lighting, std::ostream* out) { *out << lighting.name; }
  SceneData scene() const {
    if (name.ends_with("lamp")) return test::makeLampScene(material);
    SceneData scene = test::makeBallScene(material, 128);
    const vec3 towards(-0.4F, -1, -0.2F);
    if (name.ends_with("point")) scene.lights.push_back(test::makePoint(vec3(2, 4, 1), vec3(40.0F)));
    if (name.ends_with("sun")) scene.lights.push_back(test::makeSun(towards, vec3(3.0F)));
    if (name.ends_with("disc")) scene.lights.push_back(test::makeSun(towards, vec3(3.0F), 30.0F));
    if (name.ends_with("sky")) {
      auto image = std::make_shared<Image>(16, 8, 3, 0.5F);
      for (int x = 2; x < 7; ++x) image->setRgb(x, 2, vec3(20.0F, 10.0F, 5.0F));
      scene.environment = Environment{image, 20.0F, 1.0F, "test"};
    }
    return scene;
  }
};

class VcmCaustics : public testing::TestWithParam<Lighting> {};

TEST_P(VcmCaustics, AgreeWithLightTracing) {
  const SceneData scene = GetParam().scene();
  test::expectNear(blockMeans(scene, settingsOf("vcm", 16, 16, 1 << 17, {"caustic"}), "caustic"),
                   blockMeans(scene, settingsOf("light", 16, 1, 1 << 17, {"caustic"}), "caustic"), kOfBlock, kOfWhole);
}

Material makeVarnish() {
  Material varnish = makeDiffuse(vec3(0.7F, 0.2F, 0.1F));
  varnish.roughness = 0.2F;
  return varnish;
}

INSTANTIATE_TEST_SUITE_P(
    Scenes, VcmCaustics,
    testing::Values(Lighting{"glass_lamp", makeGlass(1.5F)}, Lighting{"rough_glass_lamp", makeGlass(1.5F, 0.3F)},
                    Lighting{"metal_lamp", makeMetal(vec3(0.9F, 0.7F, 0.4F))},
                    Lighting{"rough_metal_lamp", makeMetal(vec3(0.9F, 0.7F, 0.4F), 0.4F)},
                    Lighting{"varnish_lamp", makeVarnish()}, Lighting{"glass_point", makeGlass(1.5F)},
                    Lighting{"rough_glass_point", makeGlass(1.5F, 0.45F)}, Lighting{"glass_sun", makeGlass(1.5F)},
                    Lighting{"rough_metal_sun", makeMetal(vec3(0.9F), 0.4F)},
                    Lighting{"rough_metal_disc", makeMetal(vec3(0.9F), 0.4F)},
                    Lighting{"rough_glass_sky", makeGlass(1.5F, 0.3F)}),
    [](const auto& tested) { return tested.param.name; });

/// A slab over the floor: the lamp's light through it, seen through it.
class VcmThroughSlab : public testing::TestWithParam<float> {
 protected:
  static SceneData makeScene() {
    SceneData scene;
    addObject(scene, test::makeFloor(8.0), makeDiffuse(vec3(0.6F)));
    addObject(scene, makeBox("slab", dvec3(-3, 0.5, -3), dvec3(3, 0.8, 3)), makeGlass(1.5F, GetParam()));
    addObject(scene, makeRectangle("lamp", dvec3(0, 4, 0), dvec3(2.5, 0, 0), dvec3(0, 0, 2.5)), makeLamp(vec3(5.0F)));
    return scene;
  }
};

TEST_P(VcmThroughSlab, AgreesWithPaths) {
  const SceneData scene = makeScene();
  const Camera camera = makeCamera("through", vec3(0.3F, 2.5F, 0.2F), vec3(0, 0, 0), radians(30));
  const auto mean = [&](const RenderSettings& settings) {
    return test::meanOf(renderReference(scene, camera, settings).image.layers[0].image).x;
  };
  const double vcm = mean(settingsOf("vcm", 16, 256, 1 << 20, {"specular_caustic"}));
  const double paths = mean(settingsOf("path", 16, 8192, 0, {"specular_caustic"}));
  EXPECT_GT(paths, 0.0);
  EXPECT_NEAR(vcm / paths, 1.0, 0.015);
}
INSTANTIATE_TEST_SUITE_P(Roughness, VcmThroughSlab, testing::Values(0.0F, 0.3F, 0.45F));

TEST(Vcm, MakesTheOtherLayersAsTheyAre) {
  const SceneData scene = test::makeLampScene(makeGlass(1.5F));
  const std::vector<std::string> layers{"beauty", "direct", "caustic", "specular", "indirect", "emission"};
  const RenderResult vcm = renderReference(scene, test::lookAtCaustic(), settingsOf("vcm", 16, 64, 1 << 18, layers));
  const RenderResult light =
      renderReference(scene, test::lookAtCaustic(), settingsOf("light", 16, 64, 1 << 18, layers));
  // Layers that it has nothing to do with are the same to the last bit.
  EXPECT_EQ(vcm.image.find("direct")->pixels, light.image.find("direct")->pixels);
  for (const std::string& layer : layers) {
    const double expected = test::meanOf(*light.image.find(layer)).x;
    EXPECT_NEAR(test::meanOf(*vcm.image.find(layer)).x, expected, 0.03 * expected) << layer;
  }
  EXPECT_EQ(vcm.image.metadata.at("estimator.caustic"), "vcm");
  EXPECT_LE(vcm.ledgers.at(0).residual(), 1e-5);
}

TEST(Vcm, IsTheSameForAnyNumberOfThreads) {
  const SceneData scene = test::makeLampScene(makeGlass(1.5F, 0.3F));
  RenderSettings settings = settingsOf("vcm", 24, 4, 40'000, {"caustic", "specular_caustic", "irradiance"});
  settings.threads = 1;
  const RenderResult one = renderReference(scene, test::lookAtCaustic(), settings);
  settings.threads = 5;
  const RenderResult five = renderReference(scene, test::lookAtCaustic(), settings);
  for (std::size_t i = 0; i < one.image.layers.size(); ++i)
    EXPECT_EQ(one.image.layers[i].image.pixels, five.image.layers[i].image.pixels) << one.image.layers[i].name;
}

TEST(Vcm, RefusesWhatItCannotMake) {
  Material prism = makeGlass(1.5F);
  prism.dispersion = 1.0F;
  const auto render = [](const SceneData& scene, const RenderSettings& settings) {
    renderReference(scene, test::lookAtCaustic(), settings);
  };
  EXPECT_THROW(render(test::makeLampScene(prism), settingsOf("vcm", 8, 1, 1000, {"caustic"})), UsageError);
  EXPECT_THROW(render(test::makeLampScene(makeGlass(1.5F)), settingsOf("vcm", 8, 1, 1000, {"caustic_error"})),
               UsageError);
}

TEST(VcmSchedule, GivesEveryPassAsManyBatchesOfBoundedSize) {
  for (const std::uint64_t photons : {1000ULL, 2'000'000ULL, 10'000'000ULL}) {
    for (const std::uint64_t passes : {1ULL, 3ULL, 4096ULL}) {
      const VcmSchedule s = VcmSchedule::choose(passes, photons, 100);
      EXPECT_LE(s.batch_photons, PhotonBatch::kMaxPhotons);
      EXPECT_GE(s.batch_photons * s.batches_per_pass * passes, photons);
      EXPECT_LT(s.batch_photons * s.batches_per_pass * passes, photons + passes * (s.batches_per_pass + 1));
    }
  }
  EXPECT_EQ(VcmSchedule::choose(1ULL << 62, 0, 100'000).batch_photons, 100'000U);
}

}  // namespace
}  // namespace nephroid
