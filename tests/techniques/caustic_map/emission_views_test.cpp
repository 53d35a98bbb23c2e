#include "techniques/caustic_map/emission_views.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "core/math.h"
#include "frame/emission.shared.h"
#include "frame/view.h"
#include "support/tiny_scenes.h"

namespace nephroid {
namespace {

constexpr Bounds kBox{{-0.5F, 0.2F, -0.3F}, {0.4F, 1.1F, 0.6F}};
constexpr Bounds kScene{{-4, 0, -4}, {4, 3, 4}};

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
  const std::vector<ViewRecord> views = makeEmissionViews(light, kBox, kScene);
  ASSERT_EQ(views.size(), 6U);
  const dvec3 flux = fluxOf(light, views, 128);
  for (int c = 0; c < 3; ++c) EXPECT_NEAR(flux[c] / (4.0 * kPi * light.value[c]), 1.0, 1e-4);
}

TEST(EmissionViews, AFittedViewHasTheSolidAngleOfItsSquare) {
  const LightRecord light = makePointRecord(vec3(3, 5, 2));
  const std::vector<ViewRecord> views = makeEmissionViews(light, kBox, kScene);
  ASSERT_EQ(views.size(), 1U);
  // Of a square of half-side t at distance 1: Ω = 4 atan(t²/√(1 + 2t²)).
  const double t = length(views[0].right);
  EXPECT_NEAR(length(views[0].up), t, 1e-6 * t);
  const double solid_angle = 4.0 * std::atan(t * t / std::sqrt(1.0 + 2.0 * t * t));
  const dvec3 flux = fluxOf(light, views, 64);
  EXPECT_NEAR(flux.x / (solid_angle * light.value.x), 1.0, 1e-4);
  // It is as narrow as it can be, but for the box about a box.
  EXPECT_LT(t, 0.2);
}

TEST(EmissionViews, ParallelLightHasTheAreaAcrossIt) {
  // Straight down, the square is the box from above, whichever way it is turned about the direction.
  const LightRecord light = makeParallelRecord(vec3(0, -1, 0));
  const std::vector<ViewRecord> views = makeEmissionViews(light, kBox, kScene);
  ASSERT_EQ(views.size(), 1U);
  const vec3 extent = kBox.extent();
  const double area = double{extent.x} * extent.z;
  // Each side has a margin of 0.1 %.
  EXPECT_NEAR(fluxOf(light, views, 16).y / (light.value.y * area), 1.002, 1e-5);
}

TEST(EmissionViews, HoldEveryRayToAGeneratorOnce) {
  for (const LightRecord& light :
       {makePointRecord(vec3(3, 2.5F, 2)), makePointRecord(vec3(0.6F, 0.9F, 0.1F)), makePointRecord(vec3(0, 1, 0)),
        makePointRecord(vec3(-0.5F, 0.2F, -0.3F)), makeParallelRecord(vec3(1, -2, 0.5F)),
        makeParallelRecord(vec3(0, 1, 0)), makeParallelRecord(vec3(0, 0, -1))}) {
    SCOPED_TRACE(::testing::Message() << light.position.x << " " << light.direction.x);
    const std::vector<ViewRecord> views = makeEmissionViews(light, kBox, kScene);
    for (const vec3& place : placesIn(kBox, 300)) {
      // Nearer than the near end nothing is drawn.
      if (light.kind == kLightPoint && length(place - light.position) < 0.02F) continue;
      EXPECT_EQ(countViews(views, place), 1) << place.x << " " << place.y << " " << place.z;
    }
  }
}

TEST(EmissionViews, ShowWhatCouldBlockTheLight) {
  // Half-way between the light and the generators.
  const LightRecord point = makePointRecord(vec3(3, 2.5F, 2)), sun = makeParallelRecord(vec3(1, -2, 0.5F));
  const vec3 before_point = 0.5F * (point.position + kBox.centre());
  EXPECT_EQ(countViews(makeEmissionViews(point, kBox, kScene), before_point), 1);
  EXPECT_EQ(countViews(makeEmissionViews(sun, kBox, kScene), kBox.centre() - 1.2F * sun.direction), 1);
}

TEST(EmissionViews, RaysOfCellsAreThoseOfThePicture) {
  // Where the ray of a place in the picture goes, the picture shows that place.
  for (const LightRecord& light : {makePointRecord(vec3(3, 2.5F, 2)), makeParallelRecord(vec3(1, -2, 0.5F))}) {
    const ViewRecord view = makeEmissionViews(light, kBox, kScene)[0];
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
  EXPECT_EQ(makeEmissionViews(light, kBox, kScene).size(), 1U);
  light.direction = -light.direction;
  EXPECT_TRUE(makeEmissionViews(light, kBox, kScene).empty());
}

TEST(EmissionViews, LampsShineToTheSideOfTheirNormal) {
  LightRecord light = makePointRecord(vec3(3, 2.5F, 2));
  const std::vector<ViewRecord> views = makeEmissionViews(light, kBox, kScene);
  light.normal = views[0].forward;
  light.surface = kSurfaceFront;
  const vec3 front = cellFlux(light, views[0], 0.5F, 0.0F, 1e-4F);
  EXPECT_GT(front.x, 0.0F);
  light.normal = -light.normal;
  EXPECT_EQ(cellFlux(light, views[0], 0.5F, 0.0F, 1e-4F), vec3(0.0F));
  light.surface = kSurfaceBoth;
  EXPECT_EQ(cellFlux(light, views[0], 0.5F, 0.0F, 1e-4F), front);
}

TEST(EmissionViews, GeneratorsAreWhatCasts) {
  SceneData scene = test::makeBallScene(test::makeGlass(1.5F));
  const Bounds glass = generatorBounds(scene, 0.25F);
  EXPECT_NEAR(glass.lower.y, 0.2F, 1e-3F);
  EXPECT_NEAR(glass.upper.x, 1.0F, 1e-2F);
  scene.instances[1].casts = false;
  EXPECT_TRUE(generatorBounds(scene, 0.25F).empty());
}

}  // namespace
}  // namespace nephroid
