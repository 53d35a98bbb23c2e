// Standard errors against the spread of independent renders, and renders that end by them.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "core/sampling/sampler.h"
#include "nephroid/error.h"
#include "support/tiny_scenes.h"
#include "techniques/layers.h"
#include "techniques/reference/error_estimate.h"

namespace nephroid {
namespace {

using test::addObject;
using test::makeDiffuse;
using test::makeGlass;
using test::makeSettings;
using test::renderReference;

/// A glass ball under a lamp, a mirror behind it: something in every layer.
SceneData makeScene() {
  SceneData scene = test::makeBallScene(makeGlass(1.5F), 64);
  Material lamp = makeDiffuse(vec3(0.0F));
  lamp.emission = vec3(5.0F, 4.0F, 3.0F);
  addObject(scene, makeRectangle("lamp", dvec3(0, 4, 0), dvec3(1, 0, 0), dvec3(0, 0, 1)), lamp);
  addObject(scene, makeRectangle("mirror", dvec3(-2, 1.5, 0), dvec3(0, 1.5, 0), dvec3(0, 0, 3)),
            test::makeMetal(vec3(0.9F)));
  return scene;
}
Camera lookAtBall() { return makeCamera("ball", vec3(3.5F, 4.0F, 3.0F), vec3(0, 0.6F, 0), radians(45)); }

std::vector<std::string> withErrors(const std::vector<std::string>& layers) {
  std::vector<std::string> both = layers;
  for (const std::string& layer : layers) both.push_back(layer + "_error");
  return both;
}

/// Ratio of the mean estimated variance to the variance between renders of other seeds, over the whole picture.
double ratioOfVariances(const std::vector<RenderResult>& renders, const std::string& layer) {
  const auto n = static_cast<double>(renders.size());
  double estimated = 0.0, observed = 0.0;
  for (std::size_t i = 0; i < renders[0].image.find(layer)->pixels.size(); ++i) {
    double sum = 0.0, squares = 0.0;
    for (const RenderResult& render : renders) {
      const double value = render.image.find(layer)->pixels[i], error = render.image.find(layer + "_error")->pixels[i];
      sum += value, squares += value * value;
      estimated += error * error / n;
    }
    observed += (squares - sum * sum / n) / (n - 1.0);
  }
  return estimated / observed;
}

TEST(ErrorEstimate, IsTheSpreadBetweenIndependentRenders) {
  const std::vector<std::string> layers{"beauty", "direct", "caustic", "specular", "indirect", "specular_caustic"};
  RenderSettings settings = makeSettings(24, 64, 1 << 17, withErrors(layers));
  std::vector<RenderResult> renders;
  for (int seed = 0; seed < 24; ++seed) {
    settings.seed = static_cast<std::uint64_t>(seed);
    renders.push_back(renderReference(makeScene(), lookAtBall(), settings));
  }
  // Points that are well spread err less than the spread of their batches: never rated too low, `direct`, which is all
  // but smooth here, up to three times too high. From 24 renders of 576 pixels the ratio itself is known to some 2 %.
  for (const std::string& layer : layers) {
    const double ratio = ratioOfVariances(renders, layer);
    EXPECT_GT(ratio, 0.95) << layer;
    EXPECT_LT(ratio, layer == "direct" ? 3.5 : 1.6) << layer;
  }
}

TEST(ErrorEstimate, OfBatchesIsTheTextbookVariance) {
  // Passes of 1, 3 | 8 | 6: sums 4, 8, 6 of 2, 1, 1 passes. Mean 18/4; Σ S²/n = 8 + 64 + 36 = 108; S²/N = 81.
  BatchSpread spread(1);
  dvec3 deviations = spread.close(0, dvec3(4.0, 0.0, 1.0), 2.0, 0.0);
  deviations += spread.close(0, dvec3(12.0, 0.0, 1.5), 1.0, 2.0);
  deviations += spread.close(0, dvec3(18.0, 0.0, 2.0), 1.0, 3.0);
  const dvec3 variance = spread.varianceOfPass(0, 3, 4);
  EXPECT_DOUBLE_EQ(variance.x, (108.0 - 81.0) / 2.0);
  EXPECT_EQ(variance.y, 0.0);
  EXPECT_DOUBLE_EQ(variance.z, 0.0);  // every pass gave 0.5
  EXPECT_DOUBLE_EQ(deviations.x, 108.0 - 81.0);
  EXPECT_EQ(deviations.y, 0.0);
  EXPECT_DOUBLE_EQ(deviations.z, 0.0);
}

// Batches 2, 6 | 4, 8 | 6, 2 of one pass each: pairs have the sums 8, 12, 8 of two passes each, mean 14/3, and
// Σ S²/2 = 136, 28²/6 = 130.67. Another generation begins with sums of its own.
TEST(ErrorEstimate, OfPairsIsTheSpreadOfTheirSums) {
  BatchSpread spread(1);
  spread.close(0, dvec3(7.0), 1.0, 0.0);
  spread.beginGeneration(0);
  double sum = 7.0, passes = 0.0, paired = 0.0;
  dvec3 deviations(0.0);
  for (const double value : {2.0, 6.0, 4.0, 8.0, 6.0, 2.0}) {
    spread.close(0, dvec3(sum += value), 1.0, passes);
    passes += 1.0;
    if (passes != paired + 2.0) continue;
    deviations += spread.closePair(0, 2.0, paired);
    paired = passes;
  }
  EXPECT_NEAR(deviations.x, 136.0 - 28.0 * 28.0 / 6.0, 1e-12);
}

/// Estimate of relMSE over what it is, of pixels that straight edges cross.
double ratioAtEdges(bool spread_well) {
  constexpr int kSide = 64, kPasses = 256;
  Film film(kSide, kSide, LayerNeeds({"direct"}));
  ErrorEstimate errors(film, {"direct"});
  std::vector<std::uint64_t> passes(PictureTiles(kSide, kSide).count(), 0);
  std::vector<double> covered(kSide * kSide);
  std::vector<float> slope(covered.size());
  for (std::uint32_t pixel = 0; pixel < covered.size(); ++pixel) {
    const vec2 u = Sampler(1, pixel, 0).next2D();
    covered[pixel] = 0.3 + 0.4 * u.x;
    slope[pixel] = (u.y < 0.5F ? -1.0F : 1.0F) * (0.3F + 0.6F * std::abs(u.y - 0.5F));
  }
  for (std::uint32_t pass = 0; pass < kPasses; ++pass) {
    for (std::uint32_t pixel = 0; pixel < covered.size(); ++pixel) {
      const vec2 u = Sampler(spread_well ? 2 : 3 + pass, pixel, spread_well ? pass : 0).next2D();
      if (u.x < static_cast<float>(covered[pixel]) + slope[pixel] * (u.y - 0.5F)) film.direct.add(pixel, vec3(1.0F));
    }
    for (std::uint64_t& n : passes) ++n;
    errors.closeFullEyeBatches(passes, 1);
  }
  double mean = 0.0, measured = 0.0;
  for (const double value : covered) mean += value / static_cast<double>(covered.size());
  for (std::size_t pixel = 0; pixel < covered.size(); ++pixel) {
    const double difference = film.direct.at(pixel).x / kPasses - covered[pixel];
    measured += difference * difference / (covered[pixel] * covered[pixel] + 1e-4 * mean * mean);
  }
  return errors.relMse("direct").from_eye * static_cast<double>(covered.size()) / measured;
}

// Over an edge the variance of well-spread points falls as N^(-3/2): batches of an eighth alone would say three times
// as much as it is. From 4096 pixels it is known to some 3 %, how it declines to some 10 %.
TEST(ErrorEstimate, KnowsThatPointsThatAreSpreadWellErrLess) {
  EXPECT_NEAR(ratioAtEdges(true), 1.0, 0.25);
  EXPECT_NEAR(ratioAtEdges(false), 1.0, 0.2);
}

// What single batches of photons differ by, but not blocks of two: points that are spread well.
TEST(ErrorEstimate, IsWhatTheLastGenerationsOfBatchesSay) {
  Film film(1, 1, LayerNeeds({"caustic"}));
  ErrorEstimate errors(film, {"caustic"});
  const auto trace = [&](std::uint64_t batch) {
    film.caustic.add(0, vec3(batch % 2 ? 3.0F : 1.0F));
    errors.closeFullLightBatch(batch);
  };
  for (std::uint64_t batch = 1; batch <= 4; ++batch) trace(batch);
  // Of four values 3, 1, 3, 1 the variance is 4/3, and a quarter of it would be that of their mean, relative to
  // 2² (1 + 10⁻⁴) = 4.0004; but pairs agree, so that it falls as n^(-3/2) at least.
  EXPECT_NEAR(errors.relMse("caustic").from_lights, 1.0 / 6.0 / 4.0004, 0.01);
  for (std::uint64_t batch = 5; batch <= 32; ++batch) trace(batch);
  EXPECT_EQ(errors.relMse("caustic").from_lights, 0.0);
}

// Photons are spread evenly in aligned blocks, which a mean over many batches is to know of.
TEST(ErrorEstimate, ClosesBatchesOfPhotonsInBlocksThatGrow) {
  Film film(1, 1, LayerNeeds({"caustic"}));
  ErrorEstimate errors(film, {"caustic"});
  std::vector<std::uint64_t> closed_at;
  std::uint64_t before = 0;
  for (std::uint64_t batch = 1; batch <= 64; ++batch) {
    film.caustic.add(0, vec3(1.0F));
    errors.closeFullLightBatch(batch);
    if (errors.batches() != before) closed_at.push_back(batch);
    before = errors.batches();
  }
  EXPECT_EQ(closed_at,
            (std::vector<std::uint64_t>{1, 2, 3, 4, 5, 6, 7, 8, 10, 12, 14, 16, 20, 24, 28, 32, 40, 48, 56, 64}));
  film.caustic.add(0, vec3(1.0F));
  errors.closeFullLightBatch(65);
  EXPECT_EQ(errors.batches(), before);
  errors.closeLightBatch(65);
  EXPECT_EQ(errors.batches(), before + 1);
}

TEST(ErrorEstimate, ScalesSquaresByWhatIsSeen) {
  Film film(2, 1, LayerNeeds({"direct"}));
  ErrorEstimate errors(film, {"direct"});
  EXPECT_TRUE(errors.relativeScales("direct").empty()) << "nothing is seen yet";
  // Means over both passes and the channels: 2 and 0, and over the picture 1.
  for (std::uint64_t pass = 1; pass <= 2; ++pass) {
    film.direct.add(0, vec3(1.0F, 2.0F, 3.0F));
    errors.closeFullEyeBatches(std::vector<std::uint64_t>{pass}, 1);
  }
  const std::vector<float> scales = errors.relativeScales("direct");
  ASSERT_EQ(scales.size(), 2U);
  EXPECT_FLOAT_EQ(scales[0], 1.0F / (4.0F + 1e-4F));
  EXPECT_FLOAT_EQ(scales[1], 1e4F);
}

TEST(ErrorEstimate, OfOneBatchIsNotKnown) {
  const RenderResult result = renderReference(makeScene(), lookAtBall(), makeSettings(8, 1, 1000, {"direct_error"}));
  EXPECT_EQ(result.image.layers[0].image.pixels[0], std::numeric_limits<float>::infinity());
  EXPECT_TRUE(std::any_of(result.notes.begin(), result.notes.end(),
                          [](const std::string& note) { return note.find("infinite") != std::string::npos; }));
}

/// relMSE of the pixels of `image` (DESIGN §6).
double relMse(const Image& image, const Image& reference) {
  double mean = 0.0, sum = 0.0;
  const auto count = static_cast<double>(reference.pixels.size());
  for (const float value : reference.pixels) mean += value / count;
  for (std::size_t i = 0; i < reference.pixels.size(); ++i) {
    const double r = reference.pixels[i], difference = image.pixels[i] - r;
    sum += difference * difference / (r * r + 1e-4 * mean * mean);
  }
  return sum / count;
}

TEST(TargetError, IsReachedAndIsTheErrorAgainstAConvergedPicture) {
  const std::vector<std::string> layers{"beauty", "caustic"};
  RenderSettings truth = makeSettings(16, 2048, 1 << 21, layers);
  truth.seed = 7;
  const RenderResult converged = renderReference(makeScene(), lookAtBall(), truth);
  RenderSettings settings = makeSettings(16, 0, 1 << 18, layers);
  settings.target_error = 0.02;
  const RenderResult result = renderReference(makeScene(), lookAtBall(), settings);
  double worst = 0.0;
  for (const std::string& layer : layers) {
    const double estimated = std::stod(result.image.metadata.at("estimated_relmse." + layer));
    EXPECT_LE(estimated, settings.target_error) << layer;
    worst = std::max(worst, estimated);
    // 768 values with a few bright ones among them; estimates are up to 1.6 times too high (see above).
    const double measured = relMse(*result.image.find(layer), *converged.image.find(layer));
    EXPECT_LT(measured, 1.5 * estimated) << layer;
    EXPECT_GT(measured, 0.4 * estimated) << layer;
  }
  // It stops as soon as it may: the steps are small against what there is to do.
  EXPECT_GT(worst, 0.7 * settings.target_error);
  EXPECT_LT(result.stats.samples, truth.samples);
}

TEST(TargetError, GivesTheSamePixelsForAnyNumberOfThreads) {
  RenderSettings settings = makeSettings(16, 0, 1 << 18, {"beauty"});
  settings.target_error = 0.1;
  std::vector<RenderResult> results;
  for (const int threads : {1, 3}) {
    settings.threads = threads;
    results.push_back(renderReference(makeScene(), lookAtBall(), settings));
  }
  EXPECT_EQ(results[0].image.layers[0].image.pixels, results[1].image.layers[0].image.pixels);
  EXPECT_EQ(results[0].image.metadata, results[1].image.metadata);
}

TEST(TargetError, EndsWithTheFirstBudgetThatIsSpent) {
  RenderSettings settings = makeSettings(8, 3, 0, {"beauty"});
  settings.target_error = 1e-9;
  EXPECT_EQ(renderReference(makeScene(), lookAtBall(), settings).stats.samples, 3U);
  settings.samples = 0;
  settings.photons = 5000;
  const RenderResult result = renderReference(makeScene(), lookAtBall(), settings);
  EXPECT_GE(result.stats.photons, 5000U);
  EXPECT_LT(result.stats.photons, 5100U);
}

TEST(TargetError, OfWhatIsExactIsRefused) {
  RenderSettings settings = makeSettings(8, 0, 0, {"normal"});
  settings.target_error = 0.1;
  EXPECT_THROW(renderReference(makeScene(), lookAtBall(), settings), UsageError);
}

/// A small lamp over a ball of glass above the floor, and a window: light is brightest under the ball's middle.
SceneData makeLensScene() {
  SceneData scene;
  addObject(scene, test::makeFloor(8.0), makeDiffuse(vec3(0.6F)));
  addObject(scene, makeSphere("ball", dvec3(0, 0.35, 0), 0.2, 128), makeGlass(1.5F));
  addObject(scene, makeBox("window", dvec3(0.5, 0, -2), dvec3(0.55, 1, 2)), makeGlass(1.5F));
  Material lamp = makeDiffuse(vec3(0.0F));
  lamp.emission = vec3(5.0F);
  addObject(scene, makeRectangle("lamp", dvec3(0, 1.2, 0), dvec3(0.2, 0, 0), dvec3(0, 0, 0.2)), lamp);
  return scene;
}

/// The peak under the ball, as a layer that a camera behind the window or before it sees it in.
void expectBiasOfPeak(const std::string& layer, const vec3& eye, float fov) {
  const SceneData scene = makeLensScene();
  const Camera camera = makeCamera("middle", eye, vec3(0), fov);
  const auto meanOf = [&](const RenderSettings& settings, const std::string& name) {
    return test::meanOf(*renderReference(scene, camera, settings).image.find(name)).y;
  };
  RenderSettings paths = makeSettings(8, 16384, 0, {layer});
  paths.params.set("estimator", "path");
  const double truth = meanOf(paths, layer);
  // The ball's way with light is not straight over footprints as large as those of so few photons.
  RenderSettings photons = makeSettings(8, 32, 16 * 2048, {layer, layer + "_bias"});
  // Batches as where errors are estimated.
  photons.layers.push_back(layer + "_error");
  photons.params.set("estimator", "photon-map");
  constexpr int kRenders = 64;
  double bias = 0.0, estimated = 0.0, squares = 0.0;
  for (int seed = 0; seed < kRenders; ++seed) {
    photons.seed = static_cast<std::uint64_t>(seed);
    const RenderResult result = renderReference(scene, camera, photons);
    const double observed = test::meanOf(*result.image.find(layer)).y - truth;
    const double estimate = test::meanOf(*result.image.find(layer + "_bias")).y;
    bias += observed / kRenders, estimated += estimate / kRenders;
    squares += (estimate - observed) * (estimate - observed);
  }
  const double difference = estimated - bias;
  const double standard_error = std::sqrt((squares / kRenders - difference * difference) / (kRenders - 1));
  EXPECT_LT(estimated, 0.0);
  // The next order of the kernel's width, an eighth of the bias at most here, and three standard errors.
  EXPECT_NEAR(estimated, bias, std::abs(bias) / 8.0 + 3.0 * standard_error);
  EXPECT_LT(standard_error, std::abs(bias) / 12.0);
}

TEST(KernelBias, IsWhatKernelsTakeFromAPeakBehindGlass) {
  expectBiasOfPeak("specular_caustic", vec3(0.8F, 0.3F, 0.0F), radians(5));
}
TEST(KernelBias, IsWhatKernelsTakeFromAPeakSeenDirectly) {
  expectBiasOfPeak("caustic", vec3(0.4F, 0.15F, 0.0F), radians(10));
}

}  // namespace
}  // namespace nephroid
