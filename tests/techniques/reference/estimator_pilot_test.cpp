// What `estimator=auto` picks, and that what it picks makes the same picture.
#include "techniques/reference/estimator_pilot.h"

#include <gtest/gtest.h>

#include <memory>

#include "scene/load.h"
#include "support/lid_scene.h"

namespace nephroid {
namespace {

using test::makeLid;
using test::makeSettings;

const Camera kAbove = makeCamera("above", vec3(2.0F, 4.5F, 3.0F), vec3(0, 0.5F, 0), radians(40));

SceneData underEvenSky(SceneData scene) {
  auto image = std::make_shared<Image>(8, 4, 3, 1.0F);
  scene.environment = Environment{image, 0.0F, 1.0F, "even"};
  return scene;
}

SceneData underLight(SceneData scene, Light light) {
  scene.lights.push_back(std::move(light));
  return scene;
}

/// Under an even sky light goes every way through the glass, and a path that leaves it meets the sky at once. What
/// clear glass shows is split and so costs paths that look for the sky more than those that gather photons; frosted
/// glass is not split.
SceneData makeFrostedGlassUnderSky() {
  SceneData scene = loadScene("builtin:cognac?light=env");
  for (Material& material : scene.materials)
    if (material.transmission > 0.0F) material.roughness = 0.35F;
  return scene;
}

PilotFigures measureThrough(const SceneData& scene, const Camera& camera) {
  ReferenceWorld world(scene, camera, 64, 48, ReferenceOptions{});
  return measureEstimators(world, camera, 64, 48, LayerNeeds({"caustic", "specular"}));
}

PilotFigures measure(const SceneData& scene) {
  ReferenceWorld world(scene, kAbove, 64, 64, ReferenceOptions{});
  return measureEstimators(world, kAbove, 64, 64, LayerNeeds({"caustic", "specular"}));
}

TEST(EstimatorFigures, PathsWinOnlyBeyondDoubt) {
  const EstimatorFigures sure{.photons = 0.1, .paths = 0.04, .contributions = 1000, .found = 1.0};
  EXPECT_TRUE(sure.pathsAreBetter());
  EstimatorFigures doubtful = sure;
  doubtful.paths = 0.06;
  EXPECT_FALSE(doubtful.pathsAreBetter()) << "hardly better";
  doubtful = sure, doubtful.contributions = 10;
  EXPECT_FALSE(doubtful.pathsAreBetter()) << "few have met the light";
  doubtful = sure, doubtful.found = 0.5;
  EXPECT_FALSE(doubtful.pathsAreBetter()) << "half of the light is missing";
  EXPECT_FALSE((EstimatorFigures{.photons = 0.1, .paths = 0.0}.pathsAreBetter())) << "no noise, for there is nothing";
}

TEST(EstimatorPilot, PrefersPathsForWhatIsSeenInFrostedGlassUnderASky) {
  const SceneData scene = makeFrostedGlassUnderSky();
  const PilotFigures figures = measureThrough(scene, scene.cameras[0]);
  ASSERT_TRUE(figures.specular_caustic);
  EXPECT_TRUE(figures.specular_caustic->pathsAreBetter())
      << figures.specular_caustic->photons << ' ' << figures.specular_caustic->paths << ' '
      << figures.specular_caustic->contributions << ' ' << figures.specular_caustic->found;
}

TEST(EstimatorPilot, LeavesSmallLightsToPhotonsAtOnce) {
  for (const float radius : {0.0F, 0.02F}) {
    const PilotFigures figures = measure(underLight(makeLid(), test::makePoint(vec3(0.5F, 4, 0.5F), vec3(9), radius)));
    EXPECT_FALSE(figures.caustic) << radius;
    EXPECT_FALSE(figures.specular_caustic) << radius;
  }
}

TEST(EstimatorPilot, LeavesALightWithoutSizeToPhotonsAlsoUnderASky) {
  const SceneData scene = underEvenSky(underLight(makeLid(), test::makePoint(vec3(0.5F, 4, 0.5F), vec3(9))));
  EXPECT_FALSE(measure(scene).specular_caustic);
}

TEST(EstimatorPilot, PutsCameraAndSeedBack) {
  const SceneData scene = underEvenSky(makeLid());
  ReferenceWorld world(scene, kAbove, 64, 48, ReferenceOptions{.seed = 77});
  measureEstimators(world, kAbove, 64, 48, LayerNeeds({"specular"}));
  EXPECT_EQ(world.options.seed, 77U);
  EXPECT_EQ(world.camera_model.width(), 64);
  EXPECT_EQ(world.camera_model.height(), 48);
}

RenderResult render(const char* estimator, std::uint64_t samples, int threads = 0, std::uint64_t seed = 1) {
  RenderSettings settings = makeSettings(24, samples, samples << 10, {"caustic", "specular", "indirect", "irradiance"});
  settings.width = 32;
  settings.params.set("estimator", estimator);
  settings.threads = threads;
  settings.seed = seed;
  const SceneData scene = makeFrostedGlassUnderSky();
  return test::renderReference(scene, scene.cameras[0], settings);
}

TEST(EstimatorChoice, DoesNotDependOnThreadsOrSeed) {
  const auto one = render("auto", 1, 1).image.metadata, three = render("auto", 1, 3).image.metadata,
             other = render("auto", 1, 1, 2).image.metadata;
  for (const char* key : {"estimator.caustic", "estimator.specular_caustic", "estimator.specular_caustic.measured"}) {
    EXPECT_EQ(one.at(key), three.at(key));
    EXPECT_EQ(one.at(key), other.at(key));
  }
}

// A footprint's blur is in no standard error. Next to direct light it counts for less than the noise it saves.
TEST(EstimatorChoice, BlursNoCausticWhoseOwnErrorIsEstimated) {
  const SceneData scene = makeFrostedGlassUnderSky();
  const auto choiceFor = [&](const std::vector<std::string>& layers, double target) {
    RenderSettings settings = makeSettings(16, 1, 1 << 10, layers);
    settings.target_error = target;
    return test::renderReference(scene, scene.cameras[0], settings).image.metadata.at("estimator.caustic");
  };
  EXPECT_EQ(choiceFor({"beauty", "beauty_error"}, 0.0), "footprint");
  EXPECT_EQ(choiceFor({"beauty"}, 0.1), "footprint");
  EXPECT_EQ(choiceFor({"caustic", "irradiance", "irradiance_error"}, 0.0), "footprint");
  EXPECT_EQ(choiceFor({"beauty", "caustic_error", "caustic"}, 0.0), "light");
  EXPECT_EQ(choiceFor({"caustic"}, 0.1), "light");
}

// What caustics light in turn is smooth: as a part of the whole picture it may be blurred, alone it is not.
TEST(EstimatorChoice, GathersIndirectLightWhereItIsAPartOfBeauty) {
  const SceneData scene = makeFrostedGlassUnderSky();
  const auto choiceFor = [&](const std::vector<std::string>& layers) {
    return test::renderReference(scene, scene.cameras[0], makeSettings(16, 1, 1 << 10, layers))
        .image.metadata.at("estimator.indirect");
  };
  EXPECT_EQ(choiceFor({"beauty"}), "photon-map");
  EXPECT_EQ(choiceFor({"indirect", "irradiance"}), "light");
  EXPECT_EQ(choiceFor({"beauty", "caustic", "caustic_error"}), "light");
}

TEST(EstimatorChoice, GatheredIndirectLightIsAsBrightAsThatOfPhotonsInPixels) {
  SceneData scene = test::makeBallScene(test::makeMetal(vec3(0.9F)), 48);
  test::addObject(scene, makeRectangle("wall", dvec3(-1.6, 2, 0), dvec3(0, 0, 4), dvec3(0, 2, 0)),
                  test::makeDiffuse(vec3(0.8F)));
  scene.lights.push_back(test::makePoint(vec3(1.5F, 1.6F, 0.2F), vec3(9.0F)));
  const Camera camera = makeCamera("wall", vec3(3.5F, 3.0F, 3.0F), vec3(-0.5F, 0.6F, 0), radians(45));
  const auto render = [&](const char* estimator) {
    RenderSettings settings = makeSettings(24, 64, 1 << 21, {"beauty", "indirect", "irradiance"});
    settings.params.set("estimator", estimator);
    return test::renderReference(scene, camera, settings);
  };
  const RenderResult gathered = render("auto"), seen = render("footprint");
  ASSERT_EQ(gathered.image.metadata.at("estimator.indirect"), "photon-map");
  for (const char* layer : {"indirect", "irradiance"}) {
    const double expected = test::meanOf(*seen.image.find(layer)).x;
    EXPECT_NEAR(test::meanOf(*gathered.image.find(layer)).x, expected, 0.01 * expected) << layer;
  }
}

// Paths for what is seen through glass, photons for the rest: each path is still counted once.
TEST(EstimatorChoice, OfBothKindsMakesThePictureOfOneAlone) {
  const RenderResult mixed = render("auto", 256), pure = render("footprint", 256);
  ASSERT_EQ(mixed.image.metadata.at("estimator.caustic"), "footprint");
  ASSERT_EQ(mixed.image.metadata.at("estimator.specular_caustic"), "path");
  ASSERT_EQ(pure.image.metadata.at("estimator.specular_caustic"), "photon-map");
  EXPECT_EQ(pure.image.metadata.count("estimator.specular_caustic.measured"), 0U);
  for (const Layer& layer : pure.image.layers) {
    const double expected = test::meanOf(layer.image).x;
    EXPECT_GT(expected, 0.0);
    EXPECT_NEAR(test::meanOf(*mixed.image.find(layer.name)).x, expected, 0.02 * expected) << layer.name;
  }
}

}  // namespace
}  // namespace nephroid
