#include "trace/trace_scene.h"

#include <gtest/gtest.h>

#include <glm/gtc/matrix_transform.hpp>
#include <random>

#include "support/tiny_scenes.h"
#include "trace/emission.h"

namespace nephroid {
namespace {

using test::addObject;
using test::makeDiffuse;
using test::makeFloor;
using test::makeGlass;

TEST(TraceScene, HitsWhatIsThere) {
  const SceneData data = test::makeBallScene(makeGlass(1.5F));
  const TraceScene scene(data);
  RayHit hit;
  ASSERT_TRUE(scene.intersect(Ray{vec3(0, 5, 0), vec3(0, -1, 0)}, hit));
  EXPECT_EQ(hit.instance, 1U);
  EXPECT_NEAR(hit.t, 2.8F, 1e-3F);
  EXPECT_FALSE(scene.occluded(Ray{vec3(3, 5, 0), vec3(0, -1, 0), 4.9F}));
  EXPECT_TRUE(scene.occluded(Ray{vec3(3, 5, 0), vec3(0, -1, 0), 5.1F}));
}

TEST(TraceScene, EmptySceneIsMissed) {
  SceneData data;
  data.materials.emplace_back();
  const TraceScene scene(data);
  RayHit hit;
  EXPECT_TRUE(scene.empty());
  EXPECT_FALSE(scene.intersect(Ray{vec3(0), vec3(0, 1, 0)}, hit));
}

/// One ball under four placements: baked or instanced, mirrored or not.
class Placement : public testing::TestWithParam<std::tuple<bool, bool>> {};

TEST_P(Placement, NormalsPointOutOfTheSolid) {
  const auto [instanced, mirrored] = GetParam();
  SceneData data;
  const mat4 placed =
      glm::translate(mat4(1.0F), vec3(2, 0, 0)) * glm::scale(mat4(1.0F), vec3(mirrored ? -1.0F : 1.0F, 2.0F, 0.5F));
  addObject(data, makeSphere("ball", dvec3(0), 1.0, 64), makeGlass(1.5F), placed);
  if (instanced) {
    Instance other = data.instances[0];
    other.world_from_object = glm::translate(mat4(1.0F), vec3(-20, 0, 0));
    data.instances.push_back(other);
  }
  const TraceScene scene(data);
  std::mt19937 random(3);
  std::uniform_real_distribution<float> uniform(-1.0F, 1.0F);
  for (int i = 0; i < 200; ++i) {
    const vec3 dir = normalize(vec3(uniform(random), uniform(random), uniform(random)));
    const Ray ray{vec3(2, 0, 0) - 8.0F * dir, dir};
    RayHit hit;
    ASSERT_TRUE(scene.intersect(ray, hit));
    const SurfacePoint point = scene.surfaceAt(ray, hit);
    EXPECT_LT(dot(point.normal_geometric, dir), 0.0F);
    EXPECT_GT(dot(point.normal_shading, point.normal_geometric), 0.98F);
    EXPECT_NEAR(length(point.position - (ray.origin + hit.t * dir)), 0.0F, 1e-4F);
    vec3 p[3];
    scene.triangleCorners(hit.instance, hit.triangle, p);
    EXPECT_GT(dot(normalize(cross(p[1] - p[0], p[2] - p[0])), point.normal_geometric), 0.999F);
    // A ray that goes on inside must find the far side, not this one again.
    const Ray inside{offsetOrigin(point, dir), dir};
    ASSERT_TRUE(scene.intersect(inside, hit));
    EXPECT_GT(hit.t, 0.1F);
  }
}

TEST_P(Placement, PacketsOfAnySizeMeetWhatSingleRaysMeet) {
  const auto [instanced, mirrored] = GetParam();
  SceneData data;
  addObject(data, makeSphere("ball", dvec3(0), 1.0, 64), makeGlass(1.5F),
            glm::scale(mat4(1.0F), vec3(mirrored ? -1.0F : 1.0F, 2.0F, 0.5F)));
  if (instanced) {
    Instance other = data.instances[0];
    other.world_from_object = glm::translate(mat4(1.0F), vec3(-20, 0, 0));
    data.instances.push_back(other);
  }
  const TraceScene scene(data);
  std::mt19937 random(5);
  std::uniform_real_distribution<float> uniform(-1.5F, 1.5F);
  for (std::size_t count = 1; count <= TraceScene::kPacketSize; ++count) {
    std::vector<Ray> rays;
    std::vector<const Ray*> pointers;
    for (std::size_t i = 0; i < count; ++i)
      rays.push_back({vec3(uniform(random), uniform(random), 4.0F), vec3(0, 0, -1)});
    for (const Ray& ray : rays) pointers.push_back(&ray);
    RayHit hits[TraceScene::kPacketSize];
    scene.intersectPacket(pointers, hits);
    const std::uint32_t occluded = scene.occludedPacket(rays);
    for (std::size_t i = 0; i < count; ++i) {
      RayHit single;
      const bool met = scene.intersect(rays[i], single);
      EXPECT_EQ(hits[i].instance, met ? single.instance : kNone);
      EXPECT_EQ((occluded >> i) & 1U, met ? 1U : 0U);
      if (!met) continue;
      EXPECT_EQ(hits[i].triangle, single.triangle);
      EXPECT_NEAR(hits[i].t, single.t, 1e-5F);
      EXPECT_NEAR(hits[i].u, single.u, 1e-3F);
    }
    EXPECT_EQ(occluded >> count, 0U);
  }
}

INSTANTIATE_TEST_SUITE_P(All, Placement, testing::Combine(testing::Bool(), testing::Bool()));

TEST_P(Placement, NormalGradientIsTheChangeOfTheNormal) {
  const auto [instanced, mirrored] = GetParam();
  SceneData data;
  mat4 placed = glm::scale(mat4(1.0F), vec3(mirrored ? -1.3F : 1.3F, 0.8F, 1.1F));
  test::addObject(data, makeSphere("ball", dvec3(0), 1.0, 32), makeGlass(1.5F), placed);
  if (instanced) data.instances.push_back(data.instances[0]);
  const TraceScene scene(data);
  int checked = 0;
  for (int i = 0; i < 50; ++i) {
    const vec3 from(0.03F * static_cast<float>(i) - 0.7F, 5.0F, 0.21F);
    RayHit hit, near;
    const Ray ray{from, vec3(0, -1, 0)}, beside{from + vec3(1e-3F, 0, 2e-3F), vec3(0, -1, 0)};
    if (!scene.intersect(ray, hit) || !scene.intersect(beside, near) || near.triangle != hit.triangle) continue;
    const SurfacePoint a = scene.surfaceAt(ray, hit), b = scene.surfaceAt(beside, near);
    const NormalGradient gradient = scene.normalGradientAt(a);
    EXPECT_LT(length(gradient.normal - a.normal_shading), 1e-5F);
    const vec3 change = b.normal_shading - a.normal_shading;
    EXPECT_LT(length(gradient.along(b.position - a.position) - change), 0.02F * length(change) + 2e-6F);
    ++checked;
  }
  EXPECT_GT(checked, 20);
}

TEST(TraceScene, NewRaysDoNotMeetTheirOwnSurfaceAtAnyScale) {
  for (const float scale : {1e-3F, 1.0F, 1e3F}) {
    SceneData data;
    // Off the origin by three of its sizes: coordinates that do not fit floats exactly.
    const mat4 placed =
        glm::translate(mat4(1.0F), scale * vec3(2.7F, 1.3F, -3.1F)) * glm::scale(mat4(1.0F), vec3(scale));
    addObject(data, makeSphere("ball", dvec3(0), 1.0, 128), makeGlass(1.5F), placed);
    const TraceScene scene(data);
    std::mt19937 random(5);
    std::uniform_real_distribution<float> uniform(-1.0F, 1.0F);
    int again = 0;
    for (int i = 0; i < 20000; ++i) {
      const vec3 dir = normalize(vec3(uniform(random), uniform(random), uniform(random)));
      const Ray ray{vec3(placed[3]) - 5.0F * scale * dir, dir};
      RayHit hit;
      ASSERT_TRUE(scene.intersect(ray, hit));
      const SurfacePoint point = scene.surfaceAt(ray, hit);
      vec3 out = normalize(vec3(uniform(random), uniform(random), uniform(random)));
      if (dot(out, point.normal_geometric) < 0.0F) out = -out;
      again += scene.occluded(Ray{offsetOrigin(point, out), out});
    }
    // The facets are convex: nothing that leaves outward can meet the ball again.
    EXPECT_EQ(again, 0) << scale;
  }
}

TEST(TraceScene, FloorThroughTheOriginDoesNotShadowItself) {
  SceneData data;
  addObject(data, makeFloor(10.0), makeDiffuse(vec3(0.5F)));
  const TraceScene scene(data);
  const Ray ray{vec3(0.3F, 2, 0.7F), vec3(0, -1, 0)};
  RayHit hit;
  ASSERT_TRUE(scene.intersect(ray, hit));
  const SurfacePoint point = scene.surfaceAt(ray, hit);
  EXPECT_FALSE(scene.occluded(Ray{offsetOrigin(point, vec3(0, 1, 0)), vec3(0, 1, 0)}));
}

TEST(FindInterior, KnowsClosedAndOpenSolids) {
  SceneData data = test::makeBallScene(makeGlass(1.5F));
  addObject(data, makeRectangle("water", dvec3(0, 10, 0), dvec3(0, 0, 50), dvec3(50, 0, 0)), makeGlass(1.33F));
  const TraceScene scene(data);
  const InteriorList in_ball = findInterior(scene, vec3(0, 1.2F, 0));
  EXPECT_EQ(in_ball.count(), 2);
  EXPECT_FLOAT_EQ(in_ball.medium()->ior, 1.5F);
  const InteriorList in_water = findInterior(scene, vec3(3, 1, 0));
  EXPECT_EQ(in_water.count(), 1);
  EXPECT_FLOAT_EQ(in_water.medium()->ior, 1.33F);
  EXPECT_EQ(findInterior(scene, vec3(3, 12, 0)).count(), 0);
}

}  // namespace
}  // namespace nephroid
