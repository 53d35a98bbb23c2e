#include "core/image/tonemap.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

namespace nephroid {
namespace {

Image makeGrey(int width, int height, float value) { return {width, height, 3, value}; }

TEST(Srgb, TransferFunctionsInvertEachOther) {
  for (int i = 0; i <= 1000; ++i) {
    const float linear = static_cast<float>(i) / 1000.0F;
    EXPECT_NEAR(linearFromSrgb(srgbFromLinear(linear)), linear, 2e-6F);
  }
}

TEST(Srgb, TransferFunctionHasTheValuesOfTheStandard) {
  EXPECT_EQ(srgbFromLinear(0.0F), 0.0F);
  EXPECT_NEAR(srgbFromLinear(1.0F), 1.0F, 1e-6F);
  EXPECT_NEAR(srgbFromLinear(0.0031308F), 0.04045F, 1e-5F);
  EXPECT_NEAR(linearFromSrgb(0.5F), 0.2140411F, 1e-6F);
}

TEST(AutoExposure, PutsAGreyPictureAtMiddleGrey) {
  for (const float grey : {1e-6F, 0.18F, 3.0F, 1e5F})
    EXPECT_NEAR(grey * std::exp2(computeAutoExposure(makeGrey(8, 8, grey))), 0.18F, 1e-4F) << grey;
}

TEST(AutoExposure, UsesTheGeometricMeanOfWhatIsNotBlack) {
  Image image = makeGrey(2, 2, 0.0F);
  image.setRgb(0, 0, vec3(0.1F));
  image.setRgb(1, 0, vec3(0.4F));  // geometric mean 0.2
  EXPECT_NEAR(computeAutoExposure(image), std::log2(0.18F / 0.2F), 1e-4F);
}

TEST(AutoExposure, IgnoresPixelsThatAreAsGoodAsBlack) {
  Image image = makeGrey(10, 10, 1.0F);
  image.setRgb(0, 0, vec3(1e-30F));
  EXPECT_NEAR(computeAutoExposure(image), std::log2(0.18F), 1e-4F);
}

TEST(AutoExposure, KeepsTheHighlightsOfACaustic) {
  Image image = makeGrey(100, 100, 0.01F);
  for (int y = 0; y < 5; ++y)
    for (int x = 0; x < 100; ++x) image.setRgb(x, y, vec3(10.0F));  // 5 %: above the 99th percentile
  EXPECT_NEAR(10.0F * std::exp2(computeAutoExposure(image)), 4.0F, 1e-4F);
}

TEST(AutoExposure, IsZeroForBlackAndBlindToWhatIsNotFinite) {
  EXPECT_EQ(computeAutoExposure(makeGrey(4, 4, 0.0F)), 0.0F);
  EXPECT_EQ(computeAutoExposure(Image()), 0.0F);
  Image image = makeGrey(4, 4, 0.18F);
  image.setRgb(0, 0, vec3(std::numeric_limits<float>::quiet_NaN()));
  image.setRgb(1, 0, vec3(kInfinity));
  image.setRgb(2, 0, vec3(-5.0F));
  EXPECT_NEAR(computeAutoExposure(image), 0.0F, 1e-4F);
}

TEST(ToDisplay, ScalesByPowersOfTwoAndClamps) {
  Image image = makeGrey(1, 1, 0.0F);
  image.setRgb(0, 0, vec3(0.05F, 1.0F, -0.1F));
  const vec3 display = toDisplay(image, 2.0F, ToneMap::kClamp).rgb(0, 0);
  EXPECT_NEAR(display.x, srgbFromLinear(0.2F), 1e-6F);
  EXPECT_NEAR(display.y, 1.0F, 1e-6F);
  EXPECT_EQ(display.z, 0.0F);
}

TEST(ToDisplay, SpreadsOneChannelOverThree) {
  const Image display = toDisplay(Image(3, 2, 1, 0.5F), 0.0F, ToneMap::kClamp);
  EXPECT_EQ(display.channels, 3);
  EXPECT_EQ(display.rgb(2, 1), vec3(srgbFromLinear(0.5F)));
}

TEST(ToDisplay, FilmicCurveKeepsMiddleGrey) {
  EXPECT_NEAR(toDisplay(makeGrey(1, 1, 0.18F), 0.0F, ToneMap::kFilmic).pixels[0], srgbFromLinear(0.18F), 1e-4F);
}

TEST(ToDisplay, FilmicCurveRisesFromBlackToWhite) {
  Image ramp(1000, 1, 3);
  for (int x = 0; x < 1000; ++x) ramp.setRgb(x, 0, vec3(static_cast<float>(x) * 0.02F));
  const Image display = toDisplay(ramp, 0.0F, ToneMap::kFilmic);
  EXPECT_EQ(display.pixels.front(), 0.0F);
  EXPECT_NEAR(display.pixels.back(), 1.0F, 1e-6F);
  EXPECT_TRUE(std::ranges::is_sorted(display.pixels));
}

TEST(ToDisplay, IsAlwaysInTheUnitInterval) {
  Image image(6, 1, 3);
  const float values[] = {std::numeric_limits<float>::quiet_NaN(), kInfinity, -kInfinity, 3e38F, -0.0F, 1e-40F};
  for (int x = 0; x < 6; ++x) image.setRgb(x, 0, vec3(values[x]));
  for (const ToneMap tone_map : {ToneMap::kClamp, ToneMap::kFilmic})
    for (const float ev : {-200.0F, 0.0F, 200.0F})
      for (const float v : toDisplay(image, ev, tone_map).pixels) {
        EXPECT_GE(v, 0.0F);
        EXPECT_LE(v, 1.0F + 1e-6F);
      }
}

}  // namespace
}  // namespace nephroid
