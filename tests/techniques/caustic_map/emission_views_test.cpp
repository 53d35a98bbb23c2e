#include "techniques/caustic_map/emission_views.h"

#include <gtest/gtest.h>

#include <cmath>
#include <glm/gtc/matrix_transform.hpp>
#include <memory>
#include <random>
#include <utility>

#include "core/math.h"
#include "frame/emission.shared.h"
#include "frame/view.h"
#include "support/tiny_scenes.h"

namespace nephroid {
namespace {

constexpr Bounds kBox{{-0.5F, 0.2F, -0.3F}, {0.4F, 1.1F, 0.6F}};
constexpr Bounds kScene{{-4, 0, -4}, {4, 3, 4}};

GeneratorHull makeBoxHull(const Bounds& box, const mat4& world_from_object = mat4(1.0F)) {
  std::vector<vec3> corners;
  for (int i = 0; i < 8; ++i)
    corners.emplace_back((i & 1) != 0 ? box.upper.x : box.lower.x, (i & 2) != 0 ? box.upper.y : box.lower.y,
                         (i & 4) != 0 ? box.upper.z : box.lower.z);
  return GeneratorHull({{std::make_shared<const SupportTree>(std::move(corners)), world_from_object}});
}

const GeneratorHull kHull = makeBoxHull(kBox);

/// Points all over a sphere.
std::vector<vec3> makeSpherePoints(vec3 centre, float radius, int count) {
  std::vector<vec3> points;
  for (int i = 0; i < count; ++i) {
    // Fibonacci's spiral.
    const float y = 1.0F - 2.0F * (static_cast<float>(i) + 0.5F) / static_cast<float>(count);
    const float azimuth = 2.3999632F * static_cast<float>(i), r = std::sqrt(1.0F - y * y);
    points.push_back(centre + radius * vec3(r * std::cos(azimuth), y, r * std::sin(azimuth)));
  }
  return points;
}

LightRecord makePointRecord(vec3 position) {
  LightRecord light{};
  light.kind = kLightPoint;
  light.position = position;
  light.value = vec3(2, 3, 5);
  return light;
}

LightRecord makeParallelRecord(vec3 direction) {
  LightRecord light{};
  light.kind = kLightDirectional;
  light.direction = normalize(direction);
  light.value = vec3(2, 3, 5);
  return light;
}

/// Flux through all cells of all views, W.
dvec3 fluxOf(const LightRecord& light, const std::vector<ViewRecord>& views, int grid) {
  dvec3 sum(0.0);
  for (const ViewRecord& view : views)
    for (int y = 0; y < grid; ++y)
      for (int x = 0; x < grid; ++x) {
        const float u = (static_cast<float>(x) + 0.5F) * 2.0F / static_cast<float>(grid) - 1.0F;
        const float v = (static_cast<float>(y) + 0.5F) * 2.0F / static_cast<float>(grid) - 1.0F;
        sum += dvec3(cellFlux(light, view, u, v, 1.0F / static_cast<float>(grid * grid)));
      }
  return sum;
}

/// In how many views' pictures a place lies.
int countViews(const std::vector<ViewRecord>& views, vec3 place) {
  int count = 0;
  for (const ViewRecord& view : views) {
    const vec4 p(place, 1.0F);
    const float x = dot(view.clip_row_x, p), y = dot(view.clip_row_y, p), z = dot(view.clip_row_z, p),
                w = dot(view.clip_row_w, p);
    if (w > 0.0F && std::abs(x) <= w && std::abs(y) <= w && z >= 0.0F && z <= w) ++count;
  }
  return count;
}

std::vector<vec3> placesIn(const Bounds& box, int count) {
  std::mt19937 random(7);
  std::uniform_real_distribution<float> uniform(0.0F, 1.0F);
  std::vector<vec3> places;
  for (int i = 0; i < count; ++i)
    places.push_back(box.lower + vec3(uniform(random), uniform(random), uniform(random)) * box.extent());
  return places;
}

TEST(EmissionViews, ACubeOfViewsHoldsAllOfAPointsFlux) {
  // From the middle of the generators every direction counts: 4π·I.
  const LightRecord light = makePointRecord(kBox.centre());
  const std::vector<ViewRecord> views = makeEmissionViews(light, kHull, kScene);
  ASSERT_EQ(views.size(), 6U);
  const dvec3 flux = fluxOf(light, views, 128);
  for (int c = 0; c < 3; ++c) EXPECT_NEAR(flux[c] / (4.0 * kPi * light.value[c]), 1.0, 1e-4);
}

TEST(EmissionViews, AFittedViewHasTheSolidAngleOfItsRectangle) {
  const LightRecord light = makePointRecord(vec3(3, 5, 2));
  const std::vector<ViewRecord> views = makeEmissionViews(light, kHull, kScene);
  ASSERT_EQ(views.size(), 1U);
  // Of a rectangle of half-sides a, b at distance 1: Ω = 4 atan(ab/√(1 + a² + b²)).
  const double a = length(views[0].right), b = length(views[0].up);
  const double solid_angle = 4.0 * std::atan(a * b / std::sqrt(1.0 + a * a + b * b));
  const dvec3 flux = fluxOf(light, views, 64);
  EXPECT_NEAR(flux.x / (solid_angle * light.value.x), 1.0, 1e-4);
}

TEST(EmissionViews, OfABallAreAsLargeAsTheBall) {
  // From anywhere: a square of its diameter, and a cone of half-angle asin(r/d). No angle about the light is better.
  constexpr float kRadius = 0.4F;
  const vec3 centre(0.3F, 1, -0.2F);
  const GeneratorHull ball({{std::make_shared<const SupportTree>(makeSpherePoints(centre, kRadius, 100'000))}});
  for (const vec3& dir : {vec3(0, -1, 0), vec3(1, -2, 0.5F), vec3(-1, 0, 3)}) {
    const ViewRecord parallel = makeEmissionViews(makeParallelRecord(dir), ball, kScene)[0];
    EXPECT_NEAR(length(parallel.right) / kRadius, 1.001, 2e-4);
    EXPECT_NEAR(length(parallel.up) / kRadius, 1.001, 2e-4);
    for (const float distance : {0.55F, 5.0F, 1000.0F}) {
      const LightRecord point = makePointRecord(centre - distance * normalize(dir));
      const std::vector<ViewRecord> views = makeEmissionViews(point, ball, kScene);
      ASSERT_EQ(views.size(), 1U) << distance;
      const float tangent = kRadius / std::sqrt(distance * distance - kRadius * kRadius);
      EXPECT_NEAR(length(views[0].right) / tangent, 1.0, 1e-3) << distance;
      EXPECT_NEAR(length(views[0].up) / tangent, 1.0, 1e-3) << distance;
    }
  }
}

TEST(EmissionViews, AreTurnedAboutTheLight) {
  // A box that stands askew is in a rectangle of its own sides, not in the one about its corners.
  const mat4 askew = glm::rotate(mat4(1.0F), 0.6F, vec3(0, 1, 0));
  const GeneratorHull hull = makeBoxHull({{-1, 0, -0.1F}, {1, 0.2F, 0.1F}}, askew);
  const ViewRecord parallel = makeEmissionViews(makeParallelRecord(vec3(0, -1, 0)), hull, kScene)[0];
  EXPECT_NEAR(length(parallel.right) * length(parallel.up), 0.1, 1e-3);
  // From a point 3 m above its top.
  const ViewRecord frustum = makeEmissionViews(makePointRecord(vec3(0, 3.2F, 0)), hull, kScene)[0];
  EXPECT_NEAR(length(frustum.right) * length(frustum.up), 0.1 / 9.0, 2e-4);
}

TEST(EmissionViews, ParallelLightHasTheAreaAcrossIt) {
  // Straight down, the rectangle is the box from above.
  const LightRecord light = makeParallelRecord(vec3(0, -1, 0));
  const std::vector<ViewRecord> views = makeEmissionViews(light, kHull, kScene);
  ASSERT_EQ(views.size(), 1U);
  const vec3 extent = kBox.extent();
  const double area = double{extent.x} * extent.z;
  // Each side has a margin of 0.1 %.
  EXPECT_NEAR(fluxOf(light, views, 16).y / (light.value.y * area), 1.002, 1e-5);
}

/// Places of which those in the hull are in exactly one view.
void expectHeldOnce(const LightRecord& light, const GeneratorHull& hull, const std::vector<vec3>& places) {
  SCOPED_TRACE(::testing::Message() << light.position.x << " " << light.direction.x);
  Bounds scene = kScene;
  scene.add(hull.bounds());
  const std::vector<ViewRecord> views = makeEmissionViews(light, hull, scene);
  for (const vec3& place : places) {
    // Nearer than the near end nothing is drawn.
    if (light.kind == kLightPoint && length(place - light.position) < 0.02F) continue;
    EXPECT_EQ(countViews(views, place), 1) << place.x << " " << place.y << " " << place.z;
  }
}

TEST(EmissionViews, HoldEveryRayToAGeneratorOnce) {
  for (const LightRecord& light :
       {makePointRecord(vec3(3, 2.5F, 2)), makePointRecord(vec3(0.6F, 0.9F, 0.1F)), makePointRecord(vec3(0, 1, 0)),
        makePointRecord(vec3(-0.5F, 0.2F, -0.3F)), makeParallelRecord(vec3(1, -2, 0.5F)),
        makeParallelRecord(vec3(0, 1, 0)), makeParallelRecord(vec3(0, 0, -1))})
    expectHeldOnce(light, kHull, placesIn(kBox, 300));
}

TEST(EmissionViews, HoldEveryVertexOfSeveralBodies) {
  // A ball and a plate that stands askew, whose vertices are all on their hulls; the plate is seen edge-on too.
  const std::vector<vec3> ball = makeSpherePoints(vec3(0), 0.4F, 500), plate{{-1, -1, 0}, {1, -1, 0}, {0, 1, 0}};
  const mat4 there = glm::rotate(glm::translate(mat4(1.0F), vec3(1, 1, 2)), 0.7F, vec3(1, 2, 0));
  const mat4 here = glm::scale(glm::translate(mat4(1.0F), vec3(-1, 1, 0)), vec3(-1, 2, 0.5F));
  const GeneratorBody ball_body{std::make_shared<const SupportTree>(ball), here};
  const GeneratorBody plate_body{std::make_shared<const SupportTree>(plate), there};
  const GeneratorHull hull({ball_body, plate_body}), thin({plate_body});
  std::vector<vec3> vertices;
  for (const vec3& p : ball) vertices.push_back(transformPoint(here, p));
  for (const vec3& p : plate) vertices.push_back(transformPoint(there, p));
  std::mt19937 random(3);
  std::normal_distribution<float> normal;
  for (int i = 0; i < 40; ++i) {
    const vec3 away = normalize(vec3(normal(random), normal(random), normal(random)));
    expectHeldOnce(makeParallelRecord(away), hull, vertices);
    for (const float distance : {0.8F, 2.0F, 6.0F, 50.0F})
      expectHeldOnce(makePointRecord(hull.bounds().centre() + distance * away), hull, vertices);
  }
  const vec3 in_the_plate = vec3(there * vec4(1, 0, 0, 0));
  const std::vector<vec3> corners(vertices.end() - 3, vertices.end());
  expectHeldOnce(makeParallelRecord(in_the_plate), thin, corners);
  expectHeldOnce(makePointRecord(vec3(there[3]) + 5.0F * in_the_plate), thin, corners);
}

TEST(EmissionViews, ShowWhatCouldBlockTheLight) {
  // Half-way between the light and the generators.
  const LightRecord point = makePointRecord(vec3(3, 2.5F, 2)), sun = makeParallelRecord(vec3(1, -2, 0.5F));
  const vec3 before_point = 0.5F * (point.position + kBox.centre());
  EXPECT_EQ(countViews(makeEmissionViews(point, kHull, kScene), before_point), 1);
  EXPECT_EQ(countViews(makeEmissionViews(sun, kHull, kScene), kBox.centre() - 1.2F * sun.direction), 1);
}

TEST(EmissionViews, RaysOfCellsAreThoseOfThePicture) {
  // Where the ray of a place in the picture goes, the picture shows that place.
  for (const LightRecord& light : {makePointRecord(vec3(3, 2.5F, 2)), makeParallelRecord(vec3(1, -2, 0.5F))}) {
    const ViewRecord view = makeEmissionViews(light, kHull, kScene)[0];
    for (const vec2& film : {vec2(0.0F), vec2(0.7F, -0.2F), vec2(-0.9F, 0.8F)}) {
      const EmissionRay ray = emissionRay(view, film.x, film.y);
      const vec4 place(ray.origin + 3.0F * ray.dir, 1.0F);
      const float w = dot(view.clip_row_w, place);
      EXPECT_NEAR(dot(view.clip_row_x, place) / w, film.x, 1e-5F);
      EXPECT_NEAR(dot(view.clip_row_y, place) / w, film.y, 1e-5F);
    }
  }
}

TEST(EmissionViews, ASpotThatLooksAwayHasNone) {
  LightRecord light = makePointRecord(vec3(3, 2.5F, 2));
  light.kind = kLightSpot;
  light.cos_outer = std::cos(0.3F);
  light.cos_inner = std::cos(0.2F);
  light.direction = normalize(kBox.centre() - light.position);
  EXPECT_EQ(makeEmissionViews(light, kHull, kScene).size(), 1U);
  light.direction = -light.direction;
  EXPECT_TRUE(makeEmissionViews(light, kHull, kScene).empty());
}

TEST(EmissionViews, LampsShineToTheSideOfTheirNormal) {
  LightRecord light = makePointRecord(vec3(3, 2.5F, 2));
  const std::vector<ViewRecord> views = makeEmissionViews(light, kHull, kScene);
  light.normal = views[0].forward;
  light.surface = kSurfaceFront;
  const vec3 front = cellFlux(light, views[0], 0.5F, 0.0F, 1e-4F);
  EXPECT_GT(front.x, 0.0F);
  light.normal = -light.normal;
  EXPECT_EQ(cellFlux(light, views[0], 0.5F, 0.0F, 1e-4F), vec3(0.0F));
  light.surface = kSurfaceBoth;
  EXPECT_EQ(cellFlux(light, views[0], 0.5F, 0.0F, 1e-4F), front);
}

TEST(GeneratorHull, HasWhatCasts) {
  SceneData scene = test::makeBallScene(test::makeGlass(1.5F));
  MeshTrees trees;
  const GeneratorHull glass = makeGeneratorHull(scene, 0.25F, trees);
  EXPECT_NEAR(glass.bounds().lower.y, 0.2F, 1e-3F);
  EXPECT_NEAR(glass.bounds().upper.x, 1.0F, 1e-2F);
  EXPECT_NEAR(glass.farthest(dvec3(0, -1, 0)).y, 0.2, 1e-3);
  scene.instances[1].casts = false;
  EXPECT_TRUE(makeGeneratorHull(scene, 0.25F, trees).empty());
}

TEST(GeneratorHull, FollowsInstancesThatMove) {
  SceneData scene = test::makeBallScene(test::makeGlass(1.5F));
  MeshTrees trees;
  const Bounds before = makeGeneratorHull(scene, 0.25F, trees).bounds();
  scene.instances[1].world_from_object =
      glm::translate(mat4(1.0F), vec3(1, 2, 3)) * scene.instances[1].world_from_object;
  const Bounds after = makeGeneratorHull(scene, 0.25F, trees).bounds();
  EXPECT_EQ(trees.size(), 1U);
  for (int axis = 0; axis < 3; ++axis)
    EXPECT_NEAR(after.lower[axis] - before.lower[axis], static_cast<float>(axis + 1), 1e-5F);
}

}  // namespace
}  // namespace nephroid
