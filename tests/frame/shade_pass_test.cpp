#include "frame/shade_pass.h"

#include <algorithm>
#include <cmath>
#include <string>

#include "frame/frame.h"
#include "support/gpu_fixture.h"
#include "support/tiny_scenes.h"

namespace nephroid {
namespace {

// No multiples of a block's side.
constexpr int kWidth = 121, kHeight = 86;

class ShadePassTest : public testing::GpuTest {
 protected:
  /// The mean of three samples: "direct" and "emission".
  static std::vector<Image> render(const SceneData& scene, const Camera& camera, Shading shading) {
    RealtimeFrame frame(device(), scene, camera, {.width = kWidth, .height = kHeight, .shading = shading});
    for (std::uint32_t s = 0; s < 3; ++s) frame.render(s);
    return {frame.readSummed("direct"), frame.readSummed("emission")};
  }

  static bool ranBlocks(const SceneData& scene, const Camera& camera) {
    RealtimeFrame frame(device(), scene, camera, {.width = 16, .height = 16, .shading = Shading::kBlocks});
    frame.render(0);
    return std::ranges::any_of(frame.passTimes(), [](const gpu::PassTime& t) { return t.name == "shade blocks"; });
  }
};

Camera lookAtBall() { return makeCamera("eye", vec3(0, 4, 6), vec3(0, 0.5F, 0), 0.7F); }

/// Share of the pixels in which two pictures differ by more than rounding: where a spot's light fades to nothing, it is
/// the rounding of what is there elsewhere.
double shareThatDiffers(const Image& a, const Image& b) {
  const float brightest = *std::max_element(a.pixels.begin(), a.pixels.end());
  int differ = 0;
  for (int y = 0; y < a.height; ++y)
    for (int x = 0; x < a.width; ++x) {
      const vec3 p = a.rgb(x, y), q = b.rgb(x, y);
      for (int c = 0; c < 3; ++c)
        if (std::abs(p[c] - q[c]) > 1e-4F * std::max(p[c], q[c]) + 1e-5F * brightest) {
          ++differ;
          break;
        }
    }
  return differ / static_cast<double>(a.width * a.height);
}

/// Blocks and pixels ask for shadows in two ways, which round differently at the very edges: a pixel in a thousand.
void expectSame(const std::vector<Image>& blocks, const std::vector<Image>& pixels) {
  for (std::size_t i = 0; i < blocks.size(); ++i) {
    EXPECT_LE(shareThatDiffers(blocks[i], pixels[i]), 1e-3) << i;
    const dvec3 ours = test::meanOf(blocks[i]), theirs = test::meanOf(pixels[i]);
    for (int c = 0; c < 3; ++c) EXPECT_NEAR(ours[c], theirs[c], 5e-4 * theirs[c]) << i;
  }
}

TEST_F(ShadePassTest, BlocksShowWhatPixelsShow) {
  Light spot = test::makePoint(vec3(-2, 4, 1), vec3(60, 50, 40));
  spot.kind = LightKind::kSpot;
  spot.direction = normalize(vec3(2, -4, -1));
  spot.inner_cone = 0.3F, spot.outer_cone = 0.5F;
  const Light point = test::makePoint(vec3(2, 4, 1), vec3(60, 50, 40)),
              sun = test::makeSun(vec3(1, -2, 0.5F), vec3(3, 4, 5));
  const std::vector<std::vector<Light>> cases{{spot}, {sun}, {point, sun}};
  for (std::size_t i = 0; i < cases.size(); ++i) {
    SCOPED_TRACE(i);
    SceneData scene = test::makeBallScene(test::makeDiffuse(vec3(0.8F, 0.5F, 0.2F)), 24);
    scene.lights = cases[i];
    const std::vector<Image> blocks = render(scene, lookAtBall(), Shading::kBlocks);
    expectSame(blocks, render(scene, lookAtBall(), Shading::kPixels));
    EXPECT_GT(test::meanOf(blocks[0]).x, 0.0);
  }
}

TEST_F(ShadePassTest, BlocksShowGlossAndWhatShines) {
  Material varnish = test::makeDiffuse(vec3(0.7F, 0.3F, 0.1F));
  varnish.roughness = 0.6F;
  Material lamp = test::makeDiffuse(vec3(0.2F));
  lamp.emission = vec3(2, 3, 4);
  SceneData scene = test::makeBallScene(test::makeMetal(vec3(0.9F, 0.7F, 0.3F), 0.7F), 24);
  scene.materials[0] = varnish;
  test::addObject(scene, makeSphere("lamp", dvec3(2, 0.5, 1), 0.4, 16), lamp);
  const std::vector<Image> blocks = render(scene, lookAtBall(), Shading::kBlocks);
  expectSame(blocks, render(scene, lookAtBall(), Shading::kPixels));
  EXPECT_GT(test::meanOf(blocks[1]).x, 0.0);
}

TEST_F(ShadePassTest, ManyLightsAndPanesAreLitPixelByPixel) {
  SceneData scene = test::makeBallScene(test::makeDiffuse(vec3(0.8F)), 24);
  for (int i = 0; i < 3; ++i) scene.lights.push_back(test::makePoint(vec3(2 - i, 4, 1), vec3(20)));
  EXPECT_FALSE(ranBlocks(scene, lookAtBall()));
  scene.lights.resize(1);
  EXPECT_TRUE(ranBlocks(scene, lookAtBall()));
  Material pane = test::makeGlass(1.5F);
  pane.thickness = 0.0F;
  scene.materials[1] = pane;
  EXPECT_FALSE(ranBlocks(scene, lookAtBall()));
}

/// A square of `side` × `side` squares, each of two triangles.
Mesh makeTiles(const char* name, int side, double size, double y) {
  Mesh mesh;
  mesh.name = name;
  for (int j = 0; j <= side; ++j)
    for (int i = 0; i <= side; ++i)
      mesh.positions.emplace_back((static_cast<float>(i) / side - 0.5F) * size, y,
                                  (static_cast<float>(j) / side - 0.5F) * size);
  for (int j = 0; j < side; ++j)
    for (int i = 0; i < side; ++i) {
      const std::uint32_t a = j * (side + 1) + i, b = a + 1, c = a + side + 1, d = c + 1;
      mesh.triangles.emplace_back(a, c, b);
      mesh.triangles.emplace_back(b, c, d);
    }
  return mesh;
}

TEST_F(ShadePassTest, FlatSurfacesDoNotShadowThemselves) {
  // Few enough tiles that blocks lie within them, a lamp and a sun low over them, and something far below, so that the
  // tiles are no backdrop that is left out of the lists.
  for (const Light& light :
       {test::makePoint(vec3(3, 0.05F, 0), vec3(5)), test::makeSun(vec3(-1, -0.02F, 0.3F), vec3(5))}) {
    SceneData scene;
    test::addObject(scene, makeTiles("tiles", 7, 4.0, 0.0), test::makeDiffuse(vec3(0.6F)));
    test::addObject(scene, test::makeFloor(0.1, -5.0), test::makeDiffuse(vec3(0.6F)));
    scene.lights.push_back(light);
    const Camera camera = makeCamera("down", vec3(0, 3, 0), vec3(0), 0.0F, 2.0F);
    const Image direct = render(scene, camera, Shading::kBlocks)[0];
    for (int y = 0; y < kHeight; ++y)
      for (int x = 0; x < kWidth; ++x) ASSERT_GT(direct.at(x, y)[0], 0.0F) << x << ", " << y;
  }
}

TEST_F(ShadePassTest, NoLightSlipsBetweenTriangles) {
  // Below a closed sheet of many triangles, large and thin and small ones, there is no light at all.
  for (const Light& light :
       {test::makePoint(vec3(0.1F, 6, 0.2F), vec3(50)), test::makeSun(vec3(0.1F, -1, 0.2F), vec3(5))})
    for (const int side : {1, 9, 60}) {
      SCOPED_TRACE(side);
      SceneData scene;
      test::addObject(scene, test::makeFloor(4.0), test::makeDiffuse(vec3(0.6F)));
      mat4 stretched(1.0F);
      stretched[0][0] = 1.7F;
      test::addObject(scene, makeTiles("sheet", side, 8.0, 2.0), test::makeDiffuse(vec3(0.0F)), stretched);
      scene.lights.push_back(light);
      // From below the sheet.
      const Camera camera = makeCamera("below", vec3(0, 1.5F, 0), vec3(0), 1.2F);
      const Image direct = render(scene, camera, Shading::kBlocks)[0];
      EXPECT_EQ(*std::max_element(direct.pixels.begin(), direct.pixels.end()), 0.0F);
    }
}

}  // namespace
}  // namespace nephroid
