// Scenes that change between frames, and scenes and pictures of unusual sizes.
#include <algorithm>
#include <cmath>

#include "frame/frame.h"
#include "scene/load.h"
#include "support/gpu_fixture.h"
#include "support/tiny_scenes.h"

namespace nephroid {
namespace {

class ChangesTest : public testing::GpuTest {
 protected:
  static int countPasses(const RealtimeFrame& frame, const std::string& name) {
    return static_cast<int>(std::count_if(frame.passTimes().begin(), frame.passTimes().end(),
                                          [&](const gpu::PassTime& time) { return time.name == name; }));
  }
  /// What a new frame of the scene as it is now shows.
  static Image renderAnew(const SceneData& scene, const Camera& camera, const FrameSettings& settings) {
    RealtimeFrame frame(device(), scene, camera, settings);
    frame.render(0);
    return frame.readSummed("direct");
  }
};

const FrameSettings kSmall{.width = 32, .height = 24};

SceneData makeBalls() {
  SceneData scene = test::makeBallScene(test::makeDiffuse(vec3(0.4F, 0.5F, 0.6F)), 24);
  scene.lights.push_back(test::makePoint(vec3(2, 4, 1), vec3(60)));
  scene.lights.push_back(test::makeSun(vec3(1, -2, 0.5F), vec3(3)));
  return scene;
}

Camera lookAtBall() { return makeCamera("eye", vec3(0, 4, 6), vec3(0, 0.5F, 0), 0.7F); }

TEST_F(ChangesTest, AMovedLightCostsItsOwnGridAndNothingElse) {
  SceneData scene = makeBalls();
  RealtimeFrame frame(device(), scene, lookAtBall(), kSmall);
  frame.render(0);
  EXPECT_EQ(countPasses(frame, "light grid"), 2);
  scene.lights[0].position = vec3(-2, 3, 1);
  frame.lightChanged(0);
  frame.render(0);
  EXPECT_EQ(countPasses(frame, "light grid"), 1);
  EXPECT_EQ(frame.samples(), 1U);
  EXPECT_EQ(frame.readSummed("direct").pixels, renderAnew(scene, lookAtBall(), kSmall).pixels);
}

TEST_F(ChangesTest, LightsMayGoOutAndBecomeLamps) {
  SceneData scene = makeBalls();
  RealtimeFrame frame(device(), scene, lookAtBall(), kSmall);
  frame.render(0);
  scene.lights[0].intensity = vec3(0);
  frame.lightChanged(0);
  frame.render(0);
  EXPECT_EQ(frame.readSummed("direct").pixels, renderAnew(scene, lookAtBall(), kSmall).pixels);
  scene.lights[0].intensity = vec3(50);
  scene.lights[0].position = vec3(1.5F, 1, 0);
  scene.lights[0].radius = 0.3F;
  frame.lightChanged(0);
  frame.render(0);
  EXPECT_EQ(frame.readSummed("direct").pixels, renderAnew(scene, lookAtBall(), kSmall).pixels);
  const Image emission = frame.readSummed("emission");
  EXPECT_GT(*std::max_element(emission.pixels.begin(), emission.pixels.end()), 0.0F);
}

TEST_F(ChangesTest, LightsThatStayOrAreOutCostNothing) {
  SceneData scene = makeBalls();
  scene.lights[0].intensity = vec3(0);
  RealtimeFrame frame(device(), scene, lookAtBall(), kSmall);
  frame.render(0);
  EXPECT_EQ(countPasses(frame, "light grid"), 1);
  frame.render(1);
  EXPECT_EQ(countPasses(frame, "light grid"), 0);
  EXPECT_EQ(countPasses(frame, "upload"), 1) << "more than the camera";
  scene.lights[0].intensity = vec3(60);
  frame.lightChanged(0);
  frame.render(0);
  EXPECT_EQ(frame.readSummed("direct").pixels, renderAnew(scene, lookAtBall(), kSmall).pixels);
}

TEST_F(ChangesTest, LightsBecomeOthersThanThePassesWereCompiledFor) {
  SceneData scene = makeBalls();
  scene.lights.erase(scene.lights.begin());
  RealtimeFrame frame(device(), scene, lookAtBall(), kSmall);
  frame.render(0);
  const auto expectAsAnew = [&](const char* kind) {
    frame.lightChanged(0);
    frame.render(0);
    EXPECT_EQ(frame.readSummed("direct").pixels, renderAnew(scene, lookAtBall(), kSmall).pixels) << kind;
  };
  Light light = test::makePoint(vec3(2, 4, 1), vec3(60));
  scene.lights[0] = light;
  expectAsAnew("point");
  light.kind = LightKind::kSpot;
  light.direction = normalize(vec3(-2, -3.5F, -1));
  light.inner_cone = 0.1F, light.outer_cone = 0.3F;
  scene.lights[0] = light;
  expectAsAnew("spot");
  light.radius = 0.4F;
  scene.lights[0] = light;
  expectAsAnew("spot with a size");
  scene.lights[0] = test::makeSun(vec3(1, -2, 0.5F), vec3(3));
  expectAsAnew("sun");
}

TEST_F(ChangesTest, ManyLightsAreTheSumOfEachAlone) {
  // Few have code of their own each, many a common loop.
  SceneData scene = makeBalls();
  const auto light = test::makePoint(vec3(-1, 3, 2), vec3(30));
  Image sum(kSmall.width, kSmall.height, 3);
  std::vector<Light> all = scene.lights;
  for (int i = 0; i < 3; ++i) {
    all.push_back(light);
    all.back().position.x += static_cast<float>(i);
  }
  for (const Light& one : all) {
    scene.lights = {one};
    const Image alone = renderAnew(scene, lookAtBall(), kSmall);
    for (std::size_t i = 0; i < sum.pixels.size(); ++i) sum.pixels[i] += alone.pixels[i];
  }
  scene.lights = all;
  const Image together = renderAnew(scene, lookAtBall(), kSmall);
  for (std::size_t i = 0; i < sum.pixels.size(); ++i)
    ASSERT_NEAR(together.pixels[i], sum.pixels[i], 1e-5F * sum.pixels[i]);
}

TEST_F(ChangesTest, MovedObjectsStandAndShadeWhereTheyAre) {
  SceneData scene = makeBalls();
  RealtimeFrame frame(device(), scene, lookAtBall(), kSmall);
  frame.render(0);
  scene.instances[1].world_from_object[3] = vec4(1.0F, 0.3F, -1.0F, 1.0F);
  frame.objectsMoved();
  frame.render(0);
  EXPECT_EQ(frame.readSummed("direct").pixels, renderAnew(scene, lookAtBall(), kSmall).pixels);
}

TEST_F(ChangesTest, ALampThatWasScaledToNothingComesBack) {
  SceneData scene = makeBalls();
  Material glow = test::makeDiffuse(vec3(0.0F));
  glow.emission = vec3(9);
  const std::uint32_t lamp =
      test::addObject(scene, makeRectangle("lamp", dvec3(0, 3, 0), dvec3(1, 0, 0), dvec3(0, 0, 1)), glow, mat4(0.0F));
  scene.instances[lamp].world_from_object[3][3] = 1.0F;
  RealtimeFrame frame(device(), scene, lookAtBall(), kSmall);
  frame.render(0);
  scene.instances[lamp].world_from_object = mat4(1.0F);
  frame.objectsMoved();
  frame.render(0);
  EXPECT_EQ(frame.readSummed("direct").pixels, renderAnew(scene, lookAtBall(), kSmall).pixels);
}

TEST_F(ChangesTest, CamerasTurnAndPicturesChangeTheirSize) {
  const SceneData scene = makeBalls();
  RealtimeFrame frame(device(), scene, lookAtBall(), kSmall);
  frame.render(0);
  const Camera other = makeCamera("other", vec3(4, 2, 1), vec3(0, 1, 0), 0.9F);
  frame.setCamera(other);
  frame.resize(17, 40);
  frame.render(0);
  const Image direct = frame.readSummed("direct");
  ASSERT_EQ(direct.width, 17);
  ASSERT_EQ(direct.height, 40);
  EXPECT_EQ(direct.pixels, renderAnew(scene, other, {.width = 17, .height = 40}).pixels);
}

TEST_F(ChangesTest, APictureGrowsBeforeItIsDrawn) {
  const SceneData scene = makeBalls();
  RealtimeFrame frame(device(), scene, lookAtBall(), {.width = 1, .height = 1});
  frame.resize(64, 48);
  frame.render(0);
  EXPECT_EQ(frame.readSummed("direct").pixels, renderAnew(scene, lookAtBall(), {.width = 64, .height = 48}).pixels);
}

TEST_F(ChangesTest, PicturesOf4096By2160) {
  const SceneData scene = makeBalls();
  RealtimeFrame frame(device(), scene, lookAtBall(), {.width = 4096, .height = 2160});
  frame.render(0);
  const dvec3 large = test::meanOf(frame.readSummed("direct"));
  frame.resize(64, 34);
  for (std::uint32_t s = 0; s < 64; ++s) frame.render(s);
  EXPECT_NEAR(large.x, test::meanOf(frame.readSummed("direct")).x, 0.01 * large.x);
}

TEST_F(ChangesTest, SixtyFourLightsAddUp) {
  // Each one alone, and all of them; on a floor with nothing in the way, so that the sum is a closed form.
  SceneData scene;
  test::addObject(scene, test::makeFloor(8.0), test::makeDiffuse(vec3(0.5F)));
  double expected = 0.0;
  for (int i = 0; i < 64; ++i) {
    const vec3 position(0.2F * static_cast<float>(i % 8) - 0.7F, 1.0F + 0.1F * static_cast<float>(i / 8), 0.3F);
    scene.lights.push_back(test::makePoint(position, vec3(0.1F * static_cast<float>(i + 1))));
    const dvec3 p(position);
    expected += 0.5 / kPi * 0.1 * (i + 1) * p.y / std::pow(dot(p, p), 1.5);
  }
  RealtimeFrame frame(device(), scene, makeCamera("down", vec3(0, 3, 0), vec3(0), 0.0F, 1e-3F),
                      {.width = 8, .height = 8});
  frame.render(0);
  EXPECT_NEAR(frame.readSummed("direct").at(4, 4)[0], expected, 1e-3 * expected);
}

TEST_F(ChangesTest, AThousandInstances) {
  SceneData scene;
  test::addObject(scene, test::makeFloor(80.0), test::makeDiffuse(vec3(0.5F)));
  scene.lights.push_back(test::makeSun(vec3(0, -1, 0), vec3(1)));
  const std::uint32_t first =
      test::addObject(scene, makeSphere("ball", dvec3(0), 0.5, 12), test::makeDiffuse(vec3(0.8F)));
  const Instance ball = scene.instances[first];
  scene.instances.resize(first);
  for (int i = 0; i < 1000; ++i) {
    scene.instances.push_back(ball);
    scene.instances.back().world_from_object[3] =
        vec4(static_cast<float>(i % 40) - 19.5F, 1.0F, static_cast<float>(i / 40) - 12.0F, 1.0F);
  }
  const Camera camera = makeCamera("down", vec3(0, 30, 0), vec3(0, 0, 0), 0.0F, 25.0F);
  RealtimeFrame frame(device(), scene, camera, {.width = 500, .height = 250});
  const Image id = frame.readGeometry("id");
  std::vector<bool> seen(1002, false);
  for (const float i : id.pixels) seen[static_cast<std::size_t>(i)] = true;
  EXPECT_EQ(std::count(seen.begin() + 2, seen.end(), true), 1000);
  // The floor between the balls is lit, below them dark: shadows are as large as the balls.
  frame.render(0);
  const Image direct = frame.readSummed("direct");
  for (int y = 0; y < 250; ++y)
    for (int x = 0; x < 500; ++x)
      if (id.at(x, y)[0] == 1.0F) {
        ASSERT_NEAR(direct.at(x, y)[0], 0.5 / kPi, 1e-5) << x << ", " << y;
      }
}

TEST_F(ChangesTest, AMillionTriangles) {
  SceneData scene = loadScene("builtin:sphere?segments=1002");
  completeScene(scene);
  ASSERT_GE(scene.triangleCount(), 1'000'000U);
  RealtimeFrame frame(device(), scene, scene.cameras[0], kSmall);
  frame.render(0);
  EXPECT_GT(test::meanOf(frame.readSummed("direct")).x, 0.0);
}

}  // namespace
}  // namespace nephroid
