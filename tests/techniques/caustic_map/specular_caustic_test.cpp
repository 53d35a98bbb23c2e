// Caustics seen in mirrors and through glass and water, by the technique `caustic-map`.
#include <cmath>
#include <glm/gtc/matrix_transform.hpp>

#include "frame/frame.h"
#include "scene/load.h"
#include "support/gpu_fixture.h"
#include "support/tiny_scenes.h"
#include "techniques/caustic_map/caustic_map.h"
#include "trace/box_tree_builder.h"

namespace nephroid {
namespace {

constexpr int kSize = 48;
constexpr float kPi = 3.14159265F;

/// A glass ball's caustic beside it, under slanting light.
SceneData makeSlantedBall() {
  SceneData scene = test::makeBallScene(test::makeGlass(1.5F), 64);
  scene.lights.push_back(test::makeSun(vec3(1, -1, 0), vec3(5.0F, 4.0F, 3.0F)));
  return scene;
}

/// A clear slab over the floor that does not bend light.
SceneData makeIndexOneSlab() {
  SceneData scene;
  test::addObject(scene, test::makeFloor(4.0), test::makeDiffuse(vec3(0.6F)));
  test::addObject(scene, makeBox("slab", dvec3(-1, 0.4, -1), dvec3(1, 0.6, 1)), test::makeGlass(1.0F));
  scene.lights.push_back(test::makeSun(vec3(0, -1, 0), vec3(5.0F, 4.0F, 3.0F)));
  return scene;
}

/// Sees what lies below `target` in parallel, from above.
Camera lookDown(vec3 target, float height) {
  return makeCamera("down", target + vec3(0, 3, 0.001F), target, 0.0F, height);
}

class SpecularCausticTest : public testing::GpuTest {
 protected:
  static std::unique_ptr<RealtimeFrame> makeFrame(const SceneData& scene, const Camera& camera,
                                                  CausticMapSettings settings = {}, std::uint32_t spacing = 4) {
    const FrameSettings frame{
        .width = kSize, .height = kSize, .box_tree_builder = buildBoxTree, .specular_spacing = spacing};
    return std::make_unique<RealtimeFrame>(device(), scene, camera, frame, [settings](const RealtimeInputs& inputs) {
      return std::make_unique<CausticMap>(inputs, settings);
    });
  }
  static Image draw(const SceneData& scene, const Camera& camera, const std::string& layer,
                    const CausticMapSettings& settings = {}, std::uint32_t samples = 1, std::uint32_t spacing = 4) {
    const std::unique_ptr<RealtimeFrame> frame = makeFrame(scene, camera, settings, spacing);
    for (std::uint32_t s = 0; s < samples; ++s) frame->render(s);
    return frame->readSummed(layer);
  }
};

TEST_F(SpecularCausticTest, ThroughASlabOfIndexOneTheFloorIsAsBrightAsWithout) {
  // albedo/π · E, whether pixels follow their own chains or lie between those that do.
  const vec3 expected = 0.6F / kPi * vec3(5.0F, 4.0F, 3.0F);
  for (const std::uint32_t spacing : {1U, 4U}) {
    const Image image = draw(makeIndexOneSlab(), lookDown(vec3(0), 1.5F), "specular_caustic", {}, 1, spacing);
    for (int y = 0; y < kSize; ++y)
      for (int x = 0; x < kSize; ++x)
        for (int c = 0; c < 3; ++c)
          ASSERT_NEAR(image.at(x, y)[c], expected[c], 0.01F * expected[c]) << x << ", " << y << ", " << spacing;
  }
}

TEST_F(SpecularCausticTest, AMirrorShowsTheCausticAsAnEyeBehindItSeesIt) {
  const SceneData open = makeSlantedBall();
  SceneData mirrored = open;
  test::addObject(mirrored, makeRectangle("mirror", dvec3(1.8, 2, -2), dvec3(1, 0, 0), dvec3(0, 2, 0)),
                  test::makeMetal(vec3(1.0F)));
  // Beside the ball, 45° down: in the mirror at z = −2 two metres above the floor, and straight on the floor at z = 0.
  const Camera to_mirror = makeCamera("mirror", vec3(1.8F, 4, 0), vec3(1.8F, 2, -2), 0.0F, 1.4F);
  const Camera behind = makeCamera("floor", vec3(1.8F, 4, -4), vec3(1.8F, 0, 0), 0.0F, 1.4F);
  const CausticMapSettings settings{.receiver_map_size = 1024};
  const Image seen = draw(mirrored, to_mirror, "specular_caustic", settings, 8),
              straight = draw(open, behind, "caustic", settings, 8);
  EXPECT_GT(test::meanOf(straight).x, 0.01);
  for (int c = 0; c < 3; ++c) EXPECT_NEAR(test::meanOf(seen)[c] / test::meanOf(straight)[c], 1.0, 0.02);
  Image flipped(kSize, kSize, 3);
  for (int y = 0; y < kSize; ++y)
    for (int x = 0; x < kSize; ++x)
      for (int c = 0; c < 3; ++c) flipped.at(x, y)[c] = seen.at(kSize - 1 - x, y)[c];
  // Folds are narrower than pixels, and texels.
  EXPECT_LT(test::relativeDifference(flipped, straight), 0.2);
}

TEST_F(SpecularCausticTest, IsAllThatSpecularHasMoreThanWithoutATechnique) {
  const SceneData scene = makeSlantedBall();
  const Camera camera = makeCamera("eye", vec3(0.5F, 3, 5), vec3(0.5F, 0.8F, 0), 0.6F);
  const std::unique_ptr<RealtimeFrame> with = makeFrame(scene, camera);
  RealtimeFrame without(device(), scene, camera,
                        {.width = kSize, .height = kSize, .box_tree_builder = buildBoxTree, .specular_spacing = 4});
  for (std::uint32_t s = 0; s < 4; ++s) {
    with->render(s);
    without.render(s);
  }
  const Image specular = with->readSummed("specular"), caustic = with->readSummed("specular_caustic"),
              others = without.readSummed("specular");
  EXPECT_GT(test::meanOf(caustic).x, 0.01 * test::meanOf(specular).x);
  for (std::size_t i = 0; i < specular.pixels.size(); ++i)
    ASSERT_NEAR(specular.pixels[i], others.pixels[i] + caustic.pixels[i], 1e-5F * (specular.pixels[i] + 0.01F));
  EXPECT_EQ(test::meanOf(without.readSummed("specular_caustic")), dvec3(0.0));
}

TEST_F(SpecularCausticTest, TwoLightsAdd) {
  SceneData both = makeIndexOneSlab();
  both.lights.push_back(test::makePoint(vec3(-1, 3, 1), vec3(30, 90, 10)));
  SceneData first = both, second = both;
  first.lights.pop_back();
  second.lights.erase(second.lights.begin());
  const Camera camera = lookDown(vec3(0), 1.5F);
  Image sum = draw(first, camera, "specular_caustic");
  const Image other = draw(second, camera, "specular_caustic");
  for (std::size_t i = 0; i < sum.pixels.size(); ++i) sum.pixels[i] += other.pixels[i];
  EXPECT_GT(test::meanOf(other).x, 0.0);
  EXPECT_LT(test::relativeDifference(draw(both, camera, "specular_caustic"), sum), 1e-4);
}

TEST_F(SpecularCausticTest, WallsAndWhatStandsOnFloorsCatchItToo) {
  // Light that is parallel to the floor: a wall behind the slab, seen through it, and a block before the wall.
  SceneData scene = makeIndexOneSlab();
  scene.instances.pop_back();
  test::addObject(scene, makeBox("slab", dvec3(-1, 0, -0.1), dvec3(1, 2, 0.1)), test::makeGlass(1.0F));
  test::addObject(scene, makeRectangle("wall", dvec3(0, 1, -2), dvec3(2, 0, 0), dvec3(0, 1, 0)),
                  test::makeDiffuse(vec3(0.6F)));
  test::addObject(scene, makeBox("block", dvec3(0.3, 0.3, -1.8), dvec3(0.9, 0.9, -1.2)), test::makeDiffuse(vec3(0.3F)));
  scene.lights[0] = test::makeSun(vec3(0, 0, -1), vec3(5.0F));
  const Camera camera = makeCamera("wall", vec3(0, 1, 3), vec3(0, 1, -2), 0.0F, 1.8F);
  const Image image = draw(scene, camera, "specular_caustic");
  const auto at = [&](float x, float y) {
    return image.at(static_cast<int>((x / 1.8F + 0.5F) * kSize),
                    static_cast<int>((0.5F - (y - 1.0F) / 1.8F) * kSize))[0];
  };
  EXPECT_NEAR(at(-0.5F, 1.2F), 0.6F / kPi * 5.0F, 0.01F);
  EXPECT_NEAR(at(0.6F, 0.6F), 0.3F / kPi * 5.0F, 0.01F);
}

TEST_F(SpecularCausticTest, SaysWhatIsHiddenFromAllAxes) {
  // Under two plates, light that came through a slab of index 1 and falls by 0.1 a metre: what leaves the slab between
  // 0.1 and 0.25 m above the floor ends below the plates, which begin a metre from it. That is a rectangle of 0.15 m²
  // across the floor, which the light passes at 5.7°.
  SceneData scene;
  test::addObject(scene, test::makeFloor(4.0), test::makeDiffuse(vec3(0.6F)));
  test::addObject(scene, makeBox("slab", dvec3(-1.1, 0.05, -0.5), dvec3(-1, 0.25, 0.5)), test::makeGlass(1.0F));
  scene.lights.push_back(test::makeSun(vec3(1, -0.1F, 0), vec3(5.0F, 4.0F, 3.0F)));
  const auto lost = [&] {
    const std::unique_ptr<RealtimeFrame> frame = makeFrame(scene, lookDown(vec3(-1, 0, 0), 1.5F));
    frame->render(0);
    return frame->technique()->lostByReceivers();
  };
  EXPECT_LT(lost().x, 0.01);
  for (const double y : {0.3, 0.6})
    test::addObject(scene, makeRectangle("plate", dvec3(1, y, 0), dvec3(0, 0, 1), dvec3(1, 0, 0)),
                    test::makeDiffuse(vec3(0.6F)));
  const dvec3 hidden = lost(), expected = 0.15 / std::sqrt(1.01) * dvec3(5, 4, 3);
  for (int c = 0; c < 3; ++c) EXPECT_NEAR(hidden[c] / expected[c], 1.0, 0.03);
}

TEST_F(SpecularCausticTest, AMirrorShowsWhatFallsOnAHalfMirror) {
  // By the wall that mirrors all light onto a floor that mirrors half of it, and scatters the other half.
  SceneData scene;
  test::addObject(scene, test::makeFloor(4.0), test::makeHalfMirror());
  test::addObject(scene, makeRectangle("wall", dvec3(-2, 1, 0), dvec3(0, 1, 0), dvec3(0, 0, 2)),
                  test::makeMetal(vec3(1.0F)));
  scene.lights.push_back(test::makeSun(vec3(-1, -1, 0), vec3(5.0F, 4.0F, 3.0F)));
  // Looks down into the wall at 45°, to where the floor before it is.
  const Camera camera = makeCamera("wall", vec3(0, 3, 0), vec3(-2, 1, 0), 0.0F, 1.0F);
  // What a chain sees of the floor, its own or what it mirrors, is drawn by chance: in 36,864 pixels half of the draws
  // see the one, with a deviation of 0.5 %.
  const dvec3 mean = test::meanOf(draw(scene, camera, "specular_caustic", {}, 16, 1));
  const vec3 expected = std::sqrt(0.5F) * 0.5F / kPi * vec3(5.0F, 4.0F, 3.0F);
  for (int c = 0; c < 3; ++c) EXPECT_NEAR(mean[c] / expected[c], 1.0, 0.02);
}

TEST_F(SpecularCausticTest, WhatIsKeptIsWhatWouldBeMade) {
  SceneData scene = makeSlantedBall();
  const Camera camera = makeCamera("eye", vec3(0.5F, 3, 5), vec3(0.5F, 0.8F, 0), 0.6F);
  const std::unique_ptr<RealtimeFrame> kept = makeFrame(scene, camera, {.emits_once = true});
  const auto drawNext = [&] {
    kept->reset();
    kept->render(0);
    return kept->readSummed("specular_caustic").pixels;
  };
  const std::vector<float> first = drawNext();
  EXPECT_EQ(first, draw(scene, camera, "specular_caustic").pixels);
  EXPECT_EQ(drawNext(), first);
  // Until something changes.
  scene.lights[0].intensity *= 2.0F;
  kept->lightChanged(0);
  EXPECT_EQ(drawNext(), draw(scene, camera, "specular_caustic").pixels);
  scene.instances[1].world_from_object = glm::translate(mat4(1.0F), vec3(0, 0.5F, 0));
  kept->objectsMoved();
  EXPECT_EQ(drawNext(), draw(scene, camera, "specular_caustic").pixels);
}

/// Mean over the reference's. @param samples  of the reference, and photons in thousands of each
double ratioOfMeans(const SceneData& scene, const Image& ours) {
  RenderSettings settings = test::makeSettings(kSize, 32, 1 << 18, {"specular_caustic"});
  const RenderResult theirs = test::renderReference(scene, scene.cameras[0], settings);
  return test::meanOf(ours).y / test::meanOf(*theirs.image.find("specular_caustic")).y;
}

TEST_F(SpecularCausticTest, UnderWaterItIsAsBrightAsInTheReference) {
  for (const char* name : {"builtin:wave", "builtin:pool"}) {
    SceneData scene = loadScene(name);
    EXPECT_NEAR(ratioOfMeans(scene, draw(scene, scene.cameras[0], "specular_caustic", {}, 8)), 1.0, 0.03) << name;
  }
}

}  // namespace
}  // namespace nephroid
