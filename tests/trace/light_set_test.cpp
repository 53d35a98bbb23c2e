#include "trace/light_set.h"

#include <gtest/gtest.h>

#include "core/sampling/sampler.h"
#include "core/sampling/warp.h"
#include "support/tiny_scenes.h"

namespace nephroid {
namespace {

using test::addObject;
using test::makeDiffuse;

struct Lit {
  explicit Lit(SceneData d) : data(std::move(d)), scene(data), materials(scene), lights(scene, materials) {}
  /// Irradiance at a point of normal +Y by sampling the lights.
  double irradiance(vec3 position, int count = 1 << 14) const {
    double sum = 0.0;
    for (int i = 0; i < count; ++i) {
      Sampler sampler(5, 6, static_cast<std::uint32_t>(i));
      const float choice = sampler.next1D();
      const auto s = lights.sample(position, choice, sampler.next2D());
      if (s) sum += std::max(s->dir.y, 0.0F) * s->radiance.x / s->pdf;
    }
    return sum / count;
  }
  /// The same from places on the lights, whoever they shine at. Nothing is in the way.
  double irradianceFromPlaces(vec3 position, int count = 1 << 14) const {
    double sum = 0.0;
    for (int i = 0; i < count; ++i) {
      Sampler sampler(5, 6, static_cast<std::uint32_t>(i));
      const float choice = sampler.next1D();
      const auto place = lights.samplePlace(choice, sampler.next2D());
      if (!place || !lights.distanceTo(*place, position)) continue;
      const vec3 way = place->at_infinity ? place->position : place->position - position;
      const double squared = place->at_infinity ? 1.0 : dot(way, way);
      const vec3 dir = normalize(way);
      sum += std::max(dir.y, 0.0F) * lights.emissionOf(*place, -dir).x / squared;
    }
    return sum / count;
  }
  SceneData data;
  TraceScene scene;
  MaterialTable materials;
  LightSet lights;
};

SceneData makeFloorScene() {
  SceneData data;
  addObject(data, test::makeFloor(4.0), makeDiffuse(vec3(0.5F)));
  return data;
}

TEST(LightSet, SunKeepsItsIrradianceAtAnySize) {
  for (const float angle : {0.0F, 0.5F, 30.0F}) {
    SceneData data = makeFloorScene();
    data.lights.push_back(test::makeSun(vec3(0, -1, 0), vec3(10.0F), angle));
    EXPECT_NEAR(Lit(std::move(data)).irradiance(vec3(0)), 10.0, 2e-2) << angle;
  }
}

TEST(LightSet, SphereLightKeepsItsIntensityAtAnySize) {
  for (const float radius : {0.0F, 0.1F, 1.0F}) {
    SceneData data = makeFloorScene();
    data.lights.push_back(test::makePoint(vec3(0, 2, 0), vec3(8.0F), radius));
    // Lambertian sphere: E = I/d² exactly, as long as all of it is above the horizon.
    EXPECT_NEAR(Lit(std::move(data)).irradiance(vec3(0)), 2.0, 5e-3) << radius;
  }
}

TEST(LightSet, ConstantEnvironmentGivesPiTimesItsRadiance) {
  SceneData data = makeFloorScene();
  Environment environment;
  environment.radiance = std::make_shared<Image>(64, 32, 3, 3.0F);
  data.environment = environment;
  EXPECT_NEAR(Lit(std::move(data)).irradiance(vec3(0)), 3.0 * kPi, 0.02 * kPi);
}

TEST(LightSet, LightsAddUp) {
  SceneData data = makeFloorScene();
  data.lights.push_back(test::makeSun(vec3(0, -1, 0), vec3(10.0F)));
  data.lights.push_back(test::makePoint(vec3(0, 2, 0), vec3(8.0F)));
  EXPECT_NEAR(Lit(std::move(data)).irradiance(vec3(0)), 12.0, 0.05);
}

TEST(LightSet, WhatIsMetHasTheDensityWithWhichItIsSampled) {
  SceneData data = makeFloorScene();
  data.lights.push_back(test::makePoint(vec3(0, 2, 0), vec3(8.0F), 0.5F));
  data.lights.push_back(test::makeSun(vec3(0.3F, -1, 0), vec3(4.0F), 5.0F));
  Material lamp;
  lamp.emission = vec3(2.0F);
  addObject(data, makeRectangle("lamp", dvec3(1, 3, 0), dvec3(0.5, 0, 0), dvec3(0, 0, 0.5)), lamp);
  Environment environment;
  environment.radiance = std::make_shared<Image>(16, 8, 3, 0.5F);
  data.environment = environment;
  const Lit lit(std::move(data));
  int matched = 0;
  for (std::uint32_t i = 0; i < 2000; ++i) {
    Sampler sampler(8, 8, i);
    const float choice = sampler.next1D();
    const auto s = lit.lights.sample(vec3(0, 0.1F, 0), choice, sampler.next2D());
    if (!s || s->delta) continue;
    bool found = false;
    const auto compare = [&](const LightSet::Met& met) {
      found = found ||
              (std::abs(met.pdf / s->pdf - 1.0F) < 5e-3F && std::abs(met.radiance.x / s->radiance.x - 1.0F) < 1e-3F);
    };
    const Ray ray{vec3(0, 0.1F, 0), s->dir};
    lit.lights.visitInfinity(s->dir, compare);
    lit.lights.visitSpheres(ray.origin, ray, kInfinity, compare);
    RayHit hit;
    if (lit.scene.intersect(ray, hit))
      compare(lit.lights.metSurface(ray.origin, lit.scene.surfaceAt(ray, hit), ray.dir));
    matched += found;
    EXPECT_TRUE(found || std::isfinite(s->distance)) << i;
  }
  EXPECT_GT(matched, 1900);
}

TEST(LightSet, LeastDensityIsThatOfTheWidestLight) {
  const vec3 place(0.3F, 0, 0);
  const auto leastOf = [&](const std::vector<Light>& lights) {
    SceneData data = makeFloorScene();
    data.lights = lights;
    return Lit(std::move(data)).lights.leastDensity(place);
  };
  const Light lamp = test::makePoint(vec3(0, 2, 0), vec3(8.0F), 0.1F),
              sun = test::makeSun(vec3(0, -1, 0), vec3(1), 2.0F),
              spark = test::makePoint(vec3(1, 2, 0), vec3(8.0F), 0.0F);
  EXPECT_EQ(leastOf({}), kInfinity);
  EXPECT_EQ(leastOf({spark}), kInfinity);
  EXPECT_EQ(leastOf({test::makePoint(place, vec3(1), 0.5F)}), 0.0F);
  for (const std::vector<Light>& lights : {std::vector{lamp}, std::vector{sun}, std::vector{lamp, sun, spark}}) {
    SceneData data = makeFloorScene();
    data.lights = lights;
    const Lit lit(std::move(data));
    float least = kInfinity;
    for (std::uint32_t i = 0; i < 64; ++i) {
      Sampler sampler(5, 6, i);
      const float choice = sampler.next1D();
      if (const auto s = lit.lights.sample(place, choice, sampler.next2D()); s && !s->delta)
        least = std::min(least, s->pdf);
    }
    EXPECT_NEAR(lit.lights.leastDensity(place), least, 1e-4F * least);
  }
}

TEST(LightSet, LeastDensityHasNoBoundForSurfacesAndEnvironments) {
  SceneData shining = makeFloorScene();
  shining.materials[0].emission = vec3(1.0F);
  EXPECT_EQ(Lit(std::move(shining)).lights.leastDensity(vec3(0, 1, 0)), 0.0F);
  SceneData sky = makeFloorScene();
  sky.environment.emplace().radiance = std::make_shared<Image>(64, 32, 3, 3.0F);
  EXPECT_EQ(Lit(std::move(sky)).lights.leastDensity(vec3(0, 1, 0)), 0.0F);
}

TEST(LightSet, ASpotWithASizeIsSeenFromWhereItShines) {
  SceneData data = makeFloorScene();
  Light spot = test::makePoint(vec3(0, 2, 0), vec3(8.0F), 0.1F);
  spot.kind = LightKind::kSpot;
  spot.direction = vec3(0, -1, 0);
  data.lights.push_back(spot);
  const Lit lit(std::move(data));
  const auto seen = [&](vec3 eye, vec3 dir) {
    float radiance = 0.0F;
    lit.lights.visitSpheres(eye, Ray{eye, dir}, kInfinity,
                            [&](const LightSet::Met& met) { radiance += met.radiance.x; });
    return radiance;
  };
  EXPECT_NEAR(seen(vec3(0, 0.5F, 0), vec3(0, 1, 0)), 8.0F / (kPi * 0.01F), 1e-2F);
  EXPECT_EQ(seen(vec3(0, 4, 0), vec3(0, -1, 0)), 0.0F);
}

TEST(EnvironmentMap, FollowsItsOrientation) {
  // One bright texel at u = 0.75, v = 0.5: towards +X. Turned by 90° about +Y it shines from −Z.
  auto image = std::make_shared<Image>(64, 33, 3, 0.0F);
  image->setRgb(48, 16, vec3(1.0F));
  Environment environment;
  environment.radiance = image;
  EXPECT_GT(EnvironmentMap(environment).radiance(normalize(vec3(1, 0, 0.04F))).x, 0.3F);
  environment.rotation_deg = 90.0F;
  EXPECT_GT(EnvironmentMap(environment).radiance(normalize(vec3(0.04F, 0, -1))).x, 0.3F);
}

TEST(EnvironmentMap, SampleReportsItsOwnDensity) {
  auto image = std::make_shared<Image>(32, 16, 3, 0.1F);
  image->setRgb(5, 4, vec3(50.0F));
  Environment environment;
  environment.radiance = image;
  environment.rotation_deg = 30.0F;
  const EnvironmentMap map(environment);
  for (std::uint32_t i = 0; i < 500; ++i) {
    Sampler sampler(1, 3, i);
    float pdf = 0.0F;
    const vec3 dir = map.sample(sampler.next2D(), pdf);
    EXPECT_NEAR(map.pdf(dir) / pdf, 1.0F, 2e-2F);
  }
}

TEST(IntensityAlong, SpotFallsOffBetweenItsCones) {
  Light spot;
  spot.kind = LightKind::kSpot;
  spot.direction = vec3(0, 0, -1);
  spot.intensity = vec3(3.0F);
  spot.inner_cone = radians(10);
  spot.outer_cone = radians(20);
  const auto at = [&](float angle_deg) {
    return intensityAlong(spot, vec3(std::sin(radians(angle_deg)), 0, -std::cos(radians(angle_deg)))).x;
  };
  EXPECT_FLOAT_EQ(at(5), 3.0F);
  EXPECT_FLOAT_EQ(at(25), 0.0F);
  EXPECT_GT(at(12), at(17));
  EXPECT_GT(at(17), 0.0F);
}

TEST(LightSet, PlacesShineAsMuchAsDirectionsBring) {
  SceneData data = makeFloorScene();
  data.lights.push_back(test::makeSun(vec3(0.3F, -1, 0), vec3(2.0F), 20.0F));
  data.lights.push_back(test::makeSun(vec3(0, -1, 0.2F), vec3(1.0F)));
  data.lights.push_back(test::makePoint(vec3(0.4F, 2, 0), vec3(8.0F), 1.0F));
  data.lights.push_back(test::makePoint(vec3(-1, 1, 0), vec3(3.0F)));
  Material lamp = makeDiffuse(vec3(0.0F));
  lamp.emission = vec3(4.0F);
  addObject(data, makeRectangle("lamp", dvec3(0, 1.5, -1), dvec3(0.5, 0, 0), dvec3(0, 0.2, 0.5)), lamp);
  const Lit lit(std::move(data));
  const double expected = lit.irradiance(vec3(0.1F, 0, 0.2F));
  EXPECT_NEAR(lit.irradianceFromPlaces(vec3(0.1F, 0, 0.2F), 1 << 16), expected, 0.005 * expected);
}

TEST(LightSet, ALineMeetsASphereWhereItComesOut) {
  SceneData data = makeFloorScene();
  data.lights.push_back(test::makePoint(vec3(0, 5, 0), vec3(8.0F), 1.0F));
  const Lit lit(std::move(data));
  LightPlace place;
  place.source = 0;
  for (const float side : {-1.0F, 1.0F}) {
    place.normal = vec3(0, side, 0), place.position = vec3(0, 5.0F + side, 0);
    EXPECT_FLOAT_EQ(lit.lights.distanceTo(place, vec3(0)).value(), 4.0F);
  }
  EXPECT_FALSE(lit.lights.distanceTo(place, vec3(0, 4.5F, 0)));
}

}  // namespace
}  // namespace nephroid
