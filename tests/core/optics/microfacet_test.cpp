#include "core/optics/microfacet.shared.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>
#include <vector>

#include "core/math.h"
#include "core/sampling/chi_squared.h"

namespace nephroid {
namespace {

vec3 makeDirection(double cos_theta, double phi) {
  const double s = std::sqrt(std::max(0.0, 1 - cos_theta * cos_theta));
  return vec3(dvec3(s * std::cos(phi), s * std::sin(phi), cos_theta));
}

/// ∫ f over the upper hemisphere, f smooth on the scale of alpha about the pole: midpoints in φ and in t, where
/// tan θ = α·t/(1 − t) spreads the peak of width α over the whole range.
template <class Function>
double integrateHemisphere(double alpha, const Function& f) {
  const int rings = 800, sectors = 200;
  double sum = 0;
  for (int i = 0; i < rings; ++i) {
    const double t = (i + 0.5) / rings, tangent = alpha * t / (1 - t);
    const double cos_theta = 1 / std::sqrt(1 + tangent * tangent);
    // dω = sin θ dθ dφ, dθ = cos²θ d tan θ, d tan θ = α/(1 − t)² dt
    const double weight = tangent * cos_theta * cos_theta * cos_theta * alpha / ((1 - t) * (1 - t)) / rings;
    for (int j = 0; j < sectors; ++j)
      sum += weight * 2 * double{kPi} / sectors * f(makeDirection(cos_theta, 2 * double{kPi} * (j + 0.5) / sectors));
  }
  return sum;
}

TEST(GgxD, ProjectsToTheUnitArea) {
  for (const float alpha : {0.001F, 0.05F, 0.3F, 1.0F})
    EXPECT_NEAR(integrateHemisphere(double{alpha}, [&](vec3 h) { return double{ggxD(h, alpha)} * h.z; }), 1.0, 1e-4)
        << alpha;
}

TEST(GgxD, MatchesTheUsualForm) {
  for (const double alpha : {0.1, 0.5, 1.0})
    for (const double c : {0.1, 0.5, 0.9, 1.0}) {
      const double b = c * c * (alpha * alpha - 1) + 1;
      EXPECT_NEAR(ggxD(makeDirection(c, 1.0), static_cast<float>(alpha)) * double{kPi} * b * b / (alpha * alpha), 1.0,
                  2e-5);
    }
  EXPECT_EQ(ggxD(vec3(0, 0.6F, -0.8F), 0.5F), 0.0F);
}

TEST(GgxG1, SeesAsMuchFacetAreaAsThereIsSurface) {
  // Smith's condition: ∫ G1(w) max(0, w·h) D(h) dh = cos θ.
  for (const float alpha : {0.1F, 0.5F, 1.0F})
    for (const double c : {0.05, 0.4, 0.9}) {
      const vec3 w = makeDirection(c, 0.3);
      const double area = integrateHemisphere(
          double{alpha}, [&](vec3 h) { return double{ggxG1(w, alpha)} * std::max(dot(w, h), 0.0F) * ggxD(h, alpha); });
      EXPECT_NEAR(area / c, 1.0, 1e-3) << alpha << " " << c;
    }
}

TEST(GgxMasking, TermsAgreeWithLambda) {
  for (const float alpha : {0.01F, 0.3F, 1.0F}) {
    const vec3 wi = makeDirection(0.3, 0.2), wo = makeDirection(0.8, 2.0);
    const float li = ggxLambda(wi, alpha), lo = ggxLambda(wo, alpha);
    // Λ = (sqrt(1 + α² tan²θ) − 1)/2
    EXPECT_NEAR(li, 0.5 * (std::sqrt(1 + double{alpha} * alpha * 0.91 / 0.09) - 1), 1e-6);
    EXPECT_FLOAT_EQ(ggxG1(wi, alpha), 1 / (1 + li));
    EXPECT_FLOAT_EQ(ggxG2(wi, wo, alpha), 1 / (1 + li + lo));
    EXPECT_FLOAT_EQ(ggxG2Transmission(wi, -wo, alpha), 1 / ((1 + li) * (1 + lo)));
  }
}

TEST(GgxMasking, IsSymmetricAndFiniteAtGrazingIncidence) {
  const vec3 wi = makeDirection(0.3, 0.2), wo = makeDirection(0.8, 2.0), grazing(1, 0, 0);
  EXPECT_EQ(ggxG2(wi, wo, 0.3F), ggxG2(wo, wi, 0.3F));
  EXPECT_EQ(ggxG2Transmission(wi, wo, 0.3F), ggxG2Transmission(wo, wi, 0.3F));
  EXPECT_EQ(ggxG1(grazing, 0.3F), 0.0F);
  EXPECT_EQ(ggxG2(grazing, grazing, 0.3F), 0.0F);
  EXPECT_TRUE(std::isinf(ggxLambda(grazing, 0.3F)));
  EXPECT_TRUE(std::isfinite(pdfGgxVndf(grazing, normalize(vec3(1, 0, 1)), 0.3F)));
}

TEST(GgxVndf, DensityIntegratesToOne) {
  for (const float alpha : {0.05F, 0.3F, 1.0F})
    for (const double c : {0.02, 0.3, 1.0}) {
      const vec3 wo = makeDirection(c, 1.0);
      EXPECT_NEAR(integrateHemisphere(double{alpha}, [&](vec3 h) { return double{pdfGgxVndf(wo, h, alpha)}; }), 1.0,
                  2e-3)
          << alpha << " " << c;
    }
}

TEST(GgxVndf, DensityIsThatOfVisibleNormals) {
  const vec3 wo = makeDirection(0.4, 1.0), h = makeDirection(0.9, 0.5);
  EXPECT_FLOAT_EQ(pdfGgxVndf(wo, h, 0.3F), ggxG1(wo, 0.3F) * dot(wo, h) * ggxD(h, 0.3F) / wo.z);
}

/// Coordinates in which a normal distribution of width alpha fills the unit square: t of integrateHemisphere, φ/2π.
vec2 findCell(vec3 h, float alpha) {
  const float tangent = std::sqrt(h.x * h.x + h.y * h.y) / (alpha * h.z);
  return {tangent / (1 + tangent), 0.5F + 0.4999999F * std::atan2(h.y, h.x) / kPi};
}

TEST(GgxVndf, SamplesFollowTheirDensity) {
  // 6 tests, Šidák.
  const int side = 16, samples = 100000, fine = 8;
  std::mt19937 generator(21);
  std::uniform_real_distribution<float> uniform(0.0F, kOneMinusEpsilon);
  for (const float alpha : {0.02F, 0.3F, 0.9F})
    for (const double c : {0.1, 0.7}) {
      const vec3 wo = makeDirection(c, 0.7);
      std::vector<double> observed(side * side, 0.0), expected(side * side, 0.0);
      for (int i = 0; i < samples; ++i) {
        const vec2 cell = findCell(sampleGgxVndf(wo, alpha, vec2(uniform(generator), uniform(generator))), alpha);
        ++observed[static_cast<std::size_t>(cell.x * side) * side + static_cast<std::size_t>(cell.y * side)];
      }
      for (int i = 0; i < side * fine; ++i)
        for (int j = 0; j < side * fine; ++j) {
          const double t = (i + 0.5) / (side * fine), tangent = double{alpha} * t / (1 - t);
          const double cos_theta = 1 / std::sqrt(1 + tangent * tangent);
          const double area = tangent * std::pow(cos_theta, 3) * double{alpha} / ((1 - t) * (1 - t)) * 2 * double{kPi} /
                              (side * fine * side * fine);
          const vec3 h = makeDirection(cos_theta, 2 * double{kPi} * ((j + 0.5) / (side * fine) - 0.5));
          expected[static_cast<std::size_t>(i / fine * side + j / fine)] += samples * area * pdfGgxVndf(wo, h, alpha);
        }
      // Where a cell is cut by the edge of what wo sees, all midpoints may miss what a sample hits.
      for (double& e : expected) e = std::max(e, 1e-3);
      EXPECT_GT(test::chiSquaredPValue(observed, expected), test::sidak(6)) << alpha << " " << c;
    }
}

TEST(GgxVndf, InverseUndoesSample) {
  std::mt19937 generator(5);
  std::uniform_real_distribution<float> uniform(0.01F, 0.98F);
  for (const float alpha : {0.01F, 0.3F, 1.0F})
    for (const double c : {0.1, 0.7, 1.0})
      for (int i = 0; i < 500; ++i) {
        const vec3 wo = makeDirection(c, 0.7);
        const vec2 u(uniform(generator), uniform(generator));
        const vec2 v = invertGgxVndf(wo, sampleGgxVndf(wo, alpha, u), alpha);
        EXPECT_NEAR(u.x, v.x, 2e-5F) << alpha << " " << c;
        EXPECT_NEAR(u.y, v.y, 2e-5F) << alpha << " " << c;
      }
}

TEST(GgxVndf, SamplesFaceTheViewerAndTheSurface) {
  std::mt19937 generator(6);
  std::uniform_real_distribution<float> uniform(0.0F, kOneMinusEpsilon);
  for (const float alpha : {1e-4F, 0.1F, 1.0F})
    for (const double c : {0.0, 1e-4, 0.5, 1.0})
      for (int i = 0; i < 1000; ++i) {
        const vec3 wo = makeDirection(c, 2.5);
        const vec3 h = sampleGgxVndf(wo, alpha, vec2(uniform(generator), uniform(generator)));
        ASSERT_GT(h.z, 0.0F);
        ASSERT_GE(dot(h, wo), -1e-5F);
        ASSERT_NEAR(length(h), 1.0F, 1e-6F);
      }
}

TEST(GgxVndf, AtAlphaZeroIsTheNormal) {
  EXPECT_EQ(sampleGgxVndf(makeDirection(0.5, 1.0), 0.0F, vec2(0.3F, 0.6F)), vec3(0, 0, 1));
}

TEST(GgxReflection, NeverGainsEnergy) {
  // White furnace with F = 1: the mean of G2/G1 over visible normals whose mirror direction leaves the surface; what is
  // missing is what single scattering loses, next to nothing for smooth surfaces.
  std::mt19937 generator(7);
  std::uniform_real_distribution<float> uniform(0.0F, kOneMinusEpsilon);
  const auto albedo = [&](float alpha, vec3 wo) {
    double sum = 0;
    for (int i = 0; i < 20000; ++i) {
      const vec3 h = sampleGgxVndf(wo, alpha, vec2(uniform(generator), uniform(generator)));
      const vec3 wi = 2 * dot(wo, h) * h - wo;
      if (wi.z > 0) sum += ggxG2(wi, wo, alpha) / ggxG1(wo, alpha);
    }
    return sum / 20000;
  };
  for (const double c : {0.1, 0.5, 1.0}) {
    for (const float alpha : {0.1F, 0.5F, 1.0F}) EXPECT_LE(albedo(alpha, makeDirection(c, 0)), 1.0) << alpha;
    EXPECT_GT(albedo(0.02F, makeDirection(c, 0)), 0.97);
  }
}

}  // namespace
}  // namespace nephroid
