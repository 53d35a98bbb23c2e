// FLIP against its plain form and against colours whose error follows by hand.
#include "metrics/flip.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <functional>
#include <limits>
#include <numbers>
#include <random>

#include "core/image/tonemap.h"
#include "core/parallel.h"
#include "metrics/metrics.h"
#include "metrics/perceived_colour.h"
#include "nephroid/error.h"

namespace nephroid {
namespace {

constexpr Viewing kShown{.display_referred = true};

Image makeConstant(int width, int height, vec3 rgb) {
  Image image(width, height, 3);
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x) image.setRgb(x, y, rgb);
  return image;
}

/// Anything: patches of colour, noise on them.
Image makeRandom(int width, int height, std::uint32_t seed) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<float> uniform(0.0F, 1.0F);
  const vec3 low(uniform(random), uniform(random), uniform(random));
  const vec3 high(uniform(random), uniform(random), uniform(random));
  Image image(width, height, 3);
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x)
      image.setRgb(x, y, mix(low, high, (x / 5 + y / 7) % 2 == 0 ? 0.1F : uniform(random)));
  return image;
}

double meanFlip(const Image& image, const Image& reference, const Viewing& viewing = kShown) {
  return computeFlip(image, reference, {}, viewing);
}

// --- The plain form: the paper's filters as whole squares, everything in double precision. ---

dvec3 plainXyz(dvec3 rgb) {
  // From the chromaticities of Rec. 709 and its white: the columns are the primaries, scaled to sum to the white.
  const auto xyz = [](double x, double y) { return dvec3(x / y, 1.0, (1.0 - x - y) / y); };
  const glm::dmat3 primaries(xyz(0.64, 0.33), xyz(0.30, 0.60), xyz(0.15, 0.06));
  const dvec3 white = xyz(0.3127, 0.3290);
  const dvec3 scale = inverse(primaries) * white;
  return primaries * (scale * rgb) / white;
}

dvec3 plainOpponent(dvec3 rgb) {
  const dvec3 xyz = plainXyz(rgb);
  return {116.0 * xyz.y - 16.0, 500.0 * (xyz.x - xyz.y), 200.0 * (xyz.y - xyz.z)};
}

dvec3 plainHuntLab(dvec3 rgb) {
  const dvec3 xyz = plainXyz(rgb);
  dvec3 f;
  for (int c = 0; c < 3; ++c)
    f[c] = xyz[c] > 216.0 / 24389.0 ? std::cbrt(xyz[c]) : (24389.0 / 27.0 * xyz[c] + 16.0) / 116.0;
  const double lightness = 116.0 * f.y - 16.0;
  return {lightness, lightness / 100.0 * 500.0 * (f.x - f.y), lightness / 100.0 * 200.0 * (f.y - f.z)};
}

double plainHyab(dvec3 rgb_a, dvec3 rgb_b) {
  const dvec3 d = plainHuntLab(rgb_a) - plainHuntLab(rgb_b);
  return std::abs(d.x) + std::hypot(d.y, d.z);
}

double plainColourError(dvec3 rgb_a, dvec3 rgb_b) {
  const double largest = std::pow(plainHyab({0, 1, 0}, {0, 0, 1}), 0.7);
  const double distance = std::pow(plainHyab(rgb_a, rgb_b), 0.7);
  if (distance < 0.4 * largest) return 0.95 / (0.4 * largest) * distance;
  return 0.95 + (distance - 0.4 * largest) / (0.6 * largest) * 0.05;
}

using PlainKernel = std::vector<std::vector<double>>;  ///< [row][column], of odd sides

PlainKernel makePlainKernel(int radius, const std::function<double(int, int)>& weight) {
  PlainKernel kernel;
  for (int y = -radius; y <= radius; ++y) {
    kernel.emplace_back();
    for (int x = -radius; x <= radius; ++x) kernel.back().push_back(weight(x, y));
  }
  return kernel;
}

/// Positive weights to a sum of 1, negative ones to −1.
PlainKernel normalise(PlainKernel kernel) {
  double positive = 0.0, negative = 0.0;
  for (const auto& row : kernel)
    for (const double weight : row) (weight > 0.0 ? positive : negative) += weight;
  for (auto& row : kernel)
    for (double& weight : row) weight /= weight > 0.0 ? positive : -negative;
  return kernel;
}

