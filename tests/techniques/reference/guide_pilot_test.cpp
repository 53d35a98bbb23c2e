#include "techniques/reference/guide_pilot.h"

#include <gtest/gtest.h>

#include <cmath>

#include "support/tiny_scenes.h"

namespace nephroid {
namespace {

using test::makeSettings;
using test::renderReference;

constexpr int kSize = 64, kBlock = 16;

/// A ball whose caustic lies at the edge of what the camera sees: most photons are of no use.
SceneData makeScene() {
  SceneData scene = test::makeBallScene(test::makeGlass(1.5F), 64);
  scene.lights.push_back(test::makeSun(vec3(0.3F, -1, 0.1F), vec3(5.0F, 4.0F, 3.0F), 0.5F));
  return scene;
}
Camera makeView() { return makeCamera("floor", vec3(3.5F, 3.0F, 2.5F), vec3(0.75F, 0, 0.3F), radians(16)); }

RenderResult render(std::string_view estimator, float guiding, std::uint32_t seed) {
  RenderSettings settings = makeSettings(kSize, 1, 65'536, {"caustic"});
  settings.seed = seed;
  settings.params.set("estimator", std::string(estimator));
  settings.params.set("guiding", std::to_string(guiding));
  return renderReference(makeScene(), makeView(), settings);
}

/// Mean and mean square over scramblings of each block's mean; and what guiding is to lessen, the sum over pixels of
/// the variance over the mean.
struct Statistics {
  std::vector<double> mean, square;
  double weighted_variance = 0.0;
};
Statistics measure(std::string_view estimator, float guiding) {
  constexpr int kBlocks = kSize / kBlock;
  Statistics s{std::vector<double>(kBlocks * kBlocks, 0.0), std::vector<double>(kBlocks * kBlocks, 0.0)};
  std::vector<double> sum(kSize * kSize, 0.0), squares(kSize * kSize, 0.0);
  constexpr int kScramblings = 16;
  for (std::uint32_t seed = 1; seed <= kScramblings; ++seed) {
    const RenderResult result = render(estimator, guiding, seed);
    const Image& caustic = *result.image.find("caustic");
    std::vector<double> blocks(s.mean.size(), 0.0);
    for (int y = 0; y < kSize; ++y)
      for (int x = 0; x < kSize; ++x) {
        const double v = caustic.rgb(x, y).x;
        blocks[static_cast<std::size_t>(y / kBlock) * kBlocks + x / kBlock] += v / (kBlock * kBlock);
        sum[static_cast<std::size_t>(y) * kSize + x] += v / kScramblings;
        squares[static_cast<std::size_t>(y) * kSize + x] += v * v / kScramblings;
      }
    for (std::size_t b = 0; b < blocks.size(); ++b) {
      s.mean[b] += blocks[b] / kScramblings;
      s.square[b] += blocks[b] * blocks[b] / kScramblings;
    }
  }
  double mean = 0.0;
  for (const double pixel : sum) mean += pixel / (kSize * kSize);
  for (std::size_t p = 0; p < sum.size(); ++p)
    s.weighted_variance += (squares[p] - sum[p] * sum[p]) / (sum[p] + 0.1 * mean);
  return s;
}

class Guided : public ::testing::TestWithParam<std::string> {};

TEST_P(Guided, AgreesWithEvenEmissionBlockByBlock) {
  const Statistics even = measure(GetParam(), 0.0F), guided = measure(GetParam(), 0.7F);
  int lit = 0;
  for (std::size_t b = 0; b < even.mean.size(); ++b) {
    if (even.mean[b] <= 0.0) continue;
    ++lit;
    const auto variance = [&](const Statistics& s) { return (s.square[b] - s.mean[b] * s.mean[b]) / 15.0; };
    const double error = std::sqrt(variance(even) + variance(guided));
    // 16 blocks and a t-distribution of some 25 degrees of freedom: 4.5 is passed by chance once in 500.
    EXPECT_NEAR(guided.mean[b], even.mean[b], 4.5 * error + 1e-9) << b;
  }
  EXPECT_GE(lit, 6);
  // Where footprints overlap much, even photons cancel each other's noise, which is as good.
  if (GetParam() == "light") {
    EXPECT_LT(guided.weighted_variance, 0.8 * even.weighted_variance);
  }
}
INSTANTIATE_TEST_SUITE_P(Estimators, Guided, ::testing::Values("light", "footprint"),
                         [](const auto& tested) { return tested.param; });

TEST(Guiding, SaysWhatItDidAndEmitsTheSameFlux) {
  const RenderResult even = render("footprint", 0.0F, 1), guided = render("footprint", 0.7F, 1);
  const auto says = [](const RenderResult& result) {
    return std::any_of(result.notes.begin(), result.notes.end(),
                       [](const std::string& note) { return note.find(" guided: ") != std::string::npos; });
  };
  EXPECT_FALSE(says(even));
  EXPECT_TRUE(says(guided));
  const double emitted = even.ledgers.at(0).emitted.x;
  EXPECT_NEAR(guided.ledgers.at(0).emitted.x, emitted, 0.003 * emitted);
  EXPECT_LT(std::abs(guided.ledgers.at(0).residual()), 1e-5);
}

}  // namespace
}  // namespace nephroid
