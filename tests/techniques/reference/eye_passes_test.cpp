// Where the next paths from the eye go, and what a picture gains by it.
#include "techniques/reference/eye_passes.h"

#include <gtest/gtest.h>

#include <atomic>
#include <cmath>
#include <functional>
#include <numeric>

#include "core/parallel.h"
#include "support/tiny_scenes.h"

namespace nephroid {
namespace {

constexpr auto kNeverStopped = [] { return false; };

TEST(PictureTiles, HoldEveryPixelOnce) {
  const PictureTiles tiles(19, 9);
  EXPECT_EQ(tiles.count(), 6U);
  std::vector<int> visits(std::size_t{19 * 9}, 0);
  for (std::size_t tile = 0; tile < tiles.count(); ++tile) {
    tiles.visitPixels(tile, [&](int x, int y) {
      ++visits[tiles.pixelOf(x, y)];
      EXPECT_EQ(tiles.tileOf(x, y), tile);
    });
  }
  EXPECT_EQ(visits, std::vector<int>(visits.size(), 1));
}

/// Passes of a picture whose pixels cost `rays(x)` each.
EyePasses passesAfter(int rounds, const std::function<std::uint64_t(int)>& rays) {
  EyePasses passes(64, 8);
  for (int i = 0; i < rounds; ++i) {
    passes.planAll();
    passes.run([&](int x, int, std::uint32_t) { return rays(x); }, kNeverStopped);
  }
  return passes;
}

TEST(EyePasses, GoWhereARayLessensTheErrorMost) {
  // Eight tiles, the last four of which cost four times as much.
  EyePasses passes = passesAfter(4, [](int x) { return x < 32 ? 1U : 4U; });
  const std::vector<double> variances{16.0, 1.0, 1.0, 1.0, 64.0, 1.0, 1.0, 4.0};
  std::atomic<std::uint64_t> rays{0};
  for (int round = 0; round < 400; ++round) {
    passes.planWhereItPays(variances, 4);
    passes.run(
        [&](int x, int, std::uint32_t) {
          const std::uint64_t cost = x < 32 ? 1 : 4;
          rays += cost;
          return cost;
        },
        kNeverStopped);
  }
  // A round costs a pass over everything, 8 × 8 × 4 × (1 + 4) rays, and what its last tile takes beyond.
  EXPECT_GE(rays, 400U * 1280U);
  EXPECT_LE(rays, 400U * (1280U + 8 * 8 * 4 * 4));
  // n in proportion to √(v/c).
  const std::span<const std::uint64_t> done = passes.done();
  const double unit = static_cast<double>(done[1]);
  const double expected[] = {4.0, 1.0, 1.0, 1.0, 4.0, 0.5, 0.5, 1.0};
  for (std::size_t t = 0; t < done.size(); ++t) {
    EXPECT_NEAR(static_cast<double>(done[t]) / unit, expected[t], 0.05 * expected[t]) << t;
    EXPECT_EQ(done[t] % 4, 0U);
  }
}

TEST(EyePasses, TakeSamplesInOrderAndRememberWhereTheyWereStopped) {
  EyePasses passes = passesAfter(1, [](int) { return 1U; });
  std::vector<std::uint32_t> next(64, 1U);  // of the uppermost row's pixels
  passes.planWhereItPays(std::vector<double>(8, 1.0), 4);
  int begun = 0;
  const auto trace = [&](int x, int y, std::uint32_t sample) {
    if (y == 0) {
      EXPECT_EQ(sample, next[static_cast<std::size_t>(x)]++);
    }
    return 1U;
  };
  runWithThreads(1, [&] { passes.run(trace, [&] { return ++begun > 1; }); });
  EXPECT_TRUE(passes.planned());
  passes.run(trace, kNeverStopped);
  EXPECT_FALSE(passes.planned());
  // To the next multiple of four; rays for a whole pass did for three tiles.
  EXPECT_EQ(std::accumulate(next.begin(), next.end(), 0U), 3U * 8U * 4U + 5U * 8U);
  EXPECT_EQ(passes.meanPasses(), 2U);
}

/// A glass ball in a room's corner: all that is noisy is seen in it.
SceneData makeCorner() {
  SceneData scene = test::makeBallScene(test::makeGlass(1.5F), 64);
  test::addObject(scene, makeRectangle("wall", dvec3(-2, 2, 0), dvec3(0, 2, 0), dvec3(0, 0, 3)),
                  test::makeDiffuse(vec3(0.7F)));
  Material lamp = test::makeDiffuse(vec3(0.0F));
  lamp.emission = vec3(5.0F);
  test::addObject(scene, makeRectangle("lamp", dvec3(1, 4, 0), dvec3(1, 0, 0), dvec3(0, 0, 1)), lamp);
  return scene;
}

/// Such that most passes come after it is known where the noise is.
RenderSettings settingsFor(bool adaptive) {
  RenderSettings settings = test::makeSettings(32, 0, 0, {"direct", "specular"});
  settings.params.set("estimator", "path");
  settings.target_error = 0.005;
  settings.params.set("adaptive", adaptive ? "true" : "false");
  return settings;
}

TEST(AdaptivePasses, ReachATargetWithFewerRays) {
  const SceneData scene = makeCorner();
  const Camera camera = makeCamera("corner", vec3(3.5F, 3.0F, 3.0F), vec3(0, 0.6F, 0), radians(55));
  const RenderResult everywhere = test::renderReference(scene, camera, settingsFor(false));
  const RenderResult adaptive = test::renderReference(scene, camera, settingsFor(true));
  RecordProperty("rays_ratio",
                 std::to_string(static_cast<double>(adaptive.stats.rays) / static_cast<double>(everywhere.stats.rays)));
  EXPECT_LT(static_cast<double>(adaptive.stats.rays), 0.8 * static_cast<double>(everywhere.stats.rays));
}

TEST(AdaptivePasses, LeaveTheMeanAsItIs) {
  const SceneData scene = makeCorner();
  const Camera camera = makeCamera("corner", vec3(3.5F, 3.0F, 3.0F), vec3(0, 0.6F, 0), radians(55));
  // Where a tile's own noise decides how often it is seen, its mean could suffer: dark tiles would stay dark.
  constexpr int kRenders = 24;
  double mean[2] = {}, squares[2] = {};
  for (int seed = 0; seed < kRenders; ++seed) {
    for (const bool adaptive : {false, true}) {
      RenderSettings settings = settingsFor(adaptive);
      settings.seed = static_cast<std::uint64_t>(seed);
      const dvec3 value = test::meanOf(test::renderReference(scene, camera, settings).image.layers[1].image);
      mean[adaptive] += value.y / kRenders, squares[adaptive] += value.y * value.y / kRenders;
    }
  }
  double variance = 0.0;
  for (int i = 0; i < 2; ++i) variance += (squares[i] - mean[i] * mean[i]) / (kRenders - 1);
  EXPECT_NEAR(mean[1], mean[0], 3.0 * std::sqrt(variance));
  EXPECT_LT(std::sqrt(variance), 0.015 * mean[0]);
}

}  // namespace
}  // namespace nephroid
