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

TEST(PictureTiles, KnowThoseThatTouch) {
  const PictureTiles tiles(40, 17);  // five columns, three rows
  const auto around = [&](std::size_t tile) {
    std::vector<std::size_t> others;
    tiles.visitAround(tile, [&](std::size_t other) { others.push_back(other); });
    return others;
  };
  EXPECT_EQ(around(0), (std::vector<std::size_t>{0, 1, 5, 6}));
  EXPECT_EQ(around(7), (std::vector<std::size_t>{1, 2, 3, 6, 7, 8, 11, 12, 13}));
  EXPECT_EQ(around(14), (std::vector<std::size_t>{8, 9, 13, 14}));
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
    passes.planWhereItPays(variances);
    passes.run(
        [&](int x, int, std::uint32_t) {
          const std::uint64_t cost = x < 32 ? 1 : 4;
          rays += cost;
          return cost;
        },
        kNeverStopped);
  }
  // A round costs a pass over everything, 8 × 8 × 4 × (1 + 4) rays, but for half a pass of each tile in the end.
  EXPECT_NEAR(static_cast<double>(rays), 400.0 * 1280.0, 640.0);
  // n in proportion to √(v/c).
  const std::span<const std::uint64_t> done = passes.done();
  const double unit = static_cast<double>(done[1]);
  const double expected[] = {4.0, 1.0, 1.0, 1.0, 4.0, 0.5, 0.5, 1.0};
  for (std::size_t t = 0; t < done.size(); ++t) {
    EXPECT_NEAR(static_cast<double>(done[t]) / unit, expected[t], 0.05 * expected[t]) << t;
  }
}

TEST(EyePasses, AreSpreadEvenlyOverRounds) {
  EyePasses passes = passesAfter(8, [](int) { return 1U; });
  const std::vector<double> variances{25.0, 1.0, 4.0, 2.0, 9.0, 1.0, 0.0, 3.0};
  const auto round = [&] {
    passes.planWhereItPays(variances);
    passes.run([](int, int, std::uint32_t) { return 1U; }, kNeverStopped);
  };
  for (int i = 0; i < 200; ++i) round();
  const std::vector<std::uint64_t> first(passes.done().begin(), passes.done().end());
  constexpr int kRounds = 40;
  for (int i = 1; i <= kRounds; ++i) {
    const std::vector<std::uint64_t> before(passes.done().begin(), passes.done().end());
    round();
    for (std::size_t t = 0; t < first.size(); ++t) {
      // n in proportion to √v and 8 a round; whoever is done gets a fifth of the mean.
      const double gained = static_cast<double>(passes.done()[t] - before[t]);
      const double rate = variances[t] > 0.0 ? 8.0 * std::sqrt(variances[t]) / 16.56 : 0.2;
      EXPECT_NEAR(gained, rate, 1.2) << t;
      EXPECT_NEAR(static_cast<double>(passes.done()[t] - first[t]), rate * i, 1.0 + 0.1 * rate * i) << t;
    }
  }
}

TEST(EyePasses, GoEverywhereWhereNothingIsNoisy) {
  EyePasses passes = passesAfter(4, [](int x) { return x < 32 ? 0U : 3U; });
  passes.planWhereItPays(std::vector<double>(8, 0.0));
  passes.run([](int, int, std::uint32_t) { return 0U; }, kNeverStopped);
  for (const std::uint64_t done : passes.done()) EXPECT_EQ(done, 5U);
}

TEST(EyePasses, TakeSamplesInOrderAndRememberWhereTheyWereStopped) {
  EyePasses passes = passesAfter(1, [](int) { return 1U; });
  std::vector<std::uint32_t> next(64, 1U);  // of the uppermost row's pixels
  std::vector<double> variances(8, 1.0);
  variances[0] = 9.0;
  passes.planWhereItPays(variances);
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
  // The first tile is to have three times as many after two rounds, 4.8 and 1.6: it gets 3.8, the others 0.6.
  EXPECT_EQ(std::accumulate(next.begin(), next.end(), 0U), 8U * 5U + 7U * 8U * 2U);
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
