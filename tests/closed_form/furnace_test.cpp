#include "closed_form/furnace.h"

#include <gtest/gtest.h>

#include <string>

#include "closed_form/optics.h"

namespace nephroid::closed_form {
namespace {

/// A box has true normals; so it tells scattering from what interpolated normals do.
Mesh makeUnitBox() { return makeBox("box", dvec3(-0.6), dvec3(0.6)); }

void record(const FurnaceResult& r) {
  ::testing::Test::RecordProperty("mean_error", fmt::format("{:.6f}", r.mean - 1.0));
  ::testing::Test::RecordProperty("range", fmt::format("{:.6f} .. {:.6f}", r.lowest, r.highest));
}

TEST(WhiteFurnace, HidesAWhiteDiffuseBox) {
  const FurnaceResult r = burn(makeFurnaceScene(makeUnitBox(), makeDiffuse("white", vec3(1.0F))), 64);
  record(r);
  // Every path scatters once and ends in L; only how directions are weighted is noisy, a pixel of 64 paths by 1.2 %:
  // the bounds are five times that.
  EXPECT_NEAR(r.mean, 1.0, 1e-3);
  EXPECT_NEAR(r.lowest, 1.0, 0.06);
  EXPECT_NEAR(r.highest, 1.0, 0.06);
}

TEST(WhiteFurnace, HidesAPerfectMirrorExactly) {
  const FurnaceResult box = burn(makeFurnaceScene(makeUnitBox(), makeMirror("mirror", vec3(1.0F))), 4);
  EXPECT_NEAR(box.lowest, 1.0, 1e-5);
  EXPECT_NEAR(box.highest, 1.0, 1e-5);
  // On a ball of facets the interpolated normal sends a few rays at the rim through the true surface: they are lost.
  const FurnaceResult ball =
      burn(makeFurnaceScene(makeSphere("ball", dvec3(0.0), 0.8, 256), makeMirror("mirror", vec3(1.0F))), 4);
  record(ball);
  EXPECT_NEAR(ball.mean, 1.0, 1e-3);
  EXPECT_NEAR(ball.highest, 1.0, 1e-5);
}

TEST(WhiteFurnace, HidesSmoothGlass) {
  // Each path picks reflection or transmission in proportion and carries L unchanged, n² in and 1/n² out, without
  // noise; a few are lost to the bounce limit and at the rim of the ball's facets.
  for (const bool ball : {false, true}) {
    Mesh mesh = ball ? makeSphere("ball", dvec3(0.0), 0.8, 256) : makeUnitBox();
    const FurnaceResult r = burn(makeFurnaceScene(std::move(mesh), makeWhiteGlass(0.0F)), 16);
    record(r);
    EXPECT_NEAR(r.mean, 1.0, 5e-4) << (ball ? "ball" : "box");
    EXPECT_NEAR(r.highest, 1.0, 1e-5) << (ball ? "ball" : "box");
  }
}

TEST(WhiteFurnace, IsBrighterInsideGlassByTheSquareOfItsIndex) {
  // Seen from the middle of a ball, which every ray leaves at right angles: (1 − R) n² L from outside, the rest
  // reflected.
  SceneData scene = makeFurnaceScene(makeSphere("ball", dvec3(0.0), 0.8, 128), makeWhiteGlass(0.0F));
  scene.cameras[0].eye = vec3(0.0F);
  const FurnaceResult r = burn(scene, 16);
  record(r);
  EXPECT_NEAR(r.mean, 1.5 * 1.5, 2e-3);
}

TEST(WhiteFurnace, HidesVarnishOverAWhiteBase) {
  const FurnaceResult r = burn(makeFurnaceScene(makeUnitBox(), makeVarnish()), 256, 32);
  record(r);
  EXPECT_NEAR(r.mean, 1.0, 2e-3);
}

TEST(WhiteFurnace, NeverGainsInRoughGlass) {
  // One scattering event per interface: light that would meet a second microfacet is lost, never made. Of this picture
  // (two interfaces, several total reflections at glancing angles) that is 3.6 % at alpha 0.09.
  for (const float roughness : {0.1F, 0.3F}) {
    const FurnaceResult r = burn(makeFurnaceScene(makeUnitBox(), makeWhiteGlass(roughness)), 256, 32);
    record(r);
    EXPECT_LE(r.mean, 1.001) << roughness;
    EXPECT_GE(r.mean, roughness < 0.2F ? 0.99 : 0.95) << roughness;
  }
}

class RoughMetal : public ::testing::TestWithParam<double> {};

TEST_P(RoughMetal, KeepsTheDirectionalAlbedoOfItsMicrofacets) {
  // A flat plate that fills the picture, seen at an angle by parallel rays.
  constexpr float kRoughness = 0.45F;
  const double angle = radiansD(GetParam());
  Material metal = makeMirror("metal", vec3(1.0F));
  metal.roughness = kRoughness;
  SceneData scene;
  addObject(scene, makeRectangle("plate", dvec3(0.0), {50, 0, 0}, {0, 0, -50}), metal);
  scene.environment = makeFurnace();
  const vec3 eye(0, static_cast<float>(std::cos(angle)), static_cast<float>(std::sin(angle)));
  scene.cameras.push_back(makeCamera("parallel", eye * 10.0F, vec3(0.0F), 0.5F, 1.0F));
  const FurnaceResult r = burn(scene, 256, 16);
  const double predicted = microfacetAlbedo(std::cos(angle), static_cast<double>(kRoughness * kRoughness));
  RecordProperty("mean_error", fmt::format("{:.6f} of {:.6f}", r.mean - predicted, predicted));
  EXPECT_NEAR(r.mean, predicted, 2e-3);
  EXPECT_LT(predicted, 1.0);
}
INSTANTIATE_TEST_SUITE_P(Angles, RoughMetal, ::testing::Values(20.0, 60.0, 75.0));

TEST(WhiteFurnace, LightsAPlaneWithPiTimesItsRadiance) {
  SceneData scene;
  addObject(scene, makeRectangle("floor", dvec3(0.0), {10, 0, 0}, {0, 0, -10}), makeDiffuse("floor", vec3(0.5F)));
  scene.environment = makeFurnace();
  addCamera(scene, {0, 2, 0.5F}, {0, 0, 0}, 40);
  const FurnaceResult r = burn(scene, 256, 32, "irradiance");
  record(r);
  EXPECT_NEAR(r.mean / kPiD, 1.0, 2e-3);
}

}  // namespace
}  // namespace nephroid::closed_form