PlainKernel makeSensitivityKernel(double ppd, double a1, double b1, double a2, double b2) {
  const int radius = static_cast<int>(std::ceil(3.0 * std::sqrt(0.04 / (2.0 * std::pow(std::numbers::pi, 2))) * ppd));
  return normalise(makePlainKernel(radius, [=](int x, int y) {
    const double squared = (x * x + y * y) / (ppd * ppd);
    const auto term = [&](double a, double b) {
      return a * std::sqrt(std::numbers::pi / b) * std::exp(-std::pow(std::numbers::pi, 2) * squared / b);
    };
    return term(a1, b1) + term(a2, b2);
  }));
}

dvec3 plainFilter(const Image& image, int x, int y, const std::array<const PlainKernel*, 3>& kernels) {
  dvec3 sum(0.0);
  for (int c = 0; c < 3; ++c) {
    const int radius = static_cast<int>(kernels[static_cast<std::size_t>(c)]->size()) / 2;
    for (int dy = -radius; dy <= radius; ++dy)
      for (int dx = -radius; dx <= radius; ++dx) {
        const vec3 rgb = image.rgb(std::clamp(x + dx, 0, image.width - 1), std::clamp(y + dy, 0, image.height - 1));
        sum[c] += (*kernels[static_cast<std::size_t>(c)])[static_cast<std::size_t>(dy + radius)]
                                                         [static_cast<std::size_t>(dx + radius)] *
                  plainOpponent(rgb)[c];
      }
  }
  return sum;
}

dvec3 plainRgb(dvec3 opponent) {
  const double y = (opponent.x + 16.0) / 116.0;
  const glm::dmat3 to_xyz(plainXyz({1, 0, 0}), plainXyz({0, 1, 0}), plainXyz({0, 0, 1}));
  return clamp(inverse(to_xyz) * dvec3(y + opponent.y / 500.0, y, y - opponent.z / 200.0), dvec3(0.0), dvec3(1.0));
}

/// LDR-FLIP of one pixel.
double plainFlip(const Image& image, const Image& reference, int x, int y, double ppd) {
  const PlainKernel luminance = makeSensitivityKernel(ppd, 1.0, 0.0047, 0.0, 1e-5);
  const PlainKernel red_green = makeSensitivityKernel(ppd, 1.0, 0.0053, 0.0, 1e-5);
  const PlainKernel blue_yellow = makeSensitivityKernel(ppd, 34.1, 0.04, 13.5, 0.025);
  const std::array colour_kernels{&luminance, &red_green, &blue_yellow};
  const double colour = plainColourError(plainRgb(plainFilter(image, x, y, colour_kernels)),
                                         plainRgb(plainFilter(reference, x, y, colour_kernels)));

  const double sigma = 0.5 * 0.082 * ppd;
  const int radius = static_cast<int>(std::ceil(3.0 * sigma));
  const auto gaussian = [=](int u, int v) { return std::exp(-(u * u + v * v) / (2.0 * sigma * sigma)); };
  const auto edge = [=](int along, int u, int v) { return -along * gaussian(u, v); };
  const auto point = [=](int along, int u, int v) { return (along * along / (sigma * sigma) - 1.0) * gaussian(u, v); };
  const auto measure = [&](const Image& picture, const auto& detector) {
    const auto detect = [&](const std::function<double(int, int)>& weight) {
      const PlainKernel kernel = normalise(makePlainKernel(radius, weight));
      return plainFilter(picture, x, y, {&kernel, &kernel, &kernel}).x / 116.0;
    };
    return std::hypot(detect([&](int u, int v) { return detector(u, u, v); }),
                      detect([&](int u, int v) { return detector(v, u, v); }));
  };
  const double edges = std::abs(measure(image, edge) - measure(reference, edge));
  const double points = std::abs(measure(image, point) - measure(reference, point));
  return std::pow(colour, 1.0 - std::sqrt(std::max(edges, points) / std::numbers::sqrt2));
}

// Single precision and filters cut where weights fall below 1e-9 are all that they differ by.
TEST(Flip, IsThePlainFormPixelByPixel) {
  for (const float ppd : {67.0F, 25.0F, 10.0F}) {
    const Image image = makeRandom(37, 61, 1), reference = makeRandom(37, 61, 2);
    const Image map = computeFlipMap(image, reference, {.display_referred = true, .pixels_per_degree = ppd});
    for (const auto& [x, y] : {std::pair{0, 0}, {36, 60}, {17, 30}, {5, 47}, {20, 48}})  // corners, inside, bands' seam
      EXPECT_NEAR(*map.at(x, y), plainFlip(image, reference, x, y, double{ppd}), 2e-4) << x << ' ' << y << ' ' << ppd;
  }
}

