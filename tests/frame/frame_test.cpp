#include "frame/frame.h"

#include <algorithm>
#include <cmath>

#include "support/gpu_fixture.h"
#include "support/tiny_scenes.h"
#include "trace/box_tree_builder.h"

namespace nephroid {
namespace {

class FrameTest : public testing::GpuTest {
 protected:
  static Image renderDirect(const SceneData& scene, const Camera& camera, int size, std::uint32_t samples) {
    RealtimeFrame frame(device(), scene, camera, {.width = size, .height = size});
    for (std::uint32_t s = 0; s < samples; ++s) frame.render(s);
    return frame.readSummed("direct");
  }
};

Camera lookDown() { return makeCamera("down", vec3(0, 3, 0), vec3(0), 0.0F, 2.0F); }

/// Floor of albedo 0.6 under a light, seen from straight above: 2 m across.
SceneData makeFloorScene(Light light) {
  SceneData scene;
  test::addObject(scene, test::makeFloor(4.0), test::makeDiffuse(vec3(0.6F)));
  scene.lights.push_back(std::move(light));
  return scene;
}

/// The point of the floor at a pixel's centre, as `lookDown` shows it with −z on top.
dvec3 floorAt(int x, int y, int size) { return {(x + 0.5) * 2.0 / size - 1.0, 0.0, (y + 0.5) * 2.0 / size - 1.0}; }

TEST_F(FrameTest, DirectOfAPointLightIsItsClosedForm) {
  // L = albedo/π · I·h/d³.
  constexpr int kSize = 32;
  const SceneData scene = makeFloorScene(test::makePoint(vec3(0.3F, 1.5F, -0.2F), vec3(5)));
  const Image direct = renderDirect(scene, lookDown(), kSize, 1);
  for (int y = 0; y < kSize; ++y)
    for (int x = 0; x < kSize; ++x) {
      const dvec3 to_light = dvec3(0.3, 1.5, -0.2) - floorAt(x, y, kSize);
      const double d2 = dot(to_light, to_light);
      const double expected = 0.6 / kPi * 5.0 * 1.5 / (d2 * std::sqrt(d2));
      ASSERT_NEAR(direct.at(x, y)[0], expected, 2e-5 * expected) << x << ", " << y;
    }
}

TEST_F(FrameTest, ShadowsHaveTheEdgesOfTriangles) {
  // One triangle between a point light and the floor. No pixel may differ from the plain test of its ray but those
  // whose ray passes an edge closer than single precision can tell.
  constexpr int kSize = 128;
  const dvec3 light(0.3, 1.5, -0.2);
  const dvec3 corners[3] = {{-0.31, 0.5, -0.22}, {0.1, 0.6, 0.33}, {0.42, 0.45, -0.35}};
  SceneData scene = makeFloorScene(test::makePoint(vec3(light), vec3(5)));
  Mesh triangle;
  triangle.name = "triangle";
  for (const dvec3& corner : corners) triangle.positions.push_back(vec3(corner));
  triangle.triangles = {uvec3(0, 1, 2)};
  test::addObject(scene, triangle, test::makeDiffuse(vec3(0.0F)));
  // From low down, so that the triangle hides little of its shadow.
  const Camera camera = makeCamera("low", vec3(0, 0.3F, 2.5F), vec3(0, 0, 0), 0.5F);
  const Image direct = renderDirect(scene, camera, kSize, 1);
  RealtimeFrame frame(device(), scene, camera, {.width = kSize, .height = kSize});
  const Image position = frame.readGeometry("position"), id = frame.readGeometry("id");
  int lit = 0, dark = 0;
  for (int y = 0; y < kSize; ++y)
    for (int x = 0; x < kSize; ++x) {
      if (id.at(x, y)[0] != 1.0F) continue;
      const dvec3 p(position.rgb(x, y));
      const dvec3 dir = light - p;
      const dvec3 e1 = corners[1] - corners[0], e2 = corners[2] - corners[0], s = p - corners[0];
      const dvec3 h = cross(dir, e2), q = cross(s, e1);
      const double u = dot(s, h) / dot(e1, h), v = dot(dir, q) / dot(e1, h);
      const double inside = std::min({u, v, 1.0 - u - v});
      if (std::abs(inside) < 1e-5) continue;
      const bool expected_lit = inside < 0.0;
      (expected_lit ? lit : dark) += 1;
      ASSERT_EQ(direct.at(x, y)[0] > 0.0F, expected_lit) << x << ", " << y << ", weight " << inside;
    }
  EXPECT_GT(lit, 1000);
  EXPECT_GT(dark, 100);
}

/// Mean and, over all pixels, the largest difference of what the frame and the reference make of a scene.
void expectDirectLikeReference(const SceneData& scene, const Image& direct, int size, double tolerance) {
  const Camera camera = makeCamera("eye", vec3(0, 4, 6), vec3(0, 0.5F, 0), 0.7F);
  const RenderResult reference = test::renderReference(scene, camera, test::makeSettings(size, 256, 1, {"direct"}));
  const dvec3 ours = test::meanOf(direct), theirs = test::meanOf(reference.image.layers[0].image);
  EXPECT_GT(theirs.y, 0.0);
  for (int c = 0; c < 3; ++c) EXPECT_NEAR(ours[c], theirs[c], tolerance * theirs[c]);
}

TEST_F(FrameTest, DirectAgreesWithTheReferenceUnderEveryLight) {
  constexpr int kSize = 32;
  const Camera camera = makeCamera("eye", vec3(0, 4, 6), vec3(0, 0.5F, 0), 0.7F);
  struct Case {
    const char* name;
    Light light;
    std::uint32_t samples;
    double tolerance;  ///< of the mean: edges of pixels, and for wide lights where their samples fall
  };
  Light spot = test::makePoint(vec3(-2, 4, 1), vec3(60, 50, 40));
  spot.kind = LightKind::kSpot;
  spot.direction = normalize(vec3(2, -4, -1));
  spot.inner_cone = 0.3F, spot.outer_cone = 0.5F;
  const Case cases[] = {{"point", test::makePoint(vec3(2, 4, 1), vec3(60, 50, 40)), 64, 0.002},
                        {"spot", spot, 64, 0.002},
                        {"sun", test::makeSun(vec3(1, -2, 0.5F), vec3(3, 4, 5)), 64, 0.002},
                        {"sphere", test::makePoint(vec3(2, 4, 1), vec3(60, 50, 40), 0.5F), 512, 0.01},
                        {"wide sun", test::makeSun(vec3(1, -2, 0.5F), vec3(3, 4, 5), 5.0F), 64, 0.01}};
  for (const Case& c : cases) {
    SCOPED_TRACE(c.name);
    SceneData scene = test::makeBallScene(test::makeGlass(1.5F), 48);
    scene.lights.push_back(c.light);
    expectDirectLikeReference(scene, renderDirect(scene, camera, kSize, c.samples), kSize, c.tolerance);
  }
}

TEST_F(FrameTest, RoughMetalAndVarnishAreReceiversToo) {
  constexpr int kSize = 32;
  const Camera camera = makeCamera("eye", vec3(0, 4, 6), vec3(0, 0.5F, 0), 0.7F);
  Material varnish = test::makeDiffuse(vec3(0.7F, 0.3F, 0.1F));
  varnish.roughness = 0.6F;
  for (const Material& material : {test::makeMetal(vec3(0.9F, 0.7F, 0.3F), 0.7F), varnish}) {
    SceneData scene = test::makeBallScene(material, 48);
    scene.lights.push_back(test::makePoint(vec3(2, 4, 3), vec3(60)));
    expectDirectLikeReference(scene, renderDirect(scene, camera, kSize, 64), kSize, 0.003);
  }
}

TEST_F(FrameTest, MirrorsAndClearGlassAreNoReceivers) {
  const Camera camera = makeCamera("eye", vec3(0, 4, 6), vec3(0, 0.5F, 0), 0.7F);
  for (const Material& material : {test::makeMetal(vec3(0.9F)), test::makeGlass(1.5F)}) {
    SceneData scene = test::makeBallScene(material, 24);
    scene.lights.push_back(test::makePoint(vec3(2, 4, 3), vec3(60)));
    RealtimeFrame frame(device(), scene, camera, {.width = 32, .height = 32});
    const Image id = frame.readGeometry("id");
    frame.render(0);
    const Image direct = frame.readSummed("direct");
    int seen = 0;
    for (int y = 0; y < 32; ++y)
      for (int x = 0; x < 32; ++x) {
        if (id.at(x, y)[0] != 2.0F) continue;
        ++seen;
        EXPECT_EQ(direct.at(x, y)[0], 0.0F);
      }
    EXPECT_GT(seen, 50);
  }
}

TEST_F(FrameTest, EmissiveMeshesLightReceivers) {
  constexpr int kSize = 32;
  SceneData scene = test::makeBallScene(test::makeGlass(1.5F), 24);
  Material lamp = test::makeDiffuse(vec3(0.0F));
  lamp.emission = vec3(20.0F, 15.0F, 10.0F);
  test::addObject(scene, makeRectangle("lamp", dvec3(1.5, 4, 0), dvec3(0.5, 0, 0), dvec3(0, 0, 0.5)), lamp);
  const Camera camera = makeCamera("eye", vec3(0, 4, 6), vec3(0, 0.5F, 0), 0.7F);
  expectDirectLikeReference(scene, renderDirect(scene, camera, kSize, 256), kSize, 0.01);
}

TEST_F(FrameTest, TwoRunsGiveTheSamePicture) {
  SceneData scene = test::makeBallScene(test::makeGlass(1.5F), 24);
  scene.lights.push_back(test::makePoint(vec3(2, 4, 1), vec3(60), 0.3F));
  const Camera camera = makeCamera("eye", vec3(0, 4, 6), vec3(0, 0.5F, 0), 0.7F);
  const Image first = renderDirect(scene, camera, 32, 4), second = renderDirect(scene, camera, 32, 4);
  EXPECT_EQ(first.pixels, second.pixels);
}

TEST_F(FrameTest, OnePixelAndNoSceneAreNoSpecialCases) {
  SceneData scene = makeFloorScene(test::makePoint(vec3(0, 1.5F, 0), vec3(5)));
  EXPECT_GT(renderDirect(scene, lookDown(), 1, 1).at(0, 0)[0], 0.0F);
  SceneData empty;
  empty.materials.emplace_back();
  empty.lights.push_back(test::makePoint(vec3(0, 1.5F, 0), vec3(5)));
  EXPECT_EQ(renderDirect(empty, lookDown(), 4, 1).at(0, 0)[0], 0.0F);
}

TEST_F(FrameTest, SaysWhatItLeavesOut) {
  SceneData scene = makeFloorScene(test::makePoint(vec3(0, 1.5F, 0), vec3(5), 0.1F));
  const FrameSettings settings{.box_tree_builder = buildBoxTree};
  EXPECT_TRUE(describeFrameLimits(scene, settings).empty());
  scene.materials[0].transmission = 1.0F;  // a pane, and rough
  EXPECT_EQ(describeFrameLimits(scene, settings).size(), 2U);
  scene.materials[0].roughness = 0.0F;
  EXPECT_EQ(describeFrameLimits(scene, settings).size(), 1U);
}

TEST_F(FrameTest, TimesGridsAndPixels) {
  const SceneData scene = makeFloorScene(test::makePoint(vec3(0, 1.5F, 0), vec3(5)));
  RealtimeFrame frame(device(), scene, lookDown(), {.width = 8, .height = 8});
  const auto times = [&](const std::string& name) {
    return std::count_if(frame.passTimes().begin(), frame.passTimes().end(),
                         [&](const gpu::PassTime& time) { return time.name == name; });
  };
  frame.render(0);
  EXPECT_EQ(times("light grid"), 1);
  EXPECT_EQ(times("shade"), 1);
  frame.render(1);  // the lamp has not moved
  EXPECT_EQ(times("light grid"), 0);
  EXPECT_EQ(times("shade"), 1);
}

TEST_F(FrameTest, MirroredAndRepeatedInstancesStandWhereTheyAre) {
  // The same half sphere three times, once mirrored: ids, positions and outward normals.
  SceneData scene = makeFloorScene(test::makeSun(vec3(0, -1, 0), vec3(1)));
  const std::uint32_t first =
      test::addObject(scene, makeSphere("ball", dvec3(0), 0.2, 32), test::makeDiffuse(vec3(0.5F)));
  const float places[3] = {-0.6F, 0.0F, 0.6F};
  scene.instances.resize(first);
  for (int i = 0; i < 3; ++i) {
    Instance instance;
    instance.mesh = 1;
    instance.world_from_object = mat4(1.0F);
    if (i == 1) instance.world_from_object[0][0] = -1.0F;
    instance.world_from_object[3] = vec4(places[i], 0.3F, 0.0F, 1.0F);
    scene.instances.push_back(instance);
  }
  RealtimeFrame frame(device(), scene, lookDown(), {.width = 100, .height = 100});
  const Image id = frame.readGeometry("id"), position = frame.readGeometry("position"),
              normal = frame.readGeometry("normal");
  for (int i = 0; i < 3; ++i) {
    const int x = static_cast<int>((places[i] + 1.0F) * 50.0F) + 3, y = 52;
    EXPECT_EQ(id.at(x, y)[0], static_cast<float>(2 + i));
    const vec3 outward = position.rgb(x, y) - vec3(places[i], 0.3F, 0.0F);
    EXPECT_NEAR(length(outward), 0.2F, 0.002F);
    EXPECT_GT(dot(normal.rgb(x, y), normalize(outward)), 0.995F);
  }
}

}  // namespace
}  // namespace nephroid
