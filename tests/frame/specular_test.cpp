// What mirrors, glass and water show: closed forms, and the reference where it has no light that the frame leaves out.
#include <algorithm>
#include <cmath>

#include "core/optics/fresnel.shared.h"
#include "frame/frame.h"
#include "frame/triangle_tree.h"
#include "scene/load.h"
#include "support/gpu_fixture.h"
#include "support/tiny_scenes.h"
#include "trace/box_tree_builder.h"

namespace nephroid {
namespace {

class SpecularTest : public testing::GpuTest {
 protected:
  static FrameSettings makeSettings(int size, std::uint32_t max_events) {
    return {.width = size, .height = size, .box_tree_builder = buildBoxTree, .max_events = max_events};
  }

  static Image render(const SceneData& scene, const Camera& camera, int size, std::uint32_t samples,
                      std::uint32_t max_events = 12) {
    RealtimeFrame frame(device(), scene, camera, makeSettings(size, max_events));
    for (std::uint32_t s = 0; s < samples; ++s) frame.render(s);
    return frame.readSummed("specular");
  }

  /// The reference's `specular` without the caustics in it, which are no part of the frame.
  static Image renderReference(const SceneData& scene, const Camera& camera, int size, std::uint64_t samples,
                               int max_bounces) {
    RenderSettings settings = test::makeSettings(size, samples, 1, {"specular", "specular_caustic"});
    settings.params.set("max-bounces", std::to_string(max_bounces));
    const RenderResult result = test::renderReference(scene, camera, settings);
    Image specular = *result.image.find("specular");
    const Image& caustic = *result.image.find("specular_caustic");
    for (std::size_t i = 0; i < specular.pixels.size(); ++i) specular.pixels[i] -= caustic.pixels[i];
    return specular;
  }