// Filters leave constant pictures as they are, and such have no features: FLIP is the colours' error alone.
TEST(Flip, OfConstantColoursIsTheirMappedDistance) {
  const std::array<vec3, 6> colours{vec3(0), vec3(1), vec3(0.2F), vec3(1, 0, 0), vec3(0.1F, 0.5F, 0.3F), vec3(0, 0, 1)};
  for (const vec3& a : colours)
    for (const vec3& b : colours)
      EXPECT_NEAR(meanFlip(makeConstant(9, 5, a), makeConstant(9, 5, b)), plainColourError(a, b), 1e-5);
}

// L* is 0 and 100: HyAB = 100. Green and blue, the largest distance, are 203.33 apart:
// green L*a*b* = (87.7347, −86.1827, 83.1793), blue (32.2970, 79.1875, −107.8602), each a*, b* times L*/100.
TEST(Flip, OfBlackAndWhiteIsKnown) {
  const double largest = std::pow(203.33, 0.7), knee = 0.4 * largest;
  const double expected = 0.95 + 0.05 * (std::pow(100.0, 0.7) - knee) / (largest - knee);
  EXPECT_NEAR(expected, 0.9674, 1e-4);
  EXPECT_NEAR(meanFlip(makeConstant(8, 8, vec3(1)), makeConstant(8, 8, vec3(0))), expected, 1e-5);
}

TEST(Flip, OfGreenAndBlueIsOneAndNothingIsMore) {
  EXPECT_FLOAT_EQ(static_cast<float>(meanFlip(makeConstant(3, 3, {0, 1, 0}), makeConstant(3, 3, {0, 0, 1}))), 1.0F);
  for (std::uint32_t seed = 0; seed < 8; ++seed)
    for (const Viewing& viewing : {kShown, Viewing{}}) {
      const Image map = computeFlipMap(makeRandom(31, 33, seed), makeRandom(31, 33, seed + 100), viewing);
      EXPECT_THAT(map.pixels, ::testing::Each(::testing::AllOf(::testing::Ge(0.0F), ::testing::Le(1.0F))));
    }
}

TEST(Flip, IsZeroForEqualPicturesOfAnySize) {
  for (const auto& [width, height] : {std::pair{1, 1}, {1, 97}, {97, 1}, {33, 49}})
    for (const Viewing& viewing : {kShown, Viewing{}}) {
      const Image image = makeRandom(width, height, 7);
      EXPECT_EQ(meanFlip(image, image, viewing), 0.0);
    }
}

TEST(Flip, OfOnePixelIsThatOfItsColour) {
  EXPECT_NEAR(meanFlip(makeConstant(1, 1, {0.9F, 0.2F, 0.1F}), makeConstant(1, 1, vec3(0.3F))),
              plainColourError({0.9F, 0.2F, 0.1F}, dvec3(0.3F)), 1e-5);
}

TEST(Flip, IsSymmetricForPicturesOnAScreen) {
  const Image a = makeRandom(40, 30, 3), b = makeRandom(40, 30, 4);
  EXPECT_EQ(computeFlipMap(a, b, kShown).pixels, computeFlipMap(b, a, kShown).pixels);
}

TEST(Flip, OfMirroredPicturesIsMirrored) {
  const auto flip = [](const Image& image) {
    Image mirrored(image.height, image.width, image.channels);  // in the diagonal
    for (int y = 0; y < image.height; ++y)
      for (int x = 0; x < image.width; ++x)
        for (int c = 0; c < image.channels; ++c) mirrored.at(y, x)[c] = image.at(x, y)[c];
    return mirrored;
  };
  const Image a = makeRandom(40, 60, 5), b = makeRandom(40, 60, 6);
  const Image map = flip(computeFlipMap(flip(a), flip(b), kShown)), expected = computeFlipMap(a, b, kShown);
  for (std::size_t i = 0; i < map.pixels.size(); ++i) ASSERT_NEAR(map.pixels[i], expected.pixels[i], 1e-5);
}

TEST(Flip, GrowsWithTheDifference) {
  const Image reference = makeConstant(21, 21, vec3(0.25F));
  double previous = 0.0;
  for (const float brighter : {0.26F, 0.3F, 0.4F, 0.6F, 1.0F}) {
    Image image = reference;
    for (int x = 0; x < 10; ++x)
      for (int y = 0; y < 21; ++y) image.setRgb(x, y, vec3(brighter));
    const double error = meanFlip(image, reference);
    EXPECT_GT(error, previous) << brighter;
    previous = error;
  }
}

/// White on black: a line one pixel wide, or a single pixel.
Image drawLine(int side, int first_row, int last_row) {
  Image image = makeConstant(side, side, vec3(0));
  for (int y = first_row; y <= last_row; ++y) image.setRgb(side / 2, y, vec3(1));
  return image;
}

