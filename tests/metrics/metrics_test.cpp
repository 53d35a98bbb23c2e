#include "metrics/metrics.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "nephroid/error.h"

namespace nephroid {
namespace {

using ::testing::HasSubstr;

Image makeRow(std::initializer_list<float> values) {
  Image image(static_cast<int>(values.size()), 1, 1);
  image.pixels = values;
  return image;
}

double compute(std::string_view metric, const Image& image, const Image& reference,
               std::span<const std::uint8_t> mask = {}) {
  return findMetric(metric).compute(image, reference, mask, {});
}

TEST(Metrics, AreZeroForEqualPictures) {
  const Image image = makeRow({0.0F, 1.0F, 5.0F});
  for (const Metric& metric : metrics()) EXPECT_EQ(metric.compute(image, image, {}, {}), 0.0) << metric.name;
  const Image black = makeRow({0.0F, 0.0F});
  for (const Metric& metric : metrics()) EXPECT_EQ(metric.compute(black, black, {}, {}), 0.0) << metric.name;
}

TEST(Metrics, FollowTheirFormulas) {
  const Image image = makeRow({1.0F, 4.0F}), reference = makeRow({2.0F, 2.0F});  // mean R = 2, floor 0.02
  EXPECT_DOUBLE_EQ(compute("rmse", image, reference), std::sqrt((1.0 + 4.0) / 2.0));
  EXPECT_DOUBLE_EQ(compute("nrmse", image, reference), std::sqrt(2.5) / 2.0);
  EXPECT_DOUBLE_EQ(compute("relmse", image, reference), 2.5 / (4.0 + 0.0004));
  EXPECT_DOUBLE_EQ(compute("l1", image, reference), 1.5 / 2.0);
  EXPECT_DOUBLE_EQ(compute("mape", image, reference), 1.5 / 2.02);
  EXPECT_DOUBLE_EQ(compute("smape", image, reference), (2.0 / 3.0 + 4.0 / 6.0) / 2.0);
  EXPECT_DOUBLE_EQ(compute("p99", image, reference), 2.0 / 2.02);
}

TEST(Metrics, RelativeOnesDoNotDependOnTheScale) {
  const Image image = makeRow({1.0F, 4.0F, 0.0F}), reference = makeRow({2.0F, 2.0F, 1.0F});
  const Image image_1024 = makeRow({1024.0F, 4096.0F, 0.0F}), reference_1024 = makeRow({2048.0F, 2048.0F, 1024.0F});
  for (const Metric& metric : metrics()) {
    const double factor = metric.name == "rmse" ? 1024.0 : 1.0;
    EXPECT_NEAR(metric.compute(image_1024, reference_1024, {}, {}), factor * metric.compute(image, reference, {}, {}),
                1e-9)
        << metric.name;
  }
}

TEST(Metrics, PercentileIsTheNearestRank) {
  // Errors 0.01 … 1.00 of a reference of 1 everywhere (floor 0.01): the 99th of 100 is 0.99.
  Image image(100, 1, 1), reference(100, 1, 1, 1.0F);
  for (int x = 0; x < 100; ++x) image.at((x * 37) % 100, 0)[0] = 1.0F + static_cast<float>(x + 1) * 0.01F;
  EXPECT_NEAR(compute("p99", image, reference), 0.99 / 1.01, 1e-6);
}

TEST(Metrics, CountPixelsWhoseMaskIs255Only) {
  const Image image = makeRow({1.0F, 9.0F, 9.0F, 3.0F}), reference = makeRow({1.0F, 1.0F, 1.0F, 1.0F});
  const std::vector<std::uint8_t> mask{255, 254, 0, 255};
  EXPECT_DOUBLE_EQ(compute("rmse", image, reference, mask), std::sqrt(2.0));
  // Also the mean of the reference is taken over the mask.
  const Image bright_outside = makeRow({1.0F, 1000.0F, 1000.0F, 1.0F});
  EXPECT_DOUBLE_EQ(compute("l1", image, bright_outside, mask), 1.0);
}

TEST(Metrics, TreatOneChannelAsThree) {
  Image rgb(2, 1, 3, 2.0F);
  const Image grey(2, 1, 1, 1.0F);
  for (const Metric& metric : metrics())
    EXPECT_DOUBLE_EQ(metric.compute(rgb, grey, {}, {}), metric.compute(makeRow({2.0F, 2.0F}), grey, {}, {}))
        << metric.name;
}

TEST(Metrics, AreNotFiniteIfAPixelIsNaN) {
  const Image bad = makeRow({std::numeric_limits<float>::quiet_NaN(), 1.0F}), good = makeRow({1.0F, 1.0F});
  for (const Metric& metric : metrics()) {
    EXPECT_TRUE(std::isnan(metric.compute(bad, good, {}, {}))) << metric.name;
    EXPECT_TRUE(std::isnan(metric.compute(good, bad, {}, {}))) << metric.name;
  }
}

TEST(Metrics, AreInfiniteAgainstABlackReference) {
  const Image image = makeRow({1.0F}), black = makeRow({0.0F});
  for (const char* name : {"nrmse", "relmse", "l1", "mape", "p99"})
    EXPECT_EQ(compute(name, image, black), std::numeric_limits<double>::infinity()) << name;
  EXPECT_EQ(compute("smape", image, black), 2.0);
}

TEST(Metrics, RefuseOtherSizesAndEmptyMasks) {
  const Image two = makeRow({1.0F, 1.0F}), three = makeRow({1.0F, 1.0F, 1.0F});
  const std::vector<std::uint8_t> none{0, 128}, short_mask{255};
  for (const Metric& metric : metrics()) {
    EXPECT_THROW(metric.compute(two, three, {}, {}), InputError) << metric.name;
    EXPECT_THROW(metric.compute(two, two, none, {}), InputError) << metric.name;
    EXPECT_THROW(metric.compute(two, two, short_mask, {}), InputError) << metric.name;
  }
}

TEST(FindMetric, NamesTheNearest) {
  try {
    findMetric("relmes");
    FAIL();
  } catch (const UsageError& error) {
    EXPECT_THAT(error.what(), HasSubstr("unknown metric 'relmes'; did you mean 'relmse'? (known: rmse"));
  }
}

TEST(ExcludeNotFinite, CountsAndLeavesOutPixelsOfEitherPicture) {
  constexpr float kNan = std::numeric_limits<float>::quiet_NaN(), kInf = std::numeric_limits<float>::infinity();
  const Image image = makeRow({kNan, 1.0F, kInf, 1.0F, -kInf, 3.0F}), reference = makeRow({1, kNan, kInf, 1, 1, 1});
  std::vector<std::uint8_t> mask{255, 255, 255, 255, 0, 255};
  const NotFinitePixels found = excludeNotFinite(image, reference, mask);
  EXPECT_EQ(found.in_image, 2U);  // the fifth does not count
  EXPECT_EQ(found.in_reference, 2U);
  EXPECT_EQ(mask, (std::vector<std::uint8_t>{0, 0, 0, 255, 0, 255}));
  for (const Metric& metric : metrics()) EXPECT_TRUE(std::isfinite(metric.compute(image, reference, mask, {})));
  EXPECT_DOUBLE_EQ(compute("rmse", image, reference, mask), std::sqrt(2.0));
}

TEST(ExcludeNotFinite, LooksAtEveryChannel) {
  Image image(3, 1, 3, 1.0F);
  for (int c = 0; c < 2; ++c) image.at(c, 0)[c + 1] = std::numeric_limits<float>::quiet_NaN();
  std::vector<std::uint8_t> mask(3, 255);
  EXPECT_EQ(excludeNotFinite(image, Image(3, 1, 3, 1.0F), mask).in_image, 2U);
  EXPECT_EQ(mask, (std::vector<std::uint8_t>{0, 0, 255}));
}

TEST(ExcludeNotFinite, RefusesPicturesOfWhichNothingRemains) {
  const Image bad = makeRow({std::numeric_limits<float>::quiet_NaN(), 1.0F}), good = makeRow({1.0F, 1.0F});
  std::vector<std::uint8_t> mask{255, 0}, short_mask{255};
  EXPECT_THROW(excludeNotFinite(bad, good, mask), InputError);
  EXPECT_THROW(excludeNotFinite(good, good, short_mask), InputError);
  EXPECT_THROW(excludeNotFinite(good, makeRow({1.0F}), mask), InputError);
}

TEST(MaskedMean, IsPerChannel) {
  Image image(2, 1, 3);
  image.setRgb(0, 0, {1.0F, 2.0F, 3.0F});
  image.setRgb(1, 0, {3.0F, 6.0F, 9.0F});
  EXPECT_EQ(maskedMean(image, {}), dvec3(2.0, 4.0, 6.0));
  const std::vector<std::uint8_t> mask{0, 255}, none{0, 0};
  EXPECT_EQ(maskedMean(image, mask), dvec3(3.0, 6.0, 9.0));
  EXPECT_THROW(maskedMean(image, none), InputError);
}

LayeredImage makeLayers() {
  LayeredImage image;
  image.width = 2, image.height = 1;
  image.layers = {{"direct", Image(2, 1, 3, 1.0F)}, {"caustic", Image(2, 1, 3, 0.5F)}, {"depth", Image(2, 1, 1, 4.0F)}};
  return image;
}

TEST(EvaluateLayerExpression, ReturnsALayerOrASum) {
  EXPECT_EQ(evaluateLayerExpression(makeLayers(), "caustic").pixels, std::vector<float>(6, 0.5F));
  EXPECT_EQ(evaluateLayerExpression(makeLayers(), "direct+caustic").pixels, std::vector<float>(6, 1.5F));
  EXPECT_EQ(evaluateLayerExpression(makeLayers(), " direct + caustic ").pixels, std::vector<float>(6, 1.5F));
  EXPECT_EQ(evaluateLayerExpression(makeLayers(), "depth").channels, 1);
  EXPECT_EQ(evaluateLayerExpression(makeLayers(), "depth+direct").pixels, std::vector<float>(6, 5.0F));
}

TEST(EvaluateLayerExpression, NamesTheMissingLayer) {
  for (const char* expression : {"causic", "direct+causic"}) {
    try {
      evaluateLayerExpression(makeLayers(), expression);
      FAIL();
    } catch (const InputError& error) {
      EXPECT_THAT(error.what(),
                  HasSubstr("layer 'causic' is not in the image; did you mean 'caustic'? (it has: direct"));
    }
  }
  EXPECT_THROW(evaluateLayerExpression(makeLayers(), ""), InputError);
  EXPECT_THROW(evaluateLayerExpression(makeLayers(), "direct+"), InputError);
}

}  // namespace
}  // namespace nephroid
