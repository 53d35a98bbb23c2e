// The technique `none`, drawn by whatever Vulkan device there is.
#include "techniques/none/none.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstdlib>
#include <filesystem>

#include "nephroid/error.h"
#include "scene/edit.h"
#include "scene/load.h"
#include "support/scratch_folder.h"
#include "support/tiny_scenes.h"
#include "techniques/layers.h"
#include "trace/camera_model.h"

namespace nephroid::test {
namespace {

using ::testing::Contains;
using ::testing::HasSubstr;

/// Every render looks over its own shoulder, and none writes into the user's folders.
class None : public ::testing::Test {
 protected:
  static void SetUpTestSuite() {
    cache_ = std::make_unique<testing::ScratchFolder>();
    setenv("NEPHROID_VALIDATION", "1", 1);
    setenv("XDG_CACHE_HOME", (*cache_ / "cache").c_str(), 1);
  }
  static void TearDownTestSuite() {
    unsetenv("NEPHROID_VALIDATION");
    unsetenv("XDG_CACHE_HOME");
    cache_.reset();
  }

  static RenderSettings makeSettings(int width, int height, std::uint64_t samples, std::vector<std::string> layers) {
    RenderSettings settings;
    settings.width = width;
    settings.height = height;
    settings.samples = samples;
    settings.layers = std::move(layers);
    settings.params = ParamSet(findTechnique("none").params);
    settings.params.set("shadow-size", "128");
    return settings;
  }

  static RenderResult render(const SceneData& scene, const Camera& camera, const RenderSettings& settings,
                             ProgressSink* progress = nullptr, const StopToken* stop = nullptr) {
    return findTechnique("none").render(scene, camera, settings, progress, stop);
  }

  static SceneData loadRing() {
    SceneData scene = loadScene("builtin:ring", {});
    completeScene(scene, FloorMode::kAuto);
    return scene;
  }

  static inline std::unique_ptr<testing::ScratchFolder> cache_;
};

std::vector<std::string> allLayers() {
  std::vector<std::string> names;
  for (const LayerInfo& layer : layerInfos()) names.emplace_back(layer.name);
  return names;
}

/// Radiance of a Lambertian surface under a point light, in the middle of each pixel.
class LitFloor {
 public:
  static constexpr float kAlbedo = 0.6F;
  const vec3 light_position{0.7F, 1.3F, -0.4F}, intensity{3.0F, 5.0F, 7.0F};

  LitFloor() {
    addObject(scene, makeFloor(20.0), makeDiffuse(vec3(kAlbedo)));
    scene.lights.push_back(makePoint(light_position, intensity));
    camera.eye = vec3(0.5F, 4.0F, 1.0F);
    camera.forward = normalize(vec3(0.1F, -1.0F, -0.3F));
    camera.up = normalize(cross(cross(camera.forward, vec3(0, 0, -1)), camera.forward));
  }

  vec3 radianceAt(int x, int y, int width, int height) const {
    const Ray ray = CameraModel(camera, width, height).rayThrough(vec2(x, y) + 0.5F);
    const dvec3 origin(ray.origin), dir(ray.dir);
    const dvec3 to_light = dvec3(light_position) - (origin - dir * (origin.y / dir.y));
    const double squared = dot(to_light, to_light);
    const double cosine = to_light.y / std::sqrt(squared);
    return vec3(dvec3(intensity) * (cosine / squared * static_cast<double>(kAlbedo) / glm::pi<double>()));
  }