// A thin line differs little in colour once the eye has smoothed it; that one picture has a feature there which the
// other has not is what raises the error. Far away nothing is to be seen.
TEST(Flip, SeesALineAndAPointOfOnePixel) {
  constexpr int kSide = 65, kMiddle = 32;
  const Image black = makeConstant(kSide, kSide, vec3(0));
  for (const auto& [first, last] : {std::pair{0, kSide - 1}, {kMiddle, kMiddle}}) {
    const Image line = drawLine(kSide, first, last);
    const Image map = computeFlipMap(line, black, kShown);
    EXPECT_NEAR(*map.at(kMiddle, kMiddle), plainFlip(line, black, kMiddle, kMiddle, 67.0), 2e-4);
    EXPECT_GT(*map.at(kMiddle, kMiddle), 0.5F);
    EXPECT_EQ(*map.at(0, kMiddle), 0.0F);
  }
}

TEST(Flip, FallsWithTheDistanceOfTheScreen) {
  const Image line = drawLine(65, 0, 64), black = makeConstant(65, 65, vec3(0));
  const auto atMiddle = [&](float ppd) {
    return *computeFlipMap(line, black, {.display_referred = true, .pixels_per_degree = ppd}).at(32, 32);
  };
  EXPECT_GT(atMiddle(20.0F), atMiddle(67.0F));
  EXPECT_GT(atMiddle(67.0F), atMiddle(200.0F));
}

TEST(Flip, ClipsWhatAScreenCannotShow) {
  EXPECT_EQ(meanFlip(makeConstant(4, 4, vec3(5.0F)), makeConstant(4, 4, vec3(1.0F))), 0.0);
  EXPECT_EQ(meanFlip(makeConstant(4, 4, vec3(-5.0F)), makeConstant(4, 4, vec3(0.0F))), 0.0);
}

TEST(Flip, IsTheSameForAnyNumberOfThreads) {
  const Image a = makeRandom(50, 200, 8), b = makeRandom(50, 200, 9);
  std::vector<std::vector<float>> maps;
  for (const int threads : {1, 2, 5}) runWithThreads(threads, [&] { maps.push_back(computeFlipMap(a, b, {}).pixels); });
  EXPECT_EQ(maps[0], maps[1]);
  EXPECT_EQ(maps[0], maps[2]);
}

TEST(Flip, TakesPixelsThatAreNotFiniteForNothing) {
  Image bad = makeRandom(30, 30, 1);
  const Image reference = bad;
  bad.at(10, 10)[1] = std::numeric_limits<float>::quiet_NaN();
  bad.at(20, 20)[0] = kInfinity;
  for (const Viewing& viewing : {kShown, Viewing{}}) {
    const Image map = computeFlipMap(bad, reference, viewing);
    for (int y = 0; y < 30; ++y)
      for (int x = 0; x < 30; ++x) {
        const bool unknown = (x == 10 && y == 10) || (x == 20 && y == 20);
        // Nothing of them is in the pixels about them.
        EXPECT_EQ(std::isnan(*map.at(x, y)), unknown);
        if (!unknown) {
          EXPECT_EQ(*map.at(x, y), 0.0F);
        }
      }
  }
}

TEST(Flip, IsTheMeanOfItsMapOverTheMask) {
  const Image a = makeRandom(20, 10, 1), b = makeRandom(20, 10, 2);
  const Image map = computeFlipMap(a, b, {});
  std::vector<std::uint8_t> mask(200, 0);
  mask[5] = mask[150] = 255;
  EXPECT_DOUBLE_EQ(computeFlip(a, b, mask, {}), (double{map.pixels[5]} + double{map.pixels[150]}) / 2.0);
}

TEST(Flip, RefusesDistancesThatItsFiltersCannotShow) {
  const Image image = makeConstant(2, 2, vec3(0));
  for (const float ppd : {9.0F, 1001.0F, std::numeric_limits<float>::quiet_NaN()})
    EXPECT_THROW(computeFlipMap(image, image, {.pixels_per_degree = ppd}), UsageError) << ppd;
}

// --- HDR-FLIP ---

/// Grey pixels in a row.
Image makeRow(const std::vector<float>& values) {
  Image image(static_cast<int>(values.size()), 1, 1);
  image.pixels = values;
  return image;
}

