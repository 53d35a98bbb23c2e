#include "trace/emission.h"

#include <gtest/gtest.h>

#include <utility>

#include "core/sampling/warp.h"
#include "support/tiny_scenes.h"

namespace nephroid {
namespace {

using test::addObject;
using test::makeDiffuse;
using test::makeGlass;

/// A light source and a ball to aim at, nothing else.
struct Aim {
  explicit Aim(SceneData d)
      : data(std::move(d)),
        scene(data),
        materials(scene),
        lights(scene, materials),
        targets(scene, targetFlags()),
        emitters(makeEmitters(scene, materials, lights, targets)) {}
  std::vector<bool> targetFlags() const {
    std::vector<bool> flags;
    for (const Instance& instance : data.instances) flags.push_back(data.materialOf(instance).transmits());
    return flags;
  }
  /// Flux that reaches the ball, and its share of what was emitted.
  struct Result {
    double hit = 0, emitted = 0;
  };
  Result shoot(std::uint32_t count) const {
    Result result;
    for (std::uint32_t i = 0; i < count; ++i) {
      Sampler sampler(1, 1, i);
      const EmittedPhoton photon = emitters.at(0)->emit(sampler);
      EXPECT_NEAR(length(photon.dir), 1.0F, 1e-5F);
      result.emitted += static_cast<double>(photon.flux.x) / count;
      RayHit hit;
      if (photon.flux.x > 0.0F && scene.intersect(Ray{photon.origin, photon.dir}, hit) &&
          scene.materialOf(hit.instance).transmits())
        result.hit += static_cast<double>(photon.flux.x) / count;
    }
    return result;
  }
  SceneData data;
  TraceScene scene;
  MaterialTable materials;
  LightSet lights;
  EmissionTargets targets;
  std::vector<std::unique_ptr<Emitter>> emitters;
};

SceneData makeBall(double radius = 0.5) {
  SceneData data;
  addObject(data, makeSphere("ball", dvec3(1, 2, 3), radius, 256), makeGlass(1.5F));
  return data;
}

TEST(SunEmission, BringsTheBallItsCrossSection) {
  for (const float angle : {0.0F, 0.5F, 10.0F}) {
    SceneData data = makeBall();
    data.lights.push_back(test::makeSun(vec3(1, -2, 0.3F), vec3(10.0F), angle));
    const Aim aim(std::move(data));
    const auto result = aim.shoot(1 << 16);
    // E⊥·πr²: 0.02 % less for the facets of the ball; a wide sun sees the same sphere from every side.
    EXPECT_NEAR(result.hit, 10.0 * kPi * 0.25, 0.01 * 10.0 * kPi * 0.25) << angle;
    if (angle < 1.0F) {
      EXPECT_GT(result.hit / result.emitted, 0.97) << angle;
    }
  }
}

TEST(EmissionExtent, TimesRadianceIsFlux) {
  for (const bool sun : {false, true}) {
    SceneData data = makeBall();
    data.lights.push_back(sun ? test::makeSun(vec3(1, -2, 0.3F), vec3(10.0F), 10.0F)
                              : test::makePoint(vec3(1, 2, 6), vec3(5.0F), 0.3F));
    const Aim aim(std::move(data));
    Sampler sampler(1, 1, 0);
    const EmittedPhoton photon = aim.emitters.at(0)->emit(sampler);
    const EmissionExtent extent = aim.emitters.at(0)->extentOf(photon);
    const float radiance = sun ? sunRadiance(aim.data.lights[0]).x : 5.0F / (kPi * 0.09F);
    EXPECT_NEAR(extent.place * extent.place * extent.direction * extent.direction * radiance, photon.flux.x,
                1e-4F * photon.flux.x);
  }
}

/// Four times as many photons on one side of the square as on the other.
EmissionGuide makeLopsidedGuide() {
  std::vector<float> weights;
  for (int y = 0; y < EmissionGuide::kSide; ++y)
    for (int x = 0; x < EmissionGuide::kSide; ++x) weights.push_back(2 * x < EmissionGuide::kSide ? 1.6F : 0.4F);
  return EmissionGuide(weights, 1e-6F);
}

/// A sun, then a point, with the given size.
SceneData makeLitBall(bool sun, bool wide) {
  SceneData data = makeBall();
  data.lights.push_back(sun ? test::makeSun(vec3(1, -2, 0.3F), vec3(10.0F), wide ? 0.5F : 0.0F)
                            : test::makePoint(vec3(1, 2, 6), vec3(5.0F), wide ? 0.1F : 0.0F));
  return data;
}

/// Flux, and its first moment over where photons start and whereto, per flux.
std::pair<double, dvec3> sumFlux(const Emitter& emitter) {
  constexpr std::uint32_t kCount = 1 << 16;
  double flux = 0.0;
  dvec3 moment(0.0);
  for (std::uint32_t i = 0; i < kCount; ++i) {
    Sampler sampler(1, 1, i);
    const EmittedPhoton photon = emitter.emit(sampler);
    flux += static_cast<double>(photon.flux.x) / kCount;
    moment += dvec3(photon.origin + photon.dir) * static_cast<double>(photon.flux.x) / static_cast<double>(kCount);
  }
  return {flux, moment / flux};
}

TEST(GuidedEmission, KeepsFluxAndWhereItGoes) {
  for (const bool sun : {false, true}) {
    const Aim aim(makeLitBall(sun, true));
    const auto [even_flux, even_moment] = sumFlux(*aim.emitters[0]);
    aim.emitters[0]->guideBy(makeLopsidedGuide());
    const auto [flux, moment] = sumFlux(*aim.emitters[0]);
    EXPECT_NEAR(flux, even_flux, 0.001 * even_flux) << sun;
    // Undivided, it would move by some hundredths: a fifth of the half-width of what is lit.
    EXPECT_LT(glm::length(moment - even_moment), 0.002) << sun;
  }
}

TEST(GuidedEmission, ArrivalDensityTimesFluxIsRadiance) {
  for (const bool sun : {false, true}) {
    const Aim aim(makeLitBall(sun, true));
    Emitter& emitter = *aim.emitters[0];
    emitter.guideBy(makeLopsidedGuide());
    const float radiance = sun ? sunRadiance(aim.data.lights[0]).x : 5.0F / (kPi * 0.01F);
    int wrong = 0, dense = 0;
    for (std::uint32_t i = 0; i < 1000; ++i) {
      Sampler sampler(1, 1, i);
      const EmittedPhoton photon = emitter.emit(sampler);
      const LightRay ray{photon.origin + 3.0F * photon.dir, photon.dir, 3.0F};
      // A photon at the very step of the density may be taken for its neighbour.
      const float ratio = emitter.arrivalDensity(ray) * photon.flux.x / radiance;
      if (std::abs(ratio - 1.0F) > 0.01F) ++wrong;
      if (photon.flux.x < emitter.expectedFlux().x) ++dense;
    }
    EXPECT_LE(wrong, 5) << sun;
    EXPECT_NEAR(dense, 800, 20) << sun;
  }
}

TEST(PointEmission, BringsTheBallItsSolidAngle) {
  for (const float radius : {0.0F, 0.3F}) {
    SceneData data = makeBall();
    data.lights.push_back(test::makePoint(vec3(1, 2, 6), vec3(5.0F), radius));
    const Aim aim(std::move(data));
    const auto result = aim.shoot(1 << 16);
    // Sphere to sphere: I times the solid angle of the ball from the centre, in the far field; the exchange of a
    // spherical light differs by less than (r/d)² = 1 %.
    const double solid_angle = 2.0 * kPi * (1.0 - std::sqrt(1.0 - 0.25 / 9.0));
    EXPECT_NEAR(result.hit, 5.0 * solid_angle, (radius > 0 ? 0.015 : 0.003) * 5.0 * solid_angle) << radius;
    if (radius == 0.0F) {
      EXPECT_GT(result.hit / result.emitted, 0.95);
    }
  }
}

TEST(PointEmission, FromInsideTheTargetsMissesNothing) {
  SceneData data;
  addObject(data, makeSphere("shell", dvec3(0), 2.0, 64), makeGlass(1.5F));
  data.lights.push_back(test::makePoint(vec3(0.1F, 0.2F, 0), vec3(1.0F)));
  const Aim aim(std::move(data));
  const auto result = aim.shoot(1 << 14);
  EXPECT_NEAR(result.hit, 4.0 * kPi, 1e-3 * 4.0 * kPi);
}

TEST(SpotEmission, StaysInsideItsCone) {
  SceneData data = makeBall(1.0);
  Light spot = test::makePoint(vec3(1, 2, 6), vec3(5.0F));
  spot.kind = LightKind::kSpot;
  spot.direction = vec3(0, 0, -1);
  spot.inner_cone = spot.outer_cone = 0.1F;
  data.lights.push_back(spot);
  const Aim aim(std::move(data));
  const auto result = aim.shoot(1 << 15);
  // The cone is narrower than the ball: all of it arrives.
  const double flux = 5.0 * 2.0 * kPi * (1.0 - std::cos(0.1));
  EXPECT_NEAR(result.hit, flux, 0.01 * flux);
}

TEST(MeshEmission, EqualsTheFormFactorOfASmallLight) {
  SceneData data = makeBall();
  Material lamp;
  lamp.name = "lamp";
  lamp.emission = vec3(7.0F);
  // A square of 2 cm, 3 m above the ball, facing down: flux L·A·sin²(half-angle), with cos ≈ its mean over the cone.
  addObject(data, makeRectangle("lamp", dvec3(1, 5, 3), dvec3(0.01, 0, 0), dvec3(0, 0, 0.01)), lamp);
  const Aim aim(std::move(data));
  const auto result = aim.shoot(1 << 15);
  const double expected = 7.0 * 4e-4 * kPi * 0.25 / 9.0;
  EXPECT_NEAR(result.hit, expected, 0.005 * expected);
}

TEST(EnvironmentEmission, BringsTheBallPiTimesRadianceOnItsWholeSurface) {
  SceneData data = makeBall();
  Environment environment;
  environment.radiance = std::make_shared<Image>(32, 16, 3, 2.0F);
  data.environment = environment;
  const Aim aim(std::move(data));
  const auto result = aim.shoot(1 << 16);
  // E = πL on every point of a convex body: flux = πL·4πr².
  const double expected = kPi * 2.0 * 4.0 * kPi * 0.25;
  EXPECT_NEAR(result.hit, expected, 0.01 * expected);
}

TEST(MakeEmitters, NothingToAimAtMeansNoEmitter) {
  SceneData data;
  addObject(data, test::makeFloor(4.0), makeDiffuse(vec3(0.5F)));
  data.lights.push_back(test::makeSun(vec3(0, -1, 0), vec3(1.0F)));
  const Aim aim(std::move(data));
  EXPECT_TRUE(aim.emitters.empty());
}

}  // namespace
}  // namespace nephroid