  SceneData scene;
  Camera camera;
};

TEST_F(None, YieldsTheLayersAskedForAndLeavesTheRestBlackAndNoted) {
  const SceneData scene = loadRing();
  const RenderResult result = render(scene, selectCamera(scene, "0"), makeSettings(24, 16, 1, allLayers()));
  ASSERT_EQ(result.image.layers.size(), layerInfos().size());
  EXPECT_EQ(result.stats.samples, 1U);
  for (const LayerInfo& info : layerInfos()) {
    const Image* image = result.image.find(info.name);
    ASSERT_NE(image, nullptr) << info.name;
    EXPECT_EQ(image->width, 24) << info.name;
    EXPECT_EQ(image->height, 16) << info.name;
    EXPECT_EQ(image->channels, info.channels) << info.name;
  }
  const std::string not_made =
      "caustic,indirect,specular_caustic,irradiance,irradiance_caustic,beauty_error,direct_error,caustic_error,"
      "specular_error,indirect_error,emission_error,specular_caustic_error,irradiance_error,irradiance_caustic_error,"
      "caustic_bias,specular_caustic_bias";
  EXPECT_EQ(result.image.metadata.at("not_made"), not_made);
  EXPECT_EQ(result.image.metadata.at("not_in_beauty"), "caustic,indirect");
  for (const std::string& name : parseLayerList(not_made)) {
    EXPECT_THAT(result.image.find(name)->pixels, ::testing::Each(0.0F)) << name;
    EXPECT_THAT(result.notes, Contains(::testing::StartsWith(name + " is black")));
  }
  const Image &beauty = *result.image.find("beauty"), &direct = *result.image.find("direct");
  const Image &emission = *result.image.find("emission"), &specular = *result.image.find("specular");
  for (std::size_t i = 0; i < beauty.pixels.size(); ++i)
    EXPECT_EQ(beauty.pixels[i], direct.pixels[i] + emission.pixels[i] + specular.pixels[i]);
  EXPECT_THAT(result.notes, Contains(HasSubstr("beauty is direct, specular, emission alone")));
}

TEST_F(None, SaysWhatItWasMadeFromAndHowLongEachPassTook) {
  const LitFloor lit;
  const RenderResult result = render(lit.scene, lit.camera, makeSettings(16, 12, 3, {"direct"}));
  const auto& metadata = result.image.metadata;
  EXPECT_EQ(metadata.at("technique"), "none");
  EXPECT_FALSE(metadata.at("device").empty());
  EXPECT_EQ(metadata.at("seed"), "0");
  EXPECT_EQ(metadata.at("samples"), "3");
  EXPECT_EQ(metadata.at("set.shadow-size"), "128");
  EXPECT_FALSE(metadata.contains("not_made"));
  EXPECT_TRUE(result.notes.empty());
  std::vector<std::string> passes;
  for (const StageTime& stage : result.stats.stages) {
    if (stage.frames == 0) continue;
    passes.push_back(stage.name);
    EXPECT_EQ(stage.frames, 3U) << stage.name;
  }
  EXPECT_THAT(passes, Contains("visibility"));
  EXPECT_THAT(passes, Contains("shade"));
}

TEST_F(None, GeometryIsThatOfTheReference) {
  constexpr int kWidth = 64, kHeight = 48;
  const SceneData scene = loadRing();
  const Camera camera = selectCamera(scene, "0");
  const CameraModel camera_model(camera, kWidth, kHeight);
  const std::vector<std::string> names{"albedo", "normal", "position", "depth", "id"};
  const RenderResult ours = render(scene, camera, makeSettings(kWidth, kHeight, 1, names));
  RenderSettings settings = test::makeSettings(kWidth, 1, 0, names);
  settings.height = kHeight;
  const RenderResult theirs = renderReference(scene, camera, settings);
  int edges = 0;
  for (int y = 0; y < kHeight; ++y) {
    for (int x = 0; x < kWidth; ++x) {
      SCOPED_TRACE(::testing::Message() << "pixel " << x << ", " << y);
      const auto at = [&](const RenderResult& result, const char* name) { return result.image.find(name)->rgb(x, y); };
      const bool seen = at(ours, "id").x > 0.0F;
      const float depth = at(theirs, "depth").x;
      const float apart = length(at(ours, "position") - at(theirs, "position"));
      if (at(ours, "id") != at(theirs, "id") || (seen && apart > 1e-5F * depth)) {
        // A rasteriser knows edges, also those between triangles that are seen at grazing angles, to a fraction of a
        // pixel: there the surface may be that of another place in the pixel, but of this pixel.
        ++edges;
        const auto place = camera_model.connect(at(ours, "position"));
        EXPECT_TRUE(!seen || (place && place->x == x && place->y == y));
        continue;
      }
      EXPECT_EQ(at(ours, "albedo"), at(theirs, "albedo"));
      EXPECT_LT(length(at(ours, "normal") - at(theirs, "normal")), 1e-4F);
      if (seen) {
        EXPECT_NEAR(at(ours, "depth").x, depth, 1e-5F * depth);
      } else {
        EXPECT_EQ(at(ours, "depth").x, kInfinity);
      }
    }
  }
  EXPECT_LE(edges, kWidth * kHeight * 5 / 1000);
}

TEST_F(None, DirectOfAPointLightIsTheClosedForm) {
  constexpr int kWidth = 64, kHeight = 48;
  const LitFloor lit;
  const RenderResult result = render(lit.scene, lit.camera, makeSettings(kWidth, kHeight, 1, {"direct"}));
  for (int y = 0; y < kHeight; ++y)
    for (int x = 0; x < kWidth; ++x) {
      const vec3 expected = lit.radianceAt(x, y, kWidth, kHeight), got = result.image.layers[0].image.rgb(x, y);
      for (int c = 0; c < 3; ++c) ASSERT_NEAR(got[c], expected[c], 1e-4F * expected[c]) << x << ", " << y;
    }
}

/// Light of a sphere, averaged over the pixels: soft shadows leave no bias, only noise that falls with the samples.
TEST_F(None, DirectUnderASoftLightConvergesToTheReference) {
  SceneData scene = makeBallScene(makeDiffuse(vec3(0.5F)), 32);
  scene.lights.push_back(makePoint(vec3(1.5F, 3.5F, 1.0F), vec3(10.0F), 0.3F));
  Camera camera;
  camera.eye = vec3(0, 3, 6);
  camera.forward = normalize(vec3(0, -0.35F, -1));
  camera.up = normalize(cross(cross(camera.forward, vec3(0, 1, 0)), camera.forward));
  const RenderResult ours = render(scene, camera, makeSettings(24, 24, 256, {"direct"}));
  const RenderResult theirs = renderReference(scene, camera, test::makeSettings(24, 1024, 0, {"direct"}));
  const Image &a = ours.image.layers[0].image, &b = theirs.image.layers[0].image;
  EXPECT_NEAR(meanOf(a).x, meanOf(b).x, 0.005 * meanOf(b).x);
  double difference = 0;
  for (std::size_t i = 0; i < a.pixels.size(); ++i) difference += std::abs(a.pixels[i] - b.pixels[i]);
  EXPECT_LT(difference / static_cast<double>(a.pixels.size()), 0.02 * meanOf(b).x);
}

TEST_F(None, EqualRunsGiveEqualPicturesAndSeedsMatter) {
  SceneData scene = makeBallScene(makeDiffuse(vec3(0.5F)), 24);
  scene.lights.push_back(makeSun(vec3(1, -2, -1), vec3(5.0F), 10.0F));
  Camera camera;
  camera.eye = vec3(0, 2, 6);
  RenderSettings settings = makeSettings(32, 24, 4, {"beauty"});
  const RenderResult first = render(scene, camera, settings);
  EXPECT_TRUE(first.image.layers[0].image.pixels == render(scene, camera, settings).image.layers[0].image.pixels);
  settings.seed = 1;
  EXPECT_FALSE(first.image.layers[0].image.pixels == render(scene, camera, settings).image.layers[0].image.pixels);
}

TEST_F(None, NeedsAVulkanDevice) {
  const LitFloor lit;
  RenderSettings settings = makeSettings(8, 8, 1, {"direct"});
  settings.device = "cpu";
  EXPECT_THROW(render(lit.scene, lit.camera, settings), UsageError);
  settings.device = "best";
  EXPECT_THROW(render(lit.scene, lit.camera, settings), UsageError);
  settings.device = "99";
  EXPECT_THROW(render(lit.scene, lit.camera, settings), DeviceError);
  settings = test::makeSettings(8, 1, 0, {"direct"});
  settings.device = "0";
  EXPECT_THROW(renderReference(lit.scene, lit.camera, settings), UsageError);
}

/// Asks to stop at the first report.
class StopAtOnce : public ProgressSink {
 public:
  void update(double /*fraction*/, const std::string& /*status*/) override { token.request(); }
  StopToken token;
};

TEST_F(None, KeepsWhatItHasWhenStopped) {
  const LitFloor lit;
  StopAtOnce sink;
  const RenderSettings settings = makeSettings(16, 12, 1000, {"direct"});
  const RenderResult result = render(lit.scene, lit.camera, settings, &sink, &sink.token);
  EXPECT_TRUE(result.interrupted);
  EXPECT_EQ(result.stats.samples, 1U);
  EXPECT_GT(meanOf(result.image.layers[0].image).x, 0.0);
  EXPECT_THROW(render(lit.scene, lit.camera, settings, &sink, &sink.token), InterruptedError);
}

TEST_F(None, EndsInTime) {
  const LitFloor lit;
  RenderSettings settings = makeSettings(16, 12, 0, {"direct"});
  settings.seconds = 1e-3;
  const RenderResult result = render(lit.scene, lit.camera, settings);
  EXPECT_FALSE(result.interrupted);
  EXPECT_GE(result.stats.samples, 1U);
}

TEST_F(None, KeepsPipelinesForTheNextRun) {
  const LitFloor lit;
  const RenderSettings settings = makeSettings(8, 8, 1, {"direct"});
  const auto folder = *cache_ / "cache" / "nephroid";
  std::filesystem::remove_all(folder);
  render(lit.scene, lit.camera, settings);
  ASSERT_TRUE(std::filesystem::exists(folder));
  const std::filesystem::path file = std::filesystem::directory_iterator(folder)->path();
  EXPECT_THAT(file.filename().string(), ::testing::MatchesRegex("pipelines-[-a-z0-9]+\\.bin"));
  // What is no cache, and what is no file, is left out.
  std::filesystem::resize_file(file, 3);
  EXPECT_NO_THROW(render(lit.scene, lit.camera, settings));
  std::filesystem::remove_all(folder);
  std::filesystem::create_directories(file);
  EXPECT_NO_THROW(render(lit.scene, lit.camera, settings));
}

}  // namespace
}  // namespace nephroid::test
