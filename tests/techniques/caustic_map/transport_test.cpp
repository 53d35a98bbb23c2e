#include "techniques/caustic_map/transport.h"

#include <cmath>
#include <map>

#include "core/optics/fresnel.shared.h"
#include "frame/light_views.h"
#include "frame/view.h"
#include "support/gpu_fixture.h"
#include "support/tiny_scenes.h"
#include "techniques/caustic_map/emission_views.h"

namespace nephroid {
namespace {

constexpr std::uint32_t kGrid = 128;

struct Flown {
  std::vector<Photon> photons;
  std::vector<ViewRecord> views;  ///< of the emission
  LightRecord light;
  std::map<std::uint32_t, int> outcomes;

  static std::uint32_t outcomeOf(const Photon& p) { return photonFlags(p) >> kOutcomeShift; }
};

class TransportTest : public testing::GpuTest {
 protected:
  /// Photons of the first light, through its first view.
  static Flown fly(const SceneData& scene, TransportSettings settings, std::uint32_t layers = 4) {
    Flown flown;
    const LightView light = *LightViews(scene, 0).make(0, 0);
    flown.light = light.light;
    flown.views = makeEmissionViews(light.light, generatorBounds(scene, 0.25F), scene.bounds());
    gpu::CommandRecorder recorder(device());
    recorder.begin();
    const SceneBuffers buffers(device(), recorder, scene, 0.25F);
    std::vector<std::size_t> all, generators, receivers;
    for (std::size_t i = 0; i < buffers.draws().size(); ++i) {
      all.push_back(i);
      if (buffers.draws()[i].generates) generators.push_back(i);
      if (buffers.draws()[i].receives && !buffers.draws()[i].generates) receivers.push_back(i);
    }
    const auto views = static_cast<std::uint32_t>(flown.views.size());
    SurfaceLayers first(device(), buffers, kGrid, views, 1), inner(device(), buffers, kGrid, views, layers),
        outer(device(), buffers, kGrid, static_cast<std::uint32_t>(light.views.size()), 1);
    first.record(recorder, flown.views, all);
    inner.record(recorder, flown.views, generators);
    outer.record(recorder, light.views, receivers);
    const gpu::Buffer lights = gpu::makeBuffer<LightRecord>(device(), recorder, std::span(&flown.light, 1),
                                                            VK_BUFFER_USAGE_STORAGE_BUFFER_BIT, "lights");
    const PhotonBuffer photons(device(), kGrid * kGrid);
    Transport transport(device(), buffers);
    settings.grid = kGrid;
    transport.record(recorder,
                     {flown.views, generatorBounds(scene, 0.25F), scene.bounds(), light.views, first, inner, outer},
                     lights, 0, 0, settings, photons);
    recorder.submit();
    flown.photons = readPhotons(device(), photons);
    for (const Photon& p : flown.photons) ++flown.outcomes[Flown::outcomeOf(p)];
    return flown;
  }
};

/// A glass box over a floor.
SceneData makeSlab(vec3 sun, float ior = 1.5F) {
  SceneData scene;
  test::addObject(scene, test::makeFloor(12.0), test::makeDiffuse(vec3(0.6F)));
  test::addObject(scene, makeBox("slab", dvec3(-1, 1, -1), dvec3(1, 1.2, 1)), test::makeGlass(ior));
  scene.lights.push_back(test::makeSun(sun, vec3(1, 2, 3)));
  return scene;
}

TEST_F(TransportTest, ASlabMovesLightAside) {
  const vec3 dir = normalize(vec3(0.5F, -1, 0.2F));
  const Flown flown = fly(makeSlab(dir), {.branch = 1});
  const double cos_i = -double{dir.y}, sin_i = std::sqrt(1.0 - cos_i * cos_i), sin_t = sin_i / 1.5,
               cos_t = std::sqrt(1.0 - sin_t * sin_t);
  const double r = fresnelDielectric(static_cast<float>(cos_i), 1.0F / 1.5F);
  int through = 0;
  for (const Photon& p : flown.photons) {
    if (!hasPhotonFlag(p, kPhotonValid)) continue;
    const float x = (static_cast<float>(p.index % kGrid) + 0.5F) * 2.0F / kGrid - 1.0F;
    const float y = (static_cast<float>(p.index / kGrid) + 0.5F) * 2.0F / kGrid - 1.0F;
    const vec3 start = flown.views[0].eye + x * flown.views[0].right - y * flown.views[0].up;
    // Where it meets the upper face, and where it would leave the lower one.
    const dvec3 upper = dvec3(start) + (1.2 - start.y) / dir.y * dvec3(dir);
    const dvec2 across = dvec2(dir.x, dir.z) / sin_i;
    const dvec2 lower = dvec2(upper.x, upper.z) + across * (0.2 * sin_t / cos_t);
    // Through the sides light goes elsewhere.
    if (std::max(std::abs(upper.x), std::abs(upper.z)) > 0.97 || std::max(std::abs(lower.x), std::abs(lower.y)) > 0.97)
      continue;
    ++through;
    const dvec2 end = lower + across * (1.0 * sin_i / cos_i);
    ASSERT_NEAR(p.position.x, end.x, 2e-5) << p.index;
    ASSERT_NEAR(p.position.y, 0.0, 1e-5);
    ASSERT_NEAR(p.position.z, end.y, 2e-5);
    ASSERT_NEAR(dot(p.direction, dir), 1.0F, 1e-6F);
    const double cell = 4.0 * length(flown.views[0].right) * length(flown.views[0].up) / (kGrid * kGrid);
    ASSERT_NEAR(p.flux.y / (2.0 * cell * (1.0 - r) * (1.0 - r)), 1.0, 1e-4);
    ASSERT_NEAR(p.path_length, 1.0 / cos_i, 1e-4);
  }
  EXPECT_GT(through, 2000);
}

TEST_F(TransportTest, WhatASlabReflectsGoesUp) {
  // And what its sides reflect goes down.
  const vec3 dir = normalize(vec3(0.5F, -1, 0.2F));
  const Flown flown = fly(makeSlab(dir), {.branch = 0});
  int up = 0, down = 0;
  for (const Photon& p : flown.photons) {
    const std::uint32_t outcome = Flown::outcomeOf(p);
    if (outcome == kOutcomeEscaped && p.direction.y > 0.0F) ++up;
    if (outcome == kOutcomeDeposited) {
      ++down;
      EXPECT_NEAR(p.direction.y, dir.y, 1e-5F);
    }
  }
  EXPECT_GT(up, 2000);
  EXPECT_GT(down, 50);
  EXPECT_EQ(flown.outcomes.count(kOutcomeHidden), 0U);
}

/// Through a ball of radius 1 at (0, 1.2, 0) by formulas; straight down at distance `b` from its axis.
struct BallLens {
  double end;    ///< distance from the axis at y = 0, signed
  double share;  ///< of flux
};
BallLens throughBall(double b, double n) {
  const double i = std::asin(b), t = std::asin(b / n);
  // After both refractions the ray is turned by 2 (i − t), and leaves at the angle 2t − i below the axis.
  const double turn = 2.0 * (i - t), at = 2.0 * t - i;
  const double x = std::sin(at), y = 1.2 - std::cos(at);
  const double r = fresnelDielectric(static_cast<float>(std::cos(i)), static_cast<float>(1.0 / n));
  return {x - y * std::tan(turn), (1.0 - r) * (1.0 - r)};
}

TEST_F(TransportTest, ABallFocuses) {
  SceneData scene = test::makeBallScene(test::makeGlass(1.5F), 512);
  scene.lights.push_back(test::makeSun(vec3(0, -1, 0), vec3(1)));
  const Flown flown = fly(scene, {.branch = 1});
  int through = 0, inside = 0;
  double worst = 0.0, sum = 0.0;
  for (const Photon& p : flown.photons) {
    const float x = (static_cast<float>(p.index % kGrid) + 0.5F) * 2.0F / kGrid - 1.0F;
    const float y = (static_cast<float>(p.index / kGrid) + 0.5F) * 2.0F / kGrid - 1.0F;
    const vec3 start = flown.views[0].eye + x * flown.views[0].right - y * flown.views[0].up;
    const double b = std::hypot(double{start.x}, double{start.z});
    // At the rim the facets count.
    if (b > 0.97 || b < 1e-3) continue;
    ++inside;
    if (!hasPhotonFlag(p, kPhotonValid)) continue;
    ++through;
    const BallLens lens = throughBall(b, 1.5);
    const double found = (double{p.position.x} * start.x + double{p.position.z} * start.z) / b;
    worst = std::max(worst, std::abs(found - lens.end));
    sum += std::abs(found - lens.end);
    ASSERT_NEAR(p.flux.x / (4.0 * length(flown.views[0].right) * length(flown.views[0].up) / (kGrid * kGrid)),
                lens.share, 3e-3);
  }
  EXPECT_GT(inside, 5000);
  EXPECT_EQ(through, inside);
  EXPECT_LT(worst, 1e-2);
  EXPECT_LT(sum / through, 2e-4);
}

TEST_F(TransportTest, EveryPhotonSaysWhatBecameOfIt) {
  SceneData scene = test::makeBallScene(test::makeGlass(1.5F), 128);
  // A board that shades half of the ball.
  test::addObject(scene, makeRectangle("board", dvec3(1.0, 3.0, 0.0), dvec3(0, 0, 1.5), dvec3(1.0, 0, 0)),
                  test::makeDiffuse(vec3(0.5F)));
  scene.lights.push_back(test::makePoint(vec3(0, 6, 0), vec3(10)));
  const Flown flown = fly(scene, {.branch = 1});
  int sum = 0;
  for (const auto& [outcome, count] : flown.outcomes) sum += count;
  EXPECT_EQ(sum, static_cast<int>(kGrid * kGrid));
  // In the corners of the square light passes the ball and meets the floor, which bends nothing.
  EXPECT_GT(flown.outcomes.at(kOutcomeBlocked), static_cast<int>(kGrid * kGrid / 2));
  EXPECT_GT(flown.outcomes.at(kOutcomeDeposited), 3500);
}

}  // namespace
}  // namespace nephroid