  /// Means agree. @param max_bounces  of both: enough for what is seen, too few for indirect light on it
  static void expectMeanLikeReference(const SceneData& scene, int max_bounces, double tolerance,
                                      std::uint32_t samples = 128) {
    constexpr int kSize = 32;
    const Camera camera = makeCamera("eye", vec3(0, 3, 5), vec3(0, 1, 0), 0.6F);
    const dvec3 ours = test::meanOf(render(scene, camera, kSize, samples, static_cast<std::uint32_t>(max_bounces)));
    const dvec3 theirs = test::meanOf(renderReference(scene, camera, kSize, 512, max_bounces));
    for (int c = 0; c < 3; ++c) {
      EXPECT_GT(theirs[c], 0.0);
      EXPECT_NEAR(ours[c], theirs[c], tolerance * theirs[c]);
    }
  }
};

Material makeGlow(vec3 radiance) {
  Material m = test::makeDiffuse(vec3(0.0F));
  m.emission = radiance;
  m.double_sided = true;
  return m;
}

/// Looks along (0, −1, −1) at the origin, in parallel: incidence on a floor is 45° everywhere.
Camera lookAslant(float height) { return makeCamera("aslant", vec3(0, 2, 2), vec3(0), 0.0F, height); }

/// A large wall behind, which is what a mirror at the origin shows to `lookAslant`.
Mesh makeWall() { return makeRectangle("wall", dvec3(0, 2, -2), dvec3(4, 0, 0), dvec3(0, 1.9, 0)); }

Environment makeEvenSky(float radiance) {
  auto image = std::make_shared<Image>(8, 4, 3, radiance);
  return Environment{.radiance = image, .scale = 1.0F};
}

TEST_F(SpecularTest, MirrorsShowWhatIsBeforeThem) {
  SceneData scene;
  test::addObject(scene, test::makeFloor(2.0), test::makeMetal(vec3(0.9F, 0.6F, 0.3F)));
  test::addObject(scene, makeWall(), makeGlow(vec3(1, 2, 3)));
  const Image specular = render(scene, lookAslant(0.5F), 16, 1);
  const vec3 expected = vec3(1, 2, 3) * fresnelSchlick(std::sqrt(0.5F), vec3(0.9F, 0.6F, 0.3F));
  for (int y = 0; y < 16; ++y)
    for (int x = 0; x < 16; ++x)
      for (int c = 0; c < 3; ++c) ASSERT_NEAR(specular.at(x, y)[c], expected[c], 1e-5F * expected[c]) << x << ", " << y;
}

TEST_F(SpecularTest, MirrorsShowLitSurfacesAndTheirShadows) {
  // A mirror shows a diffuse wall under a point light, half of it in the shadow of a block: as the wall itself would
  // look to an eye behind the mirror.
  SceneData scene;
  test::addObject(scene, test::makeFloor(2.0), test::makeMetal(vec3(1.0F)));
  test::addObject(scene, makeWall(), test::makeDiffuse(vec3(0.5F)));
  test::addObject(scene, makeRectangle("block", dvec3(1, 2, -1), dvec3(1, 0, 0), dvec3(0, 2, 0)),
                  test::makeDiffuse(vec3(0.0F)));
  scene.lights.push_back(test::makePoint(vec3(0, 3, 1), vec3(10)));
  constexpr int kSize = 32;
  const Image specular = render(scene, lookAslant(0.5F), kSize, 1);
  for (int x = 2; x < kSize - 2; ++x) {
    const int y = kSize / 2;
    const double across = 0.5 * ((x + 0.5) / kSize - 0.5), up = -0.5 * ((y + 0.5) / kSize - 0.5);
    // Of the picture's plane through the origin; a mirror image looks along (0, 1, −1) from where the ray meets it.
    const dvec3 on_mirror(across, 0.0, -up * std::sqrt(2.0));
    const dvec3 place = on_mirror + (on_mirror.z + 2.0) * dvec3(0, 1, -1);
    const dvec3 to_light = dvec3(0, 3, 1) - place;
    const double squared = dot(to_light, to_light);
    const double lit = 0.5 / kPi * 10.0 * (to_light.z / std::sqrt(squared)) / squared;
    if (std::abs(across) < 0.02) continue;
    ASSERT_NEAR(specular.at(x, y)[0], across > 0.0 ? 0.0 : lit, 1e-4 * lit) << x;
  }
}

TEST_F(SpecularTest, AnEvenSkyMakesClearGlassInvisible) {
  // What a ball reflects and lets through is 1 together wherever it comes from.
  SceneData scene;
  test::addObject(scene, makeSphere("ball", dvec3(0), 1.0, 128), test::makeGlass(1.5F));
  scene.environment = makeEvenSky(1.0F);
  constexpr int kSize = 48;
  struct Case {
    float ortho;
    std::uint32_t spacing;
    float tolerance;  // of what lies between the pixels that are followed, the share that is seen
  };
  for (const Case& c : {Case{0.0F, 1, 1e-4F}, Case{2.4F, 1, 1e-4F}, Case{0.0F, 4, 0.02F}, Case{2.4F, 4, 0.02F}}) {
    const Camera camera = makeCamera("eye", vec3(0.3F, 1.0F, 4), vec3(0), 0.6F, c.ortho);
    FrameSettings settings = makeSettings(kSize, 64);
    settings.specular_spacing = c.spacing;
    RealtimeFrame frame(device(), scene, camera, settings);
    frame.render(0);
    const Image specular = frame.readSummed("specular"), emission = frame.readSummed("emission");
    double sum = 0;
    int seen = 0, odd = 0;
    for (int y = 0; y < kSize; ++y)
      for (int x = 0; x < kSize; ++x) {
        const float both = specular.at(x, y)[0] + emission.at(x, y)[0];
        sum += static_cast<double>(both);
        seen += specular.at(x, y)[0] > 0.0F ? 1 : 0;
        odd += std::abs(both - 1.0F) > c.tolerance ? 1 : 0;
      }
    EXPECT_GT(seen, 500);
    // At the rim, where shading normals lean over the horizon; and where chances lie between those of the corners, a
    // pixel may show both or none of what it chooses from.
    EXPECT_LE(odd, seen / (c.spacing == 1 ? 100 : 40)) << c.spacing;
    EXPECT_NEAR(sum / (kSize * kSize), 1.0, 2e-3);
  }
}

TEST_F(SpecularTest, ASlabDisplacesWhatLiesBelow) {
  // The edge of a glowing half floor, looked at 45° aslant through a slab: moved by d(tan θ − tan θ').
  constexpr double kThickness = 0.3;
  SceneData scene;
  test::addObject(scene, makeRectangle("half", dvec3(0, -1, -3), dvec3(0, 0, 2), dvec3(2, 0, 0)), makeGlow(vec3(1)));
  test::addObject(scene, makeBox("slab", dvec3(-2, -kThickness, -2), dvec3(2, 0, 2)), test::makeGlass(1.5F));
  constexpr int kSize = 200;
  constexpr double kHeight = 1.2;
  const Camera camera = makeCamera("aslant", vec3(0, 2, 2), vec3(0), 0.0F, static_cast<float>(kHeight));
  const Image specular = render(scene, camera, kSize, 1);
  // Without the slab a ray through (0, 0, z) of the upper face meets the floor, 1 m below, at z − 1.
  const double sin_inside = std::sqrt(0.5) / 1.5;
  const double displaced = kThickness * (1.0 - sin_inside / std::sqrt(1.0 - sin_inside * sin_inside));
  const double expected_z = -displaced;  // of the upper face, where the edge is seen
  // Of each row, because a few paths are drawn to be reflected inside.
  const auto isBright = [&](int y) {
    float sum = 0.0F;
    for (int x = 0; x < kSize; ++x) sum += specular.at(x, y)[0];
    return sum > 0.5F * kSize;
  };
  int row = 0;
  while (row < kSize && isBright(row)) ++row;
  const double seen_z = (static_cast<double>(row) / kSize - 0.5) * kHeight * std::sqrt(2.0);
  EXPECT_NEAR(seen_z, expected_z, 1.5 * kHeight * std::sqrt(2.0) / kSize);
}

TEST_F(SpecularTest, MediaAbsorbAlongThePath) {
  // Straight down through a coloured slab onto a glowing floor: T²a/(1 − R²a²) with a = exp(−σd).
  constexpr double kThickness = 0.3;
  Material glass = test::makeGlass(1.5F);
  glass.attenuation_color = vec3(0.9F, 0.5F, 0.1F);
  glass.attenuation_distance = 0.5F;
  SceneData scene;
  test::addObject(scene, test::makeFloor(4.0, -1.0), makeGlow(vec3(1)));
  test::addObject(scene, makeBox("slab", dvec3(-1, -kThickness, -1), dvec3(1, 0, 1)), glass);
  const Camera camera = makeCamera("down", vec3(0, 3, 0), vec3(0), 0.0F, 1.0F);
  const dvec3 mean = test::meanOf(render(scene, camera, 32, 64));
  for (int c = 0; c < 3; ++c) {
    const double r = 0.04, a = std::pow(static_cast<double>(glass.attenuation_color[c]), kThickness / 0.5);
    const double expected = (1 - r) * (1 - r) * a / (1 - r * r * a * a);
    EXPECT_NEAR(mean[c], expected, 0.003 * expected);
  }
}

TEST_F(SpecularTest, PanesReflectByBothFaces) {
  Material pane = test::makeGlass(1.5F);
  pane.thickness = 0.0F;
  SceneData scene;
  test::addObject(scene, test::makeFloor(2.0), pane);
  test::addObject(scene, makeWall(), makeGlow(vec3(1, 2, 3)));
  const Image specular = render(scene, lookAslant(0.5F), 16, 1);
  const float r = fresnelDielectric(std::sqrt(0.5F), 1.0F / 1.5F);
  for (int c = 0; c < 3; ++c) ASSERT_NEAR(specular.at(5, 9)[c], static_cast<float>(c + 1) * fresnelThinPane(r), 1e-4F);
}

TEST_F(SpecularTest, BallsShowTheFloorAsTheReferenceDoes) {
  for (const Material& material : {test::makeGlass(1.5F), test::makeMetal(vec3(0.9F, 0.7F, 0.3F))}) {
    SceneData scene = test::makeBallScene(material, 64);
    scene.lights.push_back(test::makePoint(vec3(2, 4, 3), vec3(60)));
    expectMeanLikeReference(scene, material.metallic > 0.0F ? 2 : 3, 0.01);
  }
}

TEST_F(SpecularTest, RoughInterfacesSpreadWhatTheyShow) {
  // The lamp's image through both faces has rare and very bright samples, hence the many and the wide tolerance.
  for (const Material& material : {test::makeGlass(1.5F, 0.49F), test::makeMetal(vec3(0.9F, 0.7F, 0.3F), 0.4F)}) {
    SceneData scene = test::makeBallScene(material, 64);
    scene.lights.push_back(test::makePoint(vec3(2, 4, 3), vec3(60)));
    expectMeanLikeReference(scene, material.metallic > 0.0F ? 2 : 3, 0.03, 512);
  }
}

TEST_F(SpecularTest, LampsAndTheSkyAreSeenThroughGlass) {
  SceneData scene = test::makeBallScene(test::makeGlass(1.5F), 64);
  scene.lights.push_back(test::makePoint(vec3(1, 4, -3), vec3(60), 0.8F));
  scene.environment = makeEvenSky(0.3F);
  expectMeanLikeReference(scene, 6, 0.02, 256);
}

TEST_F(SpecularTest, HollowBallsAreGlassAroundAir) {
  SceneData scene = test::makeBallScene(test::makeGlass(1.5F), 64);
  // The inner face looks inwards: out of the glass.
  Mesh inner = makeSphere("inner", dvec3(0, 1.2, 0), 0.9, 64);
  for (uvec3& t : inner.triangles) std::swap(t.y, t.z);
  for (vec3& n : inner.normals) n = -n;
  test::addObject(scene, inner, test::makeGlass(1.5F));
  scene.meshes.back().material = scene.meshes[1].material;
  scene.instances.back().object = scene.instances[1].object;
  scene.lights.push_back(test::makePoint(vec3(2, 4, 3), vec3(60)));
  expectMeanLikeReference(scene, 6, 0.015);
}

TEST_F(SpecularTest, NestedSolidsRuleByPriority) {
  // A ball of water that reaches into one of glass; either may rule where they overlap.
  for (const int priority : {-1, 0, 1}) {
    SceneData scene = test::makeBallScene(test::makeGlass(1.5F), 64);
    Material water = test::makeGlass(1.33F);
    water.priority = priority;
    test::addObject(scene, makeSphere("water", dvec3(0.6, 1.2, 0), 0.8, 64), water);
    scene.lights.push_back(test::makePoint(vec3(2, 4, 3), vec3(60)));
    SCOPED_TRACE(priority);
    expectMeanLikeReference(scene, 6, 0.02);
  }
}

/// A built-in scene, its floor a checker of squares of 2 cm.
SceneData loadCheckered(const std::string& name) {
  SceneData scene = loadScene("builtin:" + name);
  const ByteImage checker{2, 2, {255, 255, 255, 255, 25, 25, 25, 255, 25, 25, 25, 255, 255, 255, 255, 255}};
  scene.images.push_back({"checker", checker});
  for (Mesh& mesh : scene.meshes) {
    Material& material = scene.materials[mesh.material];
    if (material.name != "floor") continue;
    material.base_color_texture.image = static_cast<std::uint32_t>(scene.images.size() - 1);
    material.base_color_texture.nearest = true;
    mesh.texcoords[0].clear();
    for (const vec3& p : mesh.positions) mesh.texcoords[0].emplace_back(p.x / 0.04F, p.z / 0.04F);
  }
  return scene;
}

/// Share of the pixels whose value is none that the reference has within so many pixels.
double shareDisplaced(const Image& ours, const Image& theirs, int reach) {
  int displaced = 0, seen = 0;
  const float white = *std::max_element(theirs.pixels.begin(), theirs.pixels.end());
  for (int y = reach; y < ours.height - reach; ++y)
    for (int x = reach; x < ours.width - reach; ++x) {
      float lowest = kInfinity, highest = 0.0F;
      for (int j = -reach; j <= reach; ++j)
        for (int i = -reach; i <= reach; ++i) {
          lowest = std::min(lowest, theirs.at(x + i, y + j)[1]);
          highest = std::max(highest, theirs.at(x + i, y + j)[1]);
        }
      if (highest == 0.0F) continue;
      ++seen;
      const float value = ours.at(x, y)[1], slack = 0.1F * highest + 0.003F * white;
      displaced += value < lowest - slack || value > highest + slack ? 1 : 0;
    }
  return static_cast<double>(displaced) / seen;
}

TEST_F(SpecularTest, CheckersAreSeenWhereTheReferenceSeesThem) {
  constexpr int kSize = 96;
  for (const std::string name : {"sphere", "slab", "ring"}) {
    const SceneData scene = loadCheckered(name);
    // So many that neither's noise leaves what the other has nearby.
    const Image ours = render(scene, scene.cameras[0], kSize, 256);
    const Image theirs = renderReference(scene, scene.cameras[0], kSize, 256, 12);
    const double two = shareDisplaced(ours, theirs, 2);
    RecordProperty(name + "_displaced_by_two", std::to_string(two));
    EXPECT_LT(two, 0.005) << name;
  }
}

TEST_F(SpecularTest, WhatLiesBetweenFollowedPixelsIsWhatTheySee) {
  // A single frame of each: apart from what chance decides in a pixel, in both alike, all lines lie within two pixels.
  constexpr int kSize = 128;
  for (const std::string name : {"sphere", "slab", "ring", "pool"}) {
    const SceneData scene = loadCheckered(name);
    FrameSettings settings = makeSettings(kSize, 12);
    settings.specular_spacing = 1;
    RealtimeFrame all(device(), scene, scene.cameras[0], settings);
    all.render(0);
    const Image followed = all.readSummed("specular");
    settings.specular_spacing = 4;
    RealtimeFrame some(device(), scene, scene.cameras[0], settings);
    some.render(0);
    const Image between = some.readSummed("specular");
    for (std::uint32_t s = 1; s < 32; ++s) all.render(s);
    const Image mean = all.readSummed("specular");
    const double chance = shareDisplaced(followed, mean, 2), both = shareDisplaced(between, mean, 2);
    RecordProperty(name + "_followed", std::to_string(chance));
    RecordProperty(name + "_between", std::to_string(both));
    EXPECT_LT(both, chance + 0.005) << name;
    EXPECT_NE(between.pixels, followed.pixels) << name;
    // Equal runs give equal pictures, also after others.
    some.reset();
    some.render(3);
    some.reset();
    some.render(0);
    EXPECT_EQ(some.readSummed("specular").pixels, between.pixels) << name;
  }
}

TEST_F(SpecularTest, EveryPixelIsShownOnceWhateverTheCells) {
  SceneData scene;
  test::addObject(scene, test::makeFloor(2.0), test::makeMetal(vec3(1.0F)));
  test::addObject(scene, makeWall(), makeGlow(vec3(1)));
  struct Size {
    int width, height;
  };
  for (const std::uint32_t spacing : {3U, 4U}) {
    FrameSettings settings = makeSettings(8, 12);
    settings.specular_spacing = spacing;
    RealtimeFrame frame(device(), scene, lookAslant(0.5F), settings);
    for (const Size size : {Size{1, 1}, Size{1, 9}, Size{2, 2}, Size{5, 4}, Size{37, 22}}) {
      frame.resize(size.width, size.height);
      // All places of the grid.
      for (std::uint32_t s = 0; s < 16; ++s) frame.render(s);
      for (const float value : frame.readSummed("specular").pixels)
        ASSERT_NEAR(value, 1.0F, 1e-5F) << size.width << " x " << size.height << " by " << spacing;
    }
  }
}

TEST_F(SpecularTest, WhatLiesBetweenConverges) {
  // The grid goes through all its places, and what chance decides is the same mean: of a lit checker in glass and
  // metal.
  for (const std::string name : {"sphere", "ring"}) {
    const SceneData scene = loadCheckered(name);
    Image means[2];
    for (int i = 0; i < 2; ++i) {
      FrameSettings settings = makeSettings(64, 12);
      settings.specular_spacing = i == 0 ? 1 : 4;
      RealtimeFrame frame(device(), scene, scene.cameras[0], settings);
      for (std::uint32_t s = 0; s < 128; ++s) frame.render(s);
      means[i] = frame.readSummed("specular");
    }
    const double all = test::meanOf(means[0]).x;
    EXPECT_NEAR(test::meanOf(means[1]).x, all, 0.005 * all) << name;
    EXPECT_LT(shareDisplaced(means[1], means[0], 1), 0.02) << name;
  }
}

TEST_F(SpecularTest, IsTheSameHoweverTheTreeIsKept) {
  // What is a hundred kilometres away widens the grid of the tree's boxes until they are kept as floats; if it has very
  // many triangles, the tree also has one order for all directions. Neither is seen.
  const SceneData near = loadScene("builtin:sphere?segments=32");
  const Image expected = render(near, near.cameras[0], 48, 2);
  for (const char* name : {"builtin:sphere?segments=8", "builtin:sphere?segments=650"}) {
    SceneData scene = near;
    const SceneData far = loadScene(name);
    const auto most = [](const Mesh& a, const Mesh& b) { return a.triangles.size() < b.triangles.size(); };
    Mesh ball = *std::ranges::max_element(far.meshes, most);
    for (vec3& p : ball.positions) p.x += 1e5F;
    test::addObject(scene, ball, test::makeDiffuse(vec3(0.5F)));
    const TreeTables tables = makeTreeTables(scene, buildBoxTree);
    ASSERT_FALSE(tables.compact);
    ASSERT_EQ(tables.order_count, ball.triangles.size() > 400'000 ? 1U : 8U);
    const Image image = render(scene, near.cameras[0], 48, 2);
    for (std::size_t i = 0; i < expected.pixels.size(); ++i) ASSERT_FLOAT_EQ(image.pixels[i], expected.pixels[i]) << i;
  }
}

TEST_F(SpecularTest, MayBeAddedLate) {
  SceneData scene;
  test::addObject(scene, test::makeFloor(2.0), test::makeMetal(vec3(0.9F, 0.6F, 0.3F)));
  test::addObject(scene, makeWall(), makeGlow(vec3(1, 2, 3)));
  FrameSettings settings = makeSettings(16, 12);
  RealtimeFrame whole(device(), scene, lookAslant(0.5F), settings);
  whole.render(0);
  settings.specular = false;
  RealtimeFrame late(device(), scene, lookAslant(0.5F), settings);
  late.render(0);
  EXPECT_EQ(test::meanOf(late.readSummed("specular")), dvec3(0));
  late.addSpecular();
  late.render(0);
  EXPECT_GT(test::meanOf(late.readSummed("specular")).x, 0.0);
  EXPECT_EQ(late.readSummed("specular").pixels, whole.readSummed("specular").pixels);
  EXPECT_EQ(late.readSummed("emission").pixels, whole.readSummed("emission").pixels);
}

TEST_F(SpecularTest, NothingIsSpecularWithoutABuilder) {
  SceneData scene;
  test::addObject(scene, test::makeFloor(2.0), test::makeMetal(vec3(0.9F, 0.6F, 0.3F)));
  test::addObject(scene, makeWall(), makeGlow(vec3(1, 2, 3)));
  FrameSettings settings = makeSettings(16, 12);
  EXPECT_TRUE(describeFrameLimits(scene, settings).empty());
  settings.box_tree_builder = nullptr;
  RealtimeFrame frame(device(), scene, lookAslant(0.5F), settings);
  frame.render(0);
  frame.objectsMoved();
  frame.render(0);
  EXPECT_EQ(test::meanOf(frame.readSummed("specular")), dvec3(0));
  ASSERT_EQ(describeFrameLimits(scene, settings).size(), 1U);
  EXPECT_NE(describeFrameLimits(scene, settings)[0].find("specular is black"), std::string::npos);
}

TEST_F(SpecularTest, DispersionKeepsWhiteWhite) {
  Material flint = test::makeGlass(1.7F);
  flint.dispersion = 2.0F;
  SceneData scene = test::makeBallScene(flint, 64);
  scene.lights.push_back(test::makePoint(vec3(2, 4, 3), vec3(60)));
  expectMeanLikeReference(scene, 4, 0.02);
}

}  // namespace
}  // namespace nephroid