TEST(FlipExposures, BringTheBrightestAndTheMedianToTheSameBrightness) {
  const Image reference = makeRow({16.0F, 1.0F, 1.0F, 0.5F, 0.25F});
  const std::vector<double> exposures = computeFlipExposures(reference, reference);
  ASSERT_EQ(exposures.size(), 4U);  // log2(16/1) stops
  EXPECT_NEAR(applyFilmicCurve(static_cast<float>(16.0 * exposures.front())), 0.85F, 1e-5F);
  EXPECT_NEAR(applyFilmicCurve(static_cast<float>(exposures.back())), 0.85F, 1e-5F);
  EXPECT_NEAR(exposures[1] / exposures[0], std::exp2(4.0 / 3.0), 1e-12);
  EXPECT_NEAR(exposures[2] / exposures[1], std::exp2(4.0 / 3.0), 1e-12);
}

TEST(FlipExposures, AreTwoAtLeast) {
  EXPECT_EQ(computeFlipExposures(makeRow({3.0F}), makeRow({3.0F})).size(), 2U);
  EXPECT_EQ(computeFlipExposures({}, makeRow({2.0F, 1.0F, 1.0F})).size(), 2U);
}

TEST(FlipExposures, TakeTheMeanOfTheTwoInTheMiddle) {
  const std::vector<double> exposures = computeFlipExposures({}, makeRow({8.0F, 3.0F, 1.0F, 0.5F}));
  EXPECT_NEAR(exposures.back() / exposures.front(), 8.0 / 2.0, 1e-12);
}

TEST(FlipExposures, LeaveBlackOutWhereItIsMoreThanHalf) {
  const std::vector<double> exposures = computeFlipExposures({}, makeRow({0, 8.0F, 1e-9F, 4.0F, 0, 0, 2.0F, -1.0F}));
  EXPECT_NEAR(exposures.back() / exposures.front(), 8.0 / 4.0, 1e-12);
}

TEST(FlipExposures, AreThoseOfThePictureIfTheReferenceIsBlack) {
  const Image black = makeRow({0.0F, 0.0F, 0.0F}), image = makeRow({4.0F, 1.0F, 0.5F});
  EXPECT_EQ(computeFlipExposures(image, black), computeFlipExposures(black, image));
  EXPECT_EQ(computeFlipExposures(black, black).size(), 1U);
  EXPECT_EQ(meanFlip(black, black, {}), 0.0);
  EXPECT_GT(meanFlip(image, black, {}), 0.5);
}

TEST(HdrFlip, IsTheLargestOverTheExposures) {
  Image reference = makeRandom(30, 20, 1), image = makeRandom(30, 20, 2);
  for (int i = 0; i < 30; ++i) reference.at(i, 3)[0] *= 50.0F;
  std::vector<float> largest(600, 0.0F);
  for (const double exposure : computeFlipExposures(image, reference)) {
    const auto show = [exposure](Image picture) {
      for (float& value : picture.pixels) value = applyFilmicCurve(static_cast<float>(exposure * double{value}));
      return picture;
    };
    const Image map = computeFlipMap(show(image), show(reference), kShown);
    for (std::size_t i = 0; i < 600; ++i) largest[i] = std::max(largest[i], map.pixels[i]);
  }
  EXPECT_EQ(computeFlipMap(image, reference, {}).pixels, largest);
}

TEST(HdrFlip, DoesNotDependOnTheUnit) {
  const Image image = makeRandom(30, 20, 1), reference = makeRandom(30, 20, 2);
  for (const float scale : {1e-6F, 3.0F, 1e7F}) {
    Image scaled_image = image, scaled_reference = reference;
    for (float& value : scaled_image.pixels) value *= scale;
    for (float& value : scaled_reference.pixels) value *= scale;
    EXPECT_NEAR(meanFlip(scaled_image, scaled_reference, {}), meanFlip(image, reference, {}), 1e-4) << scale;
  }
}

// On a screen both corners would be white.
TEST(HdrFlip, SeesDifferencesInWhatIsTooBrightForAScreen) {
  Image reference = makeConstant(40, 40, vec3(0.2F)), image = reference;
  for (int y = 0; y < 20; ++y)
    for (int x = 0; x < 20; ++x) reference.setRgb(x, y, vec3(100.0F)), image.setRgb(x, y, vec3(10.0F));
  EXPECT_EQ(meanFlip(image, reference, kShown), 0.0);
  EXPECT_GT(*computeFlipMap(image, reference, {}).at(8, 8), 0.5F);
}

TEST(HdrFlip, TakesNegativeLightForNone) {
  const Image reference = makeRow({4.0F, 1.0F, -2.0F, 1.0F}), image = makeRow({4.0F, 1.0F, 0.0F, 1.0F});
  EXPECT_EQ(meanFlip(image, reference, {}), 0.0);
}

}  // namespace
}  // namespace nephroid
