// The technique `caustic-map` in frames, by whatever Vulkan device there is.
#include "techniques/caustic_map/caustic_map.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <glm/gtc/matrix_transform.hpp>

#include "frame/frame.h"
#include "support/gpu_fixture.h"
#include "support/tiny_scenes.h"

namespace nephroid {
namespace {

constexpr int kSize = 48;

/// Sees the floor from the side, the ball's caustic in the middle.
Camera lookAtFloor(float scale = 1.0F, float mirror = 1.0F) {
  return makeCamera("floor", scale * vec3(mirror * 3.5F, 3.0F, 2.5F), scale * vec3(mirror * 0.5F, 0, 0.3F),
                    radians(50));
}

SceneData makeSunlitBall(Material material) {
  SceneData scene = test::makeBallScene(std::move(material), 64);
  scene.lights.push_back(test::makeSun(vec3(0.3F, -1, 0.1F), vec3(5.0F, 4.0F, 3.0F)));
  return scene;
}

MakeRealtimeTechnique makeCausticMap(CausticMapSettings settings) {
  settings.grid = 64;
  settings.internal_reflections = 0;
  return [settings](const RealtimeInputs& inputs) { return std::make_unique<CausticMap>(inputs, settings); };
}

class CausticMapTest : public testing::GpuTest {
 protected:
  static std::unique_ptr<RealtimeFrame> makeFrame(const SceneData& scene, const Camera& camera,
                                                  const CausticMapSettings& settings = {}) {
    const FrameSettings frame{.width = kSize, .height = kSize, .specular = false};
    return std::make_unique<RealtimeFrame>(device(), scene, camera, frame, makeCausticMap(settings));
  }
  static Image draw(const SceneData& scene, const Camera& camera, const CausticMapSettings& settings = {},
                    std::uint32_t samples = 1) {
    const std::unique_ptr<RealtimeFrame> frame = makeFrame(scene, camera, settings);
    for (std::uint32_t s = 0; s < samples; ++s) frame->render(s);
    return frame->readSummed("caustic");
  }
};

TEST_F(CausticMapTest, IndexOneLeavesDirectPlusCausticAsWithoutTheObject) {
  const SceneData with = makeSunlitBall(test::makeGlass(1.0F));
  SceneData without = with;
  without.instances.pop_back();
  const std::unique_ptr<RealtimeFrame> a = makeFrame(with, lookAtFloor()), b = makeFrame(without, lookAtFloor());
  for (RealtimeFrame* frame : {a.get(), b.get()})
    for (std::uint32_t s = 0; s < 4; ++s) frame->render(s);
  const Image direct = a->readSummed("direct"), caustic = a->readSummed("caustic"), all = b->readSummed("direct");
  double sum = 0.0, expected = 0.0;
  for (int y = kSize / 2; y < kSize; ++y)
    for (int x = 0; x < kSize; ++x) {
      if (direct.rgb(x, y).x + caustic.rgb(x, y).x <= 0.0F) continue;
      sum += direct.rgb(x, y).x + caustic.rgb(x, y).x;
      expected += all.rgb(x, y).x;
    }
  EXPECT_GT(test::meanOf(caustic).x, 0.02 * test::meanOf(direct).x);
  EXPECT_NEAR(sum / expected, 1.0, 0.015);
}

TEST_F(CausticMapTest, TwoRunsAreEqual) {
  const SceneData scene = makeSunlitBall(test::makeGlass(1.5F));
  for (const DepositTarget target : {DepositTarget::kCamera, DepositTarget::kLight})
    EXPECT_EQ(draw(scene, lookAtFloor(), {.target = target}, 2).pixels,
              draw(scene, lookAtFloor(), {.target = target}, 2).pixels);
}

TEST_F(CausticMapTest, TwoLightsAdd) {
  SceneData both = makeSunlitBall(test::makeGlass(1.5F));
  both.lights.push_back(test::makePoint(vec3(-1, 5, 1), vec3(30, 90, 10)));
  SceneData first = both, second = both;
  first.lights.pop_back();
  second.lights.erase(second.lights.begin());
  Image sum = draw(first, lookAtFloor());
  const Image other = draw(second, lookAtFloor());
  for (std::size_t i = 0; i < sum.pixels.size(); ++i) sum.pixels[i] += other.pixels[i];
  EXPECT_LT(test::relativeDifference(draw(both, lookAtFloor()), sum), 1e-4);
}

TEST_F(CausticMapTest, ScaleOfTheSceneChangesNothingUnderASun) {
  const Image one = draw(makeSunlitBall(test::makeGlass(1.5F)), lookAtFloor());
  for (const float scale : {1e-3F, 100.0F}) {
    SceneData scaled = makeSunlitBall(test::makeGlass(1.5F));
    for (Instance& instance : scaled.instances) instance.world_from_object = glm::scale(mat4(1.0F), vec3(scale));
    // Rounding moves photons at the ball's rim.
    EXPECT_LT(test::relativeDifference(draw(scaled, lookAtFloor(scale)), one), 0.01) << scale;
  }
}

TEST_F(CausticMapTest, AMirroredSceneGivesTheMirroredPicture) {
  const Image image = draw(makeSunlitBall(test::makeGlass(1.5F)), lookAtFloor(), {}, 8);
  SceneData mirrored = makeSunlitBall(test::makeGlass(1.5F));
  for (Instance& instance : mirrored.instances) instance.world_from_object = glm::scale(mat4(1.0F), vec3(-1, 1, 1));
  mirrored.lights[0].direction.x = -mirrored.lights[0].direction.x;
  const Image other = draw(mirrored, lookAtFloor(1.0F, -1.0F), {}, 8);
  // Cells lie elsewhere, and pixels have other samples.
  EXPECT_NEAR(test::meanOf(other).x / test::meanOf(image).x, 1.0, 0.02);
}

TEST_F(CausticMapTest, TheLightsMapShowsWhatPixelsShow) {
  // From above, through the ball: pixels of 2.5 cm have all of what falls on them, a map is looked up in their middles.
  SceneData scene = makeSunlitBall(test::makeGlass(1.5F));
  const Camera camera = makeCamera("floor", vec3(0, 0.1F, 0), vec3(0), 0.0F, 4.0F);
  const auto drawInto = [&](DepositTarget target) {
    RealtimeFrame frame(device(), scene, camera, {.width = 160, .height = 160, .specular = false},
                        makeCausticMap({.map_size = 1024, .target = target}));
    frame.render(0);
    return frame.readSummed("irradiance_caustic");
  };
  for (const bool is_sun : {true, false}) {
    if (!is_sun) scene.lights[0] = test::makePoint(vec3(-1, 5, 1), vec3(30));
    const Image pixels = drawInto(DepositTarget::kCamera), map = drawInto(DepositTarget::kLight);
    EXPECT_NEAR(test::meanOf(map).x / test::meanOf(pixels).x, 1.0, 0.02) << is_sun;
    // Folds are narrower than pixels.
    EXPECT_LT(test::relativeDifference(map, pixels), 0.2) << is_sun;
  }
}

TEST_F(CausticMapTest, ALowPassBlursAndKeepsTheFlux) {
  // The floor squarely from above, through nothing: each pixel covers as much of it.
  const SceneData scene = makeSunlitBall(test::makeGlass(1.5F));
  const Camera camera = makeCamera("floor", vec3(0, 0.1F, 0), vec3(0), 0.0F, 8.0F);
  const Image pixels = draw(scene, camera);
  for (const DepositTarget target : {DepositTarget::kCamera, DepositTarget::kLight}) {
    const Image sharp = draw(scene, camera, {.sun_map_size = 128, .target = target});
    const Image blurred = draw(scene, camera, {.sun_map_size = 128, .low_pass = 2.0F, .target = target});
    // A map is looked up in the middles of pixels, which are three of its texels wide.
    const double tolerance = target == DepositTarget::kCamera ? 1e-5 : 0.02;
    EXPECT_NEAR(test::meanOf(blurred).x / test::meanOf(pixels).x, 1.0, tolerance);
    EXPECT_LT(*std::ranges::max_element(blurred.pixels), 0.5F * *std::ranges::max_element(sharp.pixels));
  }
}

TEST_F(CausticMapTest, WhatIsKeptIsWhatWouldBeMade) {
  SceneData scene = makeSunlitBall(test::makeGlass(1.5F));
  for (const DepositTarget target : {DepositTarget::kCamera, DepositTarget::kLight}) {
    const std::unique_ptr<RealtimeFrame> kept = makeFrame(scene, lookAtFloor(), {.target = target, .emits_once = true});
    const auto drawNext = [&] {
      kept->reset();
      kept->render(0);
      return kept->readSummed("caustic").pixels;
    };
    const std::vector<float> first = drawNext();
    EXPECT_EQ(first, draw(scene, lookAtFloor(), {.target = target}).pixels);
    EXPECT_EQ(drawNext(), first);
    // Until something changes.
    scene.lights[0].intensity *= 2.0F;
    kept->lightChanged(0);
    EXPECT_EQ(drawNext(), draw(scene, lookAtFloor(), {.target = target}).pixels);
    scene.instances[1].world_from_object = glm::translate(mat4(1.0F), vec3(0.3F, 0.2F, 0));
    kept->objectsMoved();
    EXPECT_EQ(drawNext(), draw(scene, lookAtFloor(), {.target = target}).pixels);
  }
}

/// Irradiance of the whole floor, seen from above through nothing, under a sun that is turned about the vertical in
/// steps of 1°: the largest change in a step.
double largestStep(RealtimeFrame& frame, SceneData& scene, int first_degree, int degrees) {
  double before = 0.0, largest = 0.0;
  for (int degree = first_degree; degree <= first_degree + degrees; ++degree) {
    const float angle = radians(static_cast<float>(degree));
    scene.lights[0].direction = normalize(vec3(std::cos(angle), -2.0F, std::sin(angle)));
    frame.lightChanged(0);
    frame.reset();
    frame.render(0);
    const double flux = test::meanOf(frame.readSummed("irradiance_caustic")).x;
    EXPECT_GT(flux, 0.0) << degree;
    if (degree > first_degree) largest = std::max(largest, std::abs(flux / before - 1.0));
    before = flux;
  }
  return largest;
}

TEST_F(CausticMapTest, ALightThatTurnsGivesNoJumps) {
  const Camera camera = makeCamera("floor", vec3(0, 0.1F, 0), vec3(0), 0.0F, 8.0F);
  SceneData ball = makeSunlitBall(test::makeGlass(1.5F)), cube = ball;
  cube.instances.pop_back();
  test::addObject(cube, makeBox("cube", dvec3(-0.4, 0.2, -0.4), dvec3(0.4, 1.0, 0.4)), test::makeGlass(1.5F));
  const std::unique_ptr<RealtimeFrame> of_ball = makeFrame(ball, camera, {.sun_map_size = 128});
  EXPECT_LT(largestStep(*of_ball, ball, 37, 10), 0.01);
  // A quarter turn, of which the other three are copies, with the default grid: an edge of the cube along that of the
  // grid takes or leaves half a row of cells, 0.2 %. What the sun sees of the cube grows by 0.6 % in the first step
  // from where it looks squarely on a side: its top shows sin 63.4° of a side's area, the side before it cos 63.4°, and
  // the one beside it sin 1° of that.
  const MakeRealtimeTechnique make = [](const RealtimeInputs& inputs) {
    return std::make_unique<CausticMap>(inputs, CausticMapSettings{.sun_map_size = 128, .internal_reflections = 0});
  };
  RealtimeFrame of_cube(device(), cube, camera, {.width = kSize, .height = kSize, .specular = false}, make);
  EXPECT_LT(largestStep(of_cube, cube, -1, 92), 0.01);
}

TEST_F(CausticMapTest, AHalfMirrorShowsWhatFallsOnIt) {
  // A wall that mirrors all light, before a floor that mirrors half of it: from (−1, −1, 0) light comes back onto the
  // floor at 45°. The floor scatters half as a Lambertian, of what the wall sends and of what comes straight.
  SceneData scene;
  test::addObject(scene, test::makeFloor(4.0), test::makeHalfMirror());
  test::addObject(scene, makeRectangle("wall", dvec3(-2, 1, 0), dvec3(0, 1, 0), dvec3(0, 0, 2)),
                  test::makeMetal(vec3(1.0F)));
  scene.lights.push_back(test::makeSun(vec3(-1, -1, 0), vec3(5.0F, 4.0F, 3.0F)));
  const Camera camera = makeCamera("floor", vec3(-1, 3, 0.001F), vec3(-1, 0, 0), 0.0F, 1.6F);
  const vec3 irradiance = std::sqrt(0.5F) * vec3(5.0F, 4.0F, 3.0F);
  for (const DepositTarget target : {DepositTarget::kCamera, DepositTarget::kLight}) {
    const std::unique_ptr<RealtimeFrame> frame = makeFrame(scene, camera, {.target = target});
    frame->render(0);
    const Image image = frame->readSummed("irradiance_caustic"), caustic = frame->readSummed("caustic");
    for (int y = 0; y < kSize; ++y)
      for (int x = 0; x < kSize; ++x)
        for (int c = 0; c < 3; ++c) {
          ASSERT_NEAR(image.at(x, y)[c], irradiance[c], 0.01F * irradiance[c]) << x << ", " << y;
          ASSERT_NEAR(caustic.at(x, y)[c], 0.5F / kPi * irradiance[c], 0.01F * irradiance[c]) << x << ", " << y;
        }
  }
}

TEST_F(CausticMapTest, FiniteLightsAreTakenAsPoints) {
  // So far away that its size bears on nothing, a lamp is its point; and the sky's flux is that of its directions.
  SceneData scene = test::makeBallScene(test::makeGlass(1.5F), 64);
  scene.lights.push_back(test::makePoint(vec3(-10, 50, 10), vec3(10000)));
  const double of_point = test::meanOf(draw(scene, lookAtFloor())).x;
  scene.lights[0].radius = 0.5F;
  EXPECT_NEAR(test::meanOf(draw(scene, lookAtFloor(), {.points = 16}, 2)).x / of_point, 1.0, 0.05);
}

TEST_F(CausticMapTest, AccountsForEveryLight) {
  SceneData scene = makeSunlitBall(test::makeGlass(1.5F));
  scene.lights.push_back(test::makePoint(vec3(-1, 5, 1), vec3(30, 90, 10), 0.2F));
  const std::unique_ptr<RealtimeFrame> frame = makeFrame(scene, lookAtFloor());
  frame->render(0);
  const std::vector<Ledger> ledgers = static_cast<CausticMap*>(frame->technique())->account();
  ASSERT_EQ(ledgers.size(), 2U);
  EXPECT_EQ(ledgers[0].light, "sun");
  for (const Ledger& ledger : ledgers) {
    EXPECT_LE(std::abs(ledger.residual()), 1e-5);
    EXPECT_GT(ledger.deposited.x, 0.1 * ledger.emitted.x);
  }
}

TEST_F(CausticMapTest, NothingBendsLightNothingIsDrawn) {
  SceneData scene = makeSunlitBall(test::makeDiffuse(vec3(0.5F)));
  EXPECT_EQ(test::meanOf(draw(scene, lookAtFloor())).x, 0.0);
  SceneData dark = test::makeBallScene(test::makeGlass(1.5F), 64);
  EXPECT_EQ(test::meanOf(draw(dark, lookAtFloor())).x, 0.0);
}

}  // namespace
}  // namespace nephroid
