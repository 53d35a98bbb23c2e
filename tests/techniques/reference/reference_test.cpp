// The reference against itself: two estimators that share little, layers that add up, a ledger that closes.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <memory>

#include "nephroid/error.h"
#include "support/block_means.h"
#include "support/lid_scene.h"
#include "support/tiny_scenes.h"
#include "techniques/layers.h"

namespace nephroid {
namespace {

using test::addObject;
using test::blockMeans;
using test::expectAgreement;
using test::expectNear;
using test::makeDiffuse;
using test::makeGlass;
using test::makeLamp;
using test::makeLampScene;
using test::makeMetal;
using test::makeSettings;
using test::renderReference;

Camera lookFromAbove() { return makeCamera("above", vec3(3.5F, 5.0F, 3.0F), vec3(0.3F, 0, 0.3F), radians(50)); }
class Estimators : public testing::TestWithParam<const char*> {
 protected:
  static Material material() {
    const std::string kind = GetParam();
    if (kind == "glass") return makeGlass(1.5F);
    if (kind == "rough_glass") return makeGlass(1.5F, 0.3F);
    if (kind == "metal") return makeMetal(vec3(0.9F, 0.7F, 0.4F));
    if (kind == "rough_metal") return makeMetal(vec3(0.9F, 0.7F, 0.4F), 0.4F);
    if (kind == "coloured_glass") {
      Material m = makeGlass(1.33F);
      m.attenuation_color = vec3(0.2F, 0.7F, 0.9F);
      m.attenuation_distance = 0.5F;
      return m;
    }
    if (kind == "dispersive_glass") {
      Material m = makeGlass(1.5F);
      m.dispersion = 2.0F;
      return m;
    }
    Material varnish = makeDiffuse(vec3(0.7F, 0.2F, 0.1F));
    varnish.roughness = 0.2F;
    return varnish;
  }
};

TEST_P(Estimators, LightTracingAndPathTracingAgree) {
  const SceneData scene = makeLampScene(material());
  RenderSettings from_lights = makeSettings(16, 1, 1 << 14, {"irradiance_caustic"});
  from_lights.params.set("estimator", "light");
  // A varnish returns 4 %: it takes more paths to see that well.
  const bool weak = std::string(GetParam()) == "varnish";
  RenderSettings from_eye = makeSettings(16, weak ? 1024 : 256, 0, {"irradiance_caustic"});
  from_eye.params.set("estimator", "path");
  expectAgreement(blockMeans(scene, from_lights, "irradiance_caustic"),
                  blockMeans(scene, from_eye, "irradiance_caustic"));
}

TEST_P(Estimators, FootprintsAndPhotonMapsAgreeWithLightTracing) {
  const SceneData scene = makeLampScene(material());
  RenderSettings light = makeSettings(16, 1, 1 << 16, {"irradiance_caustic"});
  RenderSettings footprint = light, photon_map = makeSettings(16, 8, 1 << 16, {"irradiance_caustic"});
  light.params.set("estimator", "light");
  footprint.params.set("estimator", "footprint");
  photon_map.params.set("estimator", "photon-map");
  const auto expected = blockMeans(scene, light, "irradiance_caustic");
  // Both blur, the less the more photons there are; on pictures of 16 × 16, whose blocks are four pixels wide, it
  // shows.
  expectNear(blockMeans(scene, footprint, "irradiance_caustic"), expected, 0.1, 0.02);
  expectNear(blockMeans(scene, photon_map, "irradiance_caustic"), expected, 0.1, 0.02);
}

INSTANTIATE_TEST_SUITE_P(Materials, Estimators,
                         testing::Values("glass", "rough_glass", "metal", "rough_metal", "coloured_glass",
                                         "dispersive_glass", "varnish"),
                         [](const auto& tested) { return std::string(tested.param); });

TEST(Reference, IndirectLightAgreesBetweenEstimators) {
  const SceneData scene = makeLampScene(makeMetal(vec3(0.9F)));
  SceneData with_wall = scene;
  addObject(with_wall, makeRectangle("wall", dvec3(-3, 2, 0), dvec3(0, 2, 0), dvec3(0, 0, 3)), makeDiffuse(vec3(0.8F)));
  RenderSettings from_lights = makeSettings(16, 64, 1 << 14, {"indirect"});
  RenderSettings from_eye = makeSettings(16, 128, 0, {"indirect"});
  from_eye.params.set("estimator", "path");
  expectAgreement(blockMeans(with_wall, from_lights, "indirect"), blockMeans(with_wall, from_eye, "indirect"));
}

TEST(Reference, CausticsThroughGlassAgreeBetweenPhotonsAndPaths) {
  // A slab over the floor: the lamp's light through it, seen through it. The kernel blurs, but the floor is evenly lit
  // where the camera looks, so the means agree to the noise and a few per cent of edge.
  SceneData scene;
  addObject(scene, test::makeFloor(8.0), makeDiffuse(vec3(0.6F)));
  addObject(scene, makeBox("slab", dvec3(-3, 0.5, -3), dvec3(3, 0.8, 3)), makeGlass(1.5F));
  addObject(scene, makeRectangle("lamp", dvec3(0, 4, 0), dvec3(2.5, 0, 0), dvec3(0, 0, 2.5)), makeLamp(vec3(5.0F)));
  RenderSettings photons = makeSettings(16, 64, 1 << 20, {"specular_caustic"});
  photons.params.set("estimator", "photon-map");
  RenderSettings paths = makeSettings(16, 2048, 0, {"specular_caustic"});
  paths.params.set("estimator", "path");
  const Camera camera = makeCamera("through", vec3(0.3F, 2.5F, 0.2F), vec3(0, 0, 0), radians(30));
  const double a = test::meanOf(renderReference(scene, camera, photons).image.layers[0].image).x;
  const double b = test::meanOf(renderReference(scene, camera, paths).image.layers[0].image).x;
  EXPECT_GT(b, 0.0);
  EXPECT_NEAR(a / b, 1.0, 0.03);
}

/// A slab of glass over a floor between two walls, under a lamp: most of what is seen through the slab is what the
/// light through it lights in turn.
SceneData makeLidScene() {
  SceneData scene = test::makeLid();
  addObject(scene, makeRectangle("lamp", dvec3(0, 4, 0), dvec3(2.0, 0, 0), dvec3(0, 0, 2.0)), makeLamp(vec3(5.0F)));
  return scene;
}

TEST(Reference, WhatCausticsLightSeenThroughGlassAgreesBetweenPhotonsAndPaths) {
  const SceneData scene = makeLidScene();
  const std::vector<std::string> layers{"specular", "specular_caustic"};
  RenderSettings photons = makeSettings(16, 64, 1 << 18, layers);
  photons.params.set("estimator", "photon-map");
  RenderSettings paths = makeSettings(16, 512, 0, layers);
  paths.params.set("estimator", "path");
  // Kernels lose what lies beyond the edges of the floor; the blocks along the walls show it most.
  expectNear(blockMeans(scene, photons, "specular"), blockMeans(scene, paths, "specular"), 0.04, 0.01);
}

TEST(Reference, WhatCausticsLightSeenThroughGlassIsTheSameWithAndWithoutIndirect) {
  // Where `indirect` is asked for every photon goes on after its first diffuse surface, else an eighth of them.
  const SceneData scene = makeLidScene();
  const auto meanOfSpecular = [&](std::vector<std::string> layers) {
    RenderSettings settings = makeSettings(16, 64, 1 << 20, std::move(layers));
    settings.params.set("estimator", "photon-map");
    return test::meanOf(*renderReference(scene, test::lookAtCaustic(), settings).image.find("specular")).x;
  };
  const double alone = meanOfSpecular({"specular"}), along = meanOfSpecular({"specular", "indirect"});
  EXPECT_NEAR(alone / along, 1.0, 0.01);
}

TEST(Reference, GlassMirrorsWithoutLeavingItToChance) {
  // A slab under a lamp over nothing, seen from above: the first face mirrors R, the second R as well, and so on:
  // R + T²R + T²R³ + … = 2R/(1 + R) in all. Each path must see the first two; by chance it would be one in thirteen.
  SceneData scene;
  addObject(scene, makeBox("slab", dvec3(-3, -0.5, -3), dvec3(3, 0, 3)), makeGlass(1.5F));
  addObject(scene, makeRectangle("lamp", dvec3(0, 4, 0), dvec3(2.5, 0, 0), dvec3(0, 0, 2.5)), makeLamp(vec3(5.0F)));
  const Camera down = makeCamera("down", vec3(0, 2, 0), vec3(0), radians(4));
  const RenderResult render = renderReference(scene, down, makeSettings(16, 1, 1, {"specular"}));
  const Image& image = render.image.layers[0].image;
  const double reflectance = 0.04, expected = 5.0 * 2.0 * reflectance / (1.0 + reflectance);
  double sum = 0.0, squares = 0.0;
  for (int y = 0; y < 16; ++y) {
    for (int x = 0; x < 16; ++x) {
      const double value = image.rgb(x, y).x / expected;
      sum += value / 256.0, squares += value * value / 256.0;
    }
  }
  EXPECT_NEAR(sum, 1.0, 0.03);
  EXPECT_LT(std::sqrt(squares - sum * sum), 0.15);
}

TEST(Reference, SunWithASizeAgreesBetweenEstimators) {
  SceneData scene = test::makeBallScene(makeMetal(vec3(0.9F)), 256);
  scene.lights.push_back(test::makeSun(vec3(-0.4F, -1, -0.2F), vec3(3.0F), 60.0F));
  RenderSettings from_eye = makeSettings(16, 256, 0, {"caustic"});
  from_eye.params.set("estimator", "path");
  RenderSettings from_lights = makeSettings(16, 1, 1 << 14, {"caustic"});
  from_lights.params.set("estimator", "footprint");
  expectAgreement(blockMeans(scene, from_lights, "caustic"), blockMeans(scene, from_eye, "caustic"));
}

TEST(Reference, EnvironmentAgreesBetweenEstimators) {
  SceneData scene = test::makeBallScene(makeGlass(1.5F), 256);
  auto image = std::make_shared<Image>(16, 8, 3, 0.5F);
  for (int x = 2; x < 7; ++x) image->setRgb(x, 2, vec3(20.0F, 10.0F, 5.0F));
  scene.environment = Environment{image, 20.0F, 1.0F, "test"};
  RenderSettings from_eye = makeSettings(16, 256, 0, {"caustic"});
  from_eye.params.set("estimator", "path");
  RenderSettings from_lights = makeSettings(16, 1, 1 << 15, {"caustic"});
  from_lights.params.set("estimator", "footprint");
  expectAgreement(blockMeans(scene, from_lights, "caustic"), blockMeans(scene, from_eye, "caustic"));
}

TEST(Reference, LayersSumToBeauty) {
  const SceneData scene = makeLampScene(makeGlass(1.5F));
  const RenderResult result =
      renderReference(scene, lookFromAbove(),
                      makeSettings(48, 16, 100000, parseLayerList("beauty,direct,caustic,specular,indirect,emission")));
  const Image& beauty = *result.image.find("beauty");
  ASSERT_GT(test::meanOf(beauty).x, 0.0);
  for (const char* name : {"direct", "caustic", "specular", "indirect"})
    EXPECT_GT(test::meanOf(*result.image.find(name)).x, 0.0) << name;
  for (std::size_t i = 0; i < beauty.pixels.size(); ++i) {
    float sum = 0.0F;
    for (const LayerInfo& info : layerInfos())
      if (info.summed) sum += result.image.find(info.name)->pixels[i];
    ASSERT_NEAR(beauty.pixels[i], sum, 1e-5F * std::abs(sum) + 1e-7F);
  }
}

TEST(Reference, LedgerClosesForEveryKindOfMaterialAndLight) {
  Material absorbing = makeGlass(1.5F);
  absorbing.attenuation_color = vec3(0.1F, 0.5F, 0.9F);
  absorbing.attenuation_distance = 1.0F;
  absorbing.dispersion = 1.0F;
  Material varnish = makeDiffuse(vec3(0.5F));
  varnish.roughness = 0.3F;
  for (const Material& material : {absorbing, varnish, makeMetal(vec3(0.9F, 0.6F, 0.3F)), makeGlass(1.5F, 0.4F)}) {
    SceneData scene = makeLampScene(material);
    scene.lights.push_back(test::makeSun(vec3(-0.4F, -1, -0.2F), vec3(3.0F), 0.5F));
    scene.lights.push_back(test::makePoint(vec3(2, 4, 1), vec3(9.0F, 5.0F, 1.0F)));
    const RenderResult result =
        renderReference(scene, lookFromAbove(), makeSettings(16, 1, 50000, {"caustic", "indirect", "specular"}));
    ASSERT_EQ(result.ledgers.size(), 3U);
    for (const Ledger& ledger : result.ledgers) {
      EXPECT_LE(ledger.residual(), 1e-5) << material.name << ' ' << ledger.light;
      const dvec3 roulette = ledger.roulette, error = ledger.rouletteStandardError();
      for (int c = 0; c < 3; ++c)
        EXPECT_LE(std::abs(roulette[c]), 4.5 * error[c] + 1e-6 * ledger.emitted[c]) << material.name;
    }
  }
}

// The flux of the sun through the ball's outline, 1.9e38 W, fits a float (3.4e38); times the weight of some wavelengths
// (up to about 3) it does not. The flux before that is what is lost. The camera looks away: no splat overflows, too.
TEST(Reference, LedgerClosesWhereFluxOverflows) {
  Material dispersive = makeGlass(1.5F);
  dispersive.dispersion = 1.0F;
  SceneData scene = test::makeBallScene(dispersive);
  scene.lights.push_back(test::makeSun(vec3(-0.4F, -1, -0.2F), vec3(6e37F)));
  const Camera away = makeCamera("away", vec3(0, 9, 0), vec3(0, 10, 0), radians(50));
  const RenderResult result = renderReference(scene, away, makeSettings(16, 1, 20000, {"caustic"}));
  ASSERT_EQ(result.ledgers.size(), 1U);
  const Ledger& ledger = result.ledgers[0];
  EXPECT_GT(ledger.emitted.x, 1e38);
  EXPECT_GT(result.stats.not_finite, 0U);
  const dvec3 lost = ledger.lost[static_cast<std::size_t>(LossReason::kNumerical)];
  for (int c = 0; c < 3; ++c) {
    EXPECT_GT(lost[c], 0.01 * ledger.emitted[c]);
    EXPECT_LT(lost[c], ledger.emitted[c]);
  }
  EXPECT_LE(ledger.residual(), 1e-5);
}

// What is emitted with a flux that is no number cannot be summed: it is counted only.
TEST(Reference, PhotonsEmittedWithoutFiniteFluxAreCountedAndNotLedgered) {
  SceneData scene = test::makeBallScene(makeGlass(1.5F));
  scene.lights.push_back(test::makeSun(vec3(-0.4F, -1, -0.2F), vec3(3e38F)));
  const RenderResult result = renderReference(scene, lookFromAbove(), makeSettings(16, 1, 1000, {"caustic"}));
  ASSERT_EQ(result.ledgers.size(), 1U);
  EXPECT_GT(result.ledgers[0].emitted_count, 0U);
  EXPECT_EQ(result.stats.not_finite, result.ledgers[0].emitted_count);
  EXPECT_EQ(result.ledgers[0].emitted, dvec3(0.0));
  EXPECT_EQ(result.ledgers[0].residual(), 0.0);
}

TEST(Reference, GeometryLayersSayWhatIsSeen) {
  const SceneData scene = test::makeBallScene(makeGlass(1.5F));
  const Camera down = makeCamera("down", vec3(0, 5, 0), vec3(0, 0, 0), radians(60));
  const RenderResult result =
      renderReference(scene, down, makeSettings(33, 1, 1, parseLayerList("albedo,normal,position,depth,id")));
  EXPECT_EQ(result.image.find("id")->at(16, 16)[0], 2.0F);
  EXPECT_EQ(result.image.find("id")->at(1, 1)[0], 1.0F);
  EXPECT_NEAR(result.image.find("depth")->at(16, 16)[0], 2.8F, 1e-3F);
  EXPECT_NEAR(result.image.find("depth")->at(1, 1)[0], 5.0F, 1e-3F);
  EXPECT_NEAR(result.image.find("normal")->rgb(16, 16).y, 1.0F, 1e-3F);
  EXPECT_NEAR(result.image.find("albedo")->rgb(1, 1).x, 0.6F, 1e-6F);
  EXPECT_NEAR(result.image.find("position")->rgb(1, 1).y, 0.0F, 1e-6F);
}

TEST(Reference, LayersAskedForAloneAreThoseOfAWholeRender) {
  // Even light of radiance 1 from all around, on a floor of albedo 0.6 and in its mirror image in a ball.
  SceneData scene = test::makeBallScene(makeMetal(vec3(0.9F)), 64);
  auto image = std::make_shared<Image>(8, 4, 3);
  std::fill(image->pixels.begin(), image->pixels.end(), 1.0F);
  scene.environment = Environment{image, 0.0F, 1.0F, "test"};
  const std::vector<std::string> names{"emission", "direct", "specular", "indirect", "irradiance"};
  const RenderResult whole = renderReference(scene, lookFromAbove(), makeSettings(16, 1024, 1 << 16, names));
  for (const std::string& name : names) {
    const RenderResult alone = renderReference(scene, lookFromAbove(), makeSettings(16, 1024, 1 << 16, {name}));
    const double expected = test::meanOf(*whole.image.find(name)).x;
    EXPECT_NEAR(test::meanOf(*alone.image.find(name)).x, expected, 0.01 * expected) << name;
  }
  SceneData floor;
  addObject(floor, test::makeFloor(8.0), makeDiffuse(vec3(0.6F)));
  floor.environment = scene.environment;
  const Camera down = makeCamera("down", vec3(0, 3, 0), vec3(0), radians(40));
  const RenderResult direct = renderReference(floor, down, makeSettings(8, 1024, 1, {"direct"}));
  EXPECT_NEAR(test::meanOf(direct.image.layers[0].image).x, 0.6, 0.002);
}

/// Of pixels of the layer `direct`, over independent renders.
struct DirectLight {
  double mean = 0.0, variance = 0.0;
};
constexpr int kDirectSize = 32, kDirectRenders = 16;
DirectLight measureDirect(const SceneData& scene, const std::vector<std::string>& layers) {
  std::vector<double> sums(kDirectSize * kDirectSize, 0.0), squares(sums);
  for (int seed = 1; seed <= kDirectRenders; ++seed) {
    RenderSettings settings = makeSettings(kDirectSize, 4, 1, layers);
    settings.seed = static_cast<std::uint64_t>(seed);
    const RenderResult render = renderReference(scene, lookFromAbove(), settings);
    for (std::size_t p = 0; p < sums.size(); ++p) {
      const double value = render.image.find("direct")->pixels[3 * p];
      sums[p] += value / kDirectRenders, squares[p] += value * value / kDirectRenders;
    }
  }
  DirectLight direct;
  for (std::size_t p = 0; p < sums.size(); ++p) {
    direct.mean += sums[p] / static_cast<double>(sums.size());
    direct.variance += (squares[p] - sums[p] * sums[p]) / static_cast<double>(sums.size());
  }
  return direct;
}

/// With `indirect` paths have one shadow ray at the floor, without it several.
/// @return its variance over the one beside other layers
double expectSameMeanAlone(const SceneData& scene) {
  const DirectLight alone = measureDirect(scene, {"direct"}),
                    with_others = measureDirect(scene, {"direct", "indirect"});
  const double error =
      std::sqrt((alone.variance + with_others.variance) / (kDirectRenders * kDirectSize * kDirectSize));
  EXPECT_NEAR(alone.mean, with_others.mean, 4.0 * error);
  return alone.variance / with_others.variance;
}

TEST(Reference, DirectLightAloneHasTheSameMeanAndLessNoise) {
  // The penumbra of a ball under a lamp.
  SceneData scene = test::makeBallScene(makeDiffuse(vec3(0.6F)), 64);
  scene.lights.push_back(test::makePoint(vec3(-0.5F, 5.0F, 0.3F), vec3(50.0F), 0.8F));
  scene.lights.push_back(test::makeSun(vec3(0.3F, -1, 0.1F), vec3(1.0F), 4.0F));
  EXPECT_LT(expectSameMeanAlone(scene), 0.5);
}

TEST(Reference, DirectLightOfASkyAloneHasTheSameMean) {
  // Found as often by ways on from the floor as by light samples.
  SceneData scene = test::makeBallScene(makeDiffuse(vec3(0.6F)), 64);
  scene.environment = Environment{std::make_shared<Image>(64, 32, 3, 1.0F), 0.0F, 1.0F, "even"};
  EXPECT_LT(expectSameMeanAlone(scene), 2.0) << "several ways on are followed here, too";
}

TEST(Reference, DirectLightOfOneSmallLampAloneHasTheSameMeanAndLessNoise) {
  // Such a lamp is looked for by light samples alone, and by several in the tiles that show penumbra. Outlines are as
  // noisy as before.
  SceneData scene = test::makeBallScene(makeDiffuse(vec3(0.6F)), 64);
  scene.lights.push_back(test::makePoint(vec3(-0.5F, 5.0F, 0.3F), vec3(50.0F), 0.4F));
  EXPECT_LT(expectSameMeanAlone(scene), 0.7);
}

TEST(Reference, DirectLightOfOneSmallLampTakesOneShadowRayOutsideOfPenumbrae) {
  // Nothing stands on the floor: a ray from the eye and one to the lamp, and three more in the quarter that looks
  // first.
  SceneData scene;
  test::addObject(scene, test::makeFloor(80.0), makeDiffuse(vec3(0.6F)));
  scene.lights.push_back(test::makePoint(vec3(-0.5F, 5.0F, 0.3F), vec3(50.0F), 0.05F));
  const RenderResult one = renderReference(scene, lookFromAbove(), makeSettings(32, 1, 1, {"direct"})),
                     four = renderReference(scene, lookFromAbove(), makeSettings(32, 4, 1, {"direct"}));
  EXPECT_EQ(one.stats.rays, 32U * 32U * 11U / 4U);
  EXPECT_EQ(four.stats.rays - one.stats.rays, 3U * 32U * 32U * 2U);
}

TEST(Reference, DirectLightOfOnePointTakesOneShadowRay) {
  SceneData scene;
  test::addObject(scene, test::makeFloor(80.0), makeDiffuse(vec3(0.6F)));
  scene.lights.push_back(test::makePoint(vec3(-0.5F, 5.0F, 0.3F), vec3(50.0F), 0.0F));
  EXPECT_EQ(renderReference(scene, lookFromAbove(), makeSettings(32, 1, 1, {"direct"})).stats.rays, 32U * 32U * 2U);
}

TEST(Reference, StopBeforeAnythingIsDoneIsInterruptedError) {
  const SceneData scene = makeLampScene(makeGlass(1.5F));
  StopToken stop;
  stop.request();
  EXPECT_THROW(
      findTechnique("reference").render(scene, lookFromAbove(), makeSettings(16, 4, 1000, {"beauty"}), nullptr, &stop),
      InterruptedError);
}

TEST(Reference, StopKeepsWhatWasReached) {
  // The first step emits photons, the second traces one path through each pixel.
  struct StopAfterSecond final : ProgressSink {
    void update(double, const std::string&) override {
      if (++count == 2) stop.request();
    }
    int count = 0;
    StopToken stop;
  } sink;
  const SceneData scene = makeLampScene(makeGlass(1.5F));
  const RenderResult result =
      findTechnique("reference")
          .render(scene, lookFromAbove(), makeSettings(16, 1000000, 1000, {"beauty"}), &sink, &sink.stop);
  EXPECT_TRUE(result.interrupted);
  EXPECT_EQ(result.stats.samples, 1U);
  EXPECT_GT(test::meanOf(result.image.layers[0].image).x, 0.0);
}

TEST(Reference, TimeEndsAProgressiveRender) {
  const SceneData scene = makeLampScene(makeGlass(1.5F));
  RenderSettings settings = makeSettings(16, 0, 0, {"beauty"});
  settings.seconds = 0.05;
  const RenderResult result = renderReference(scene, lookFromAbove(), settings);
  EXPECT_GT(result.stats.samples, 0U);
  EXPECT_GT(result.stats.photons, 0U);
}

}  // namespace
}  // namespace nephroid
