// Panes, cut-outs and lamps: what light and sight pass straight through.
#include <algorithm>
#include <cmath>

#include "frame/frame.h"
#include "support/gpu_fixture.h"
#include "support/tiny_scenes.h"

namespace nephroid {
namespace {

class PassableTest : public testing::GpuTest {
 protected:
  struct Layers {
    Image direct, emission;
  };
  static Layers render(const SceneData& scene, const Camera& camera, int size, std::uint32_t samples) {
    RealtimeFrame frame(device(), scene, camera, {.width = size, .height = size});
    for (std::uint32_t s = 0; s < samples; ++s) frame.render(s);
    return {frame.readSummed("direct"), frame.readSummed("emission")};
  }

  /// Means of `direct` and `emission` of frame and reference agree.
  static void expectLikeReference(const SceneData& scene, double tolerance, std::uint32_t samples = 256) {
    constexpr int kSize = 24;
    const Camera camera = makeCamera("eye", vec3(0.5F, 3, 4), vec3(0, 0.3F, 0), 0.6F);
    const Layers ours = render(scene, camera, kSize, samples);
    const RenderResult reference =
        test::renderReference(scene, camera, test::makeSettings(kSize, 256, 1, {"direct", "emission"}));
    const Image* layers[] = {&ours.direct, &ours.emission};
    for (int i = 0; i < 2; ++i) {
      const dvec3 a = test::meanOf(*layers[i]), b = test::meanOf(reference.image.layers[i].image);
      for (int c = 0; c < 3; ++c) EXPECT_NEAR(a[c], b[c], tolerance * b[c]) << reference.image.layers[i].name;
    }
  }
};

Material makePane(vec3 color, float transmission = 1.0F) {
  Material m;
  m.name = "pane";
  m.base_color = vec4(color, 1.0F);
  m.transmission = transmission;
  m.roughness = 0.0F;
  return m;
}

/// Share that a clear pane lets through straight on: 1 − 2R/(1 + R), R = ((n − 1)/(n + 1))².
double passStraight(double ior) {
  const double r = std::pow((ior - 1.0) / (ior + 1.0), 2);
  return 1.0 - 2.0 * r / (1.0 + r);
}

Camera lookDown() { return makeCamera("down", vec3(0, 3, 0), vec3(0), 0.0F, 1.0F); }

SceneData makeFloorUnderSun() {
  SceneData scene;
  test::addObject(scene, test::makeFloor(4.0), test::makeDiffuse(vec3(0.5F)));
  scene.lights.push_back(test::makeSun(vec3(0, -1, 0), vec3(2)));
  return scene;
}

Mesh makeLid(double y) { return makeRectangle("lid", dvec3(0, y, 0), dvec3(0, 0, 2), dvec3(2, 0, 0)); }

TEST_F(PassableTest, LightAndSightTakeTheColourOfPanes) {
  // Straight down through three panes and up again.
  SceneData scene = makeFloorUnderSun();
  const vec3 colors[] = {{0.9F, 0.5F, 0.2F}, {1.0F, 0.7F, 0.9F}, {0.3F, 0.6F, 1.0F}};
  dvec3 pass(1.0);
  for (int i = 0; i < 3; ++i) {
    test::addObject(scene, makeLid(0.5 + 0.2 * i), makePane(colors[i]));
    pass *= dvec3(colors[i]) * passStraight(1.5);
  }
  const Image direct = render(scene, lookDown(), 8, 1).direct;
  for (int y = 0; y < 8; ++y)
    for (int x = 0; x < 8; ++x)
      for (int c = 0; c < 3; ++c) {
        const double expected = 0.5 / kPi * 2.0 * pass[c] * pass[c];
        ASSERT_NEAR(direct.at(x, y)[c], expected, 2e-5 * expected) << x << ", " << y;
      }
}

TEST_F(PassableTest, PanesAreSurfacesForTheLayersOfGeometry) {
  SceneData scene = makeFloorUnderSun();
  test::addObject(scene, makeLid(0.5), makePane(vec3(0.5F)));
  RealtimeFrame frame(device(), scene, lookDown(), {.width = 4, .height = 4});
  EXPECT_EQ(frame.readGeometry("id").at(2, 2)[0], 2.0F);
  EXPECT_NEAR(frame.readGeometry("position").at(2, 2)[1], 0.5F, 1e-6F);
}

TEST_F(PassableTest, ObliquePanesAgreeWithTheReference) {
  SceneData scene = makeFloorUnderSun();
  scene.lights[0].direction = normalize(vec3(0.8F, -0.6F, 0.3F));
  test::addObject(scene, makeRectangle("upright", dvec3(0, 0.6, 0), dvec3(0.6, 0, 0.2), dvec3(0, 0.5, 0)),
                  makePane(vec3(0.9F, 0.6F, 0.3F)));
  expectLikeReference(scene, 0.003, 64);
}

TEST_F(PassableTest, HalfPanesShowThemselvesAndWhatIsBehind) {
  SceneData scene = makeFloorUnderSun();
  Material half = makePane(vec3(0.9F, 0.6F, 0.3F), 0.6F);
  half.emission = vec3(0.05F, 0.1F, 0.2F);
  half.double_sided = true;
  test::addObject(scene, makeRectangle("upright", dvec3(0, 0.6, 0), dvec3(0.6, 0, 0.2), dvec3(0, 0.5, 0)), half);
  expectLikeReference(scene, 0.01);
}

TEST_F(PassableTest, PartialCoverageIsAShareOfBoth) {
  SceneData scene = makeFloorUnderSun();
  Material veil = test::makeDiffuse(vec3(0.8F, 0.2F, 0.1F));
  veil.alpha_mode = AlphaMode::kBlend;
  veil.base_color.w = 0.3F;
  test::addObject(scene, makeLid(0.5), veil);
  expectLikeReference(scene, 0.01);
}

TEST_F(PassableTest, HolesOfMasksLetLightAndSightThrough) {
  SceneData scene = makeFloorUnderSun();
  scene.lights[0].direction = normalize(vec3(0.5F, -0.8F, 0.3F));
  Material fence = test::makeDiffuse(vec3(0.8F, 0.2F, 0.1F));
  fence.alpha_mode = AlphaMode::kMask;
  fence.base_color_texture.image = 0;
  fence.base_color_texture.nearest = true;
  ByteImage checker{4, 4, {}};
  for (int i = 0; i < 16; ++i)
    for (const int byte : {200, 100, 50, (i + i / 4) % 2 ? 255 : 0})
      checker.pixels.push_back(static_cast<std::uint8_t>(byte));
  scene.images.push_back({"checker", checker});
  Mesh lid = makeRectangle("lid", dvec3(0, 0.4, 0), dvec3(0, 0, 0.8), dvec3(0.8, 0, 0));
  lid.texcoords[0].clear();
  for (const vec3& p : lid.positions) lid.texcoords[0].emplace_back(p.x / 0.8F, p.z / 0.8F);
  test::addObject(scene, lid, fence);
  expectLikeReference(scene, 0.003);
}

TEST_F(PassableTest, WhatShinesIsTintedByThePaneBefore) {
  SceneData scene;
  scene.materials.emplace_back();
  Material lamp = test::makeDiffuse(vec3(0.0F));
  lamp.emission = vec3(3.0F, 2.0F, 1.0F);
  test::addObject(scene, test::makeFloor(4.0), lamp);
  test::addObject(scene, makeLid(0.5), makePane(vec3(0.5F, 0.25F, 1.0F)));
  const Image emission = render(scene, lookDown(), 4, 1).emission;
  const double pass = passStraight(1.5);
  EXPECT_NEAR(emission.at(1, 1)[0], 1.5 * pass, 1e-5);
  EXPECT_NEAR(emission.at(1, 1)[1], 0.5 * pass, 1e-5);
  EXPECT_NEAR(emission.at(1, 1)[2], 1.0 * pass, 1e-5);
}

TEST_F(PassableTest, LampsWithASizeAreSeen) {
  // A sphere and a wide sun, as the reference shows them; the sun lies low behind the floor's edge.
  SceneData scene;
  test::addObject(scene, test::makeFloor(2.0), test::makeDiffuse(vec3(0.5F)));
  scene.lights.push_back(test::makePoint(vec3(0.3F, 1, 0), vec3(2, 3, 4), 0.2F));
  Light spot = test::makePoint(vec3(-0.4F, 1, 0.5F), vec3(8, 6, 4), 0.15F);
  spot.kind = LightKind::kSpot;
  spot.direction = vec3(0, -0.6F, 0.8F);
  spot.outer_cone = 1.2F;
  scene.lights.push_back(spot);
  scene.lights.push_back(test::makeSun(vec3(0.05F, -0.05F, 1), vec3(1), 12.0F));
  constexpr int kSize = 48;
  const Camera camera = makeCamera("eye", vec3(0, 1, 4), vec3(0, 0.7F, 0), 0.6F);
  const Image ours = render(scene, camera, kSize, 64).emission;
  const RenderResult reference = test::renderReference(scene, camera, test::makeSettings(kSize, 256, 1, {"emission"}));
  const dvec3 a = test::meanOf(ours), b = test::meanOf(reference.image.layers[0].image);
  EXPECT_GT(b.x, 0.0);
  for (int c = 0; c < 3; ++c) EXPECT_NEAR(a[c], b[c], 0.01 * b[c]);
  // Radiance I/(πr²) at the middle of the sphere.
  EXPECT_GT(*std::max_element(ours.pixels.begin(), ours.pixels.end()), 4.0 / (kPi * 0.04) * 0.99);
}

}  // namespace
}  // namespace nephroid
