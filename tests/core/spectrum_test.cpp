#include "core/spectrum.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "core/sampling/chi_squared.h"

namespace nephroid {
namespace {

TEST(ColourMatching, PeaksWhereTheStandardObserverDoes) {
  // CIE 1931 2° tables: ȳ(555) = 1.0000, x̄(600) = 1.0622, z̄(445) = 1.7826, ȳ(480) = 0.13902, x̄(505) = 0.0024.
  // The fit errs by up to 2 % of the peak (Wyman, Sloan and Shirley 2013, fig. 2).
  EXPECT_NEAR(colourMatching(555).y, 1.0, 0.02);
  EXPECT_NEAR(colourMatching(600).x, 1.0622, 0.02);
  EXPECT_NEAR(colourMatching(445).z, 1.7826, 0.035);
  EXPECT_NEAR(colourMatching(480).y, 0.13902, 0.02);
  EXPECT_NEAR(colourMatching(505).x, 0.0024, 0.02);
}

TEST(WavelengthRgb, HasMeanOneOverTheRange) {
  // The table is linear between whole nanometres, so midpoints of tenths integrate it exactly.
  dvec3 sum(0);
  for (int i = 0; i < 3400; ++i) sum += dvec3(wavelengthRgb(kWavelengthMin_nm + (static_cast<float>(i) + 0.5F) * 0.1F));
  for (int c = 0; c < 3; ++c) EXPECT_NEAR(sum[c] / 3400, 1.0, 1e-5);
}

TEST(WavelengthRgb, HasTheHueOfTheWavelength) {
  const vec3 blue = wavelengthRgb(450), green = wavelengthRgb(530), red = wavelengthRgb(620);
  EXPECT_GT(blue.z, std::max(blue.x, blue.y));
  EXPECT_GT(green.y, std::max(green.x, green.z));
  EXPECT_GT(red.x, std::max(red.y, red.z));
  EXPECT_LT(wavelengthRgb(500).x, 0.0F) << "cyan lies outside Rec. 709";
}

TEST(WavelengthRgb, IsZeroOutsideTheRange) {
  EXPECT_EQ(wavelengthRgb(379.9F), vec3(0));
  EXPECT_EQ(wavelengthRgb(720.1F), vec3(0));
}

TEST(Bands, SumToWhite) {
  for (const int count : {1, 2, 3, 5, 8, 31, 64}) {
    const auto bands = makeBands(count);
    ASSERT_EQ(bands.size(), static_cast<std::size_t>(count));
    vec3 sum(0);
    for (const Band& band : bands) sum += band.weight;
    for (int c = 0; c < 3; ++c) EXPECT_NEAR(sum[c], 1.0F, 1e-6F) << count;
  }
}

TEST(Bands, OneBandIsTheDLine) {
  EXPECT_EQ(makeBands(1)[0].wavelength_nm, kWavelengthD_nm);
  EXPECT_EQ(makeBands(1)[0].weight, vec3(1));
}

TEST(Bands, AreInOrderAndInsideTheRange) {
  const auto bands = makeBands(16);
  EXPECT_GT(bands.front().wavelength_nm, kWavelengthMin_nm);
  EXPECT_LT(bands.back().wavelength_nm, kWavelengthMax_nm);
  for (std::size_t i = 1; i < bands.size(); ++i) EXPECT_LT(bands[i - 1].wavelength_nm, bands[i].wavelength_nm);
}

TEST(Bands, EachIsTheIntegralOfItsWavelengths) {
  // 700 bands end within the nanometre cells of the table. Simpson's rule is exact where a band lies inside one.
  const int count = 700;
  const auto bands = makeBands(count);
  const auto edge = [](int i) { return sampleWavelength(static_cast<float>(i) / count).wavelength_nm; };
  int inside_one_cell = 0;
  for (int i = 0; i + 1 < count; ++i) {
    const float lower = edge(i), upper = edge(i + 1);
    if (std::floor(lower) != std::floor(upper)) continue;
    ++inside_one_cell;
    const vec3 mean =
        (wavelengthRgb(lower) + 4.0F * wavelengthRgb(0.5F * (lower + upper)) + wavelengthRgb(upper)) / 6.0F;
    const vec3 expected = mean * (upper - lower) / (kWavelengthMax_nm - kWavelengthMin_nm);
    // An ulp of a wavelength is 6e-5 nm and a band about 0.3 nm wide.
    EXPECT_LT(length(bands[static_cast<std::size_t>(i)].weight - expected), 5e-4F * length(expected)) << i;
  }
  EXPECT_GT(inside_one_cell, 200);
}

TEST(Bands, ConvergeToTheSpectrum) {
  // The last band takes a remainder: it must still be the integral of its own wavelengths, so Σ w·f(λ) converges to the
  // mean of wavelengthRgb·f. f is 1/λ², as in Cauchy's formula.
  const auto f = [](float nm) { return 1e5 / (double{nm} * nm); };
  dvec3 exact(0), sum(0);
  for (int i = 0; i < 3400; ++i) {
    const float nm = kWavelengthMin_nm + (static_cast<float>(i) + 0.5F) * 0.1F;
    exact += dvec3(wavelengthRgb(nm)) * f(nm) / 3400.0;
  }
  for (const Band& band : makeBands(64)) sum += dvec3(band.weight) * f(band.wavelength_nm);
  for (int c = 0; c < 3; ++c) EXPECT_NEAR(sum[c] / exact[c], 1.0, 1e-3);
}

TEST(SampleWavelength, HasExpectationWhite) {
  dvec3 sum(0);
  const int n = 1 << 16;
  for (int i = 0; i < n; ++i) sum += dvec3(sampleWavelength((static_cast<float>(i) + 0.5F) / n).weight) / double{n};
  for (int c = 0; c < 3; ++c) EXPECT_NEAR(sum[c], 1.0, 1e-4);
}

TEST(SampleWavelength, WeightIsTheSpectrumOverTheDensity) {
  for (const float u : {0.001F, 0.2F, 0.5F, 0.77F, 0.9999F}) {
    const Band band = sampleWavelength(u);
    const vec3 expected = wavelengthRgb(band.wavelength_nm) /
                          (pdfWavelength(band.wavelength_nm) * (kWavelengthMax_nm - kWavelengthMin_nm));
    for (int c = 0; c < 3; ++c) EXPECT_NEAR(band.weight[c], expected[c], 2e-4F) << u;
  }
}

TEST(SampleWavelength, WeightsAreBounded) {
  // |r| + |g| + |b| over its mean is the density, so the sum of the weights is that mean (4.1), but for the 1 nm cells.
  for (int i = 0; i < 1000; ++i) {
    const vec3 w = glm::abs(sampleWavelength((static_cast<float>(i) + 0.5F) / 1000).weight);
    EXPECT_LT(w.x + w.y + w.z, 5.0F);
  }
}

TEST(SampleWavelength, FollowsItsDensity) {
  std::mt19937 generator(2);
  std::uniform_real_distribution<float> uniform(0.0F, kOneMinusEpsilon);
  std::vector<double> observed(85, 0.0), expected(85, 0.0);
  for (int i = 0; i < 100000; ++i)
    observed[static_cast<std::size_t>((sampleWavelength(uniform(generator)).wavelength_nm - kWavelengthMin_nm) / 4)] +=
        1;
  double integral = 0;
  for (std::size_t i = 0; i < 340; ++i) {
    const double share = pdfWavelength(kWavelengthMin_nm + static_cast<float>(i) + 0.5F);
    integral += share;
    expected[i / 4] += 100000 * share;
  }
  EXPECT_NEAR(integral, 1.0, 1e-6);
  EXPECT_EQ(pdfWavelength(300.0F), 0.0F);
  EXPECT_GT(test::chiSquaredPValue(observed, expected), test::kSignificance);
}

TEST(SampleWavelength, InverseUndoesSample) {
  // Half an ulp of a wavelength (3e-5 nm) times the density (at most 0.008/nm).
  for (int i = 0; i < 1000; ++i) {
    const float u = (static_cast<float>(i) + 0.5F) / 1000;
    EXPECT_NEAR(invertWavelength(sampleWavelength(u).wavelength_nm), u, 1e-6F);
  }
}

}  // namespace
}  // namespace nephroid
