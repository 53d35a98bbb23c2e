#include "core/optics/surface.shared.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "core/math.h"
#include "core/optics/fresnel_average.h"

namespace nephroid {
namespace {

/// What counts as class D in these tests unless they say otherwise.
constexpr float kSpecularAlpha = 0.25F;

SurfaceOptics makeSurface(vec3 base, float alpha) {
  SurfaceOptics s{};
  s.base = base;
  s.alpha = alpha;
  s.gloss = 1.0F;
  s.specular_tint = vec3(1.0F);
  s.ior_from = 1.0F;
  s.ior_to = 1.5F;
  s.average_fresnel = averageFresnelDielectric(1.5F);
  return s;
}
SurfaceOptics makeMetal(vec3 base, float alpha) {
  SurfaceOptics s = makeSurface(base, alpha);
  s.metallic = 1.0F;
  return s;
}
SurfaceOptics makeGold(float alpha) {
  SurfaceOptics s = makeMetal(vec3(1.0F), alpha);
  s.has_conductor = 1;
  s.conductor_ior = vec3(0.18F, 0.42F, 1.37F);
  s.conductor_k = vec3(3.42F, 2.35F, 1.77F);
  return s;
}
SurfaceOptics makePane(vec3 base) {
  SurfaceOptics s = makeSurface(base, 0.0F);
  s.transmission = 1.0F;
  s.is_pane = 1;
  return s;
}
/// A bit of everything: partly metal, partly transmitting, tinted.
SurfaceOptics makeMixture(float alpha) {
  SurfaceOptics s = makeSurface(vec3(0.8F, 0.5F, 0.2F), alpha);
  s.metallic = 0.3F;
  s.transmission = 0.4F;
  s.gloss = 0.7F;
  s.specular_tint = vec3(0.9F, 1.0F, 0.5F);
  return s;
}

vec3 directionAt(float cos_theta, float phi) {
  const float sin_theta = std::sqrt((1.0F - cos_theta) * (1.0F + cos_theta));
  return {sin_theta * std::cos(phi), sin_theta * std::sin(phi), cos_theta};
}

vec3 reflectanceAt(const SurfaceOptics& s, float cos_theta) {
  return interfaceReflectance(s, cos_theta, interfaceFresnel(s, cos_theta));
}

/// ∫ f·cos over the hemisphere of wi: midpoints in phi and in s with cosθ = s², since f changes like a square root at
/// grazing directions.
dvec3 computeAlbedo(const SurfaceOptics& s, vec3 wo, float specular_alpha, int steps) {
  dvec3 sum(0.0);
  for (int i = 0; i < steps; ++i) {
    const double root = (i + 0.5) / steps;
    const auto cos_theta = static_cast<float>(root * root);
    for (int j = 0; j < steps; ++j) {
      const float phi = 2.0F * kPi * (static_cast<float>(j) + 0.5F) / static_cast<float>(steps);
      sum += 2.0 * root * root * root * dvec3(evaluateReceiver(s, wo, directionAt(cos_theta, phi), specular_alpha));
    }
  }
  return sum * (2.0 * double{kPi} / steps / steps);
}

TEST(InterfaceReflectance, OfADielectricIsFresnelTimesGlossAndTint) {
  SurfaceOptics s = makeSurface(vec3(0.5F), 0.0F);
  s.gloss = 0.5F;
  s.specular_tint = vec3(1.0F, 0.5F, 0.0F);
  // 0.04 at normal incidence on an index of 1.5.
  EXPECT_NEAR(reflectanceAt(s, 1.0F).x, 0.02F, 1e-7F);
  EXPECT_NEAR(reflectanceAt(s, 1.0F).y, 0.01F, 1e-7F);
  EXPECT_EQ(reflectanceAt(s, 1.0F).z, 0.0F);
  s.gloss = 0.0F;
  EXPECT_EQ(reflectanceAt(s, 0.1F), vec3(0.0F));
}

TEST(InterfaceReflectance, OfAMetalIsSchlicksOrTheExactOne) {
  const SurfaceOptics schlick = makeMetal(vec3(0.9F, 0.6F, 0.3F), 0.0F), exact = makeGold(0.0F);
  for (const float c : {1.0F, 0.5F, 0.1F}) {
    EXPECT_EQ(reflectanceAt(schlick, c), fresnelSchlick(c, schlick.base));
    EXPECT_EQ(reflectanceAt(exact, c), fresnelConductor(c, exact.conductor_ior, exact.conductor_k));
  }
}

TEST(InterfaceReflectance, OfMetalAndDielectricIsTheirMixture) {
  SurfaceOptics s = makeSurface(vec3(0.8F, 0.5F, 0.2F), 0.0F);
  for (const float c : {1.0F, 0.4F}) {
    const vec3 metal = fresnelSchlick(c, s.base), dielectric = vec3(fresnelDielectric(c, 1.0F / 1.5F));
    s.metallic = 0.25F;
    EXPECT_LT(length(reflectanceAt(s, c) - (0.25F * metal + 0.75F * dielectric)), 1e-6F) << c;
  }
}

TEST(Interface, OfAWhitePaneReflectsOrTransmitsEverything) {
  const SurfaceOptics s = makePane(vec3(1.0F));
  for (const float c : {1.0F, 0.6F, 0.2F, 0.01F}) {
    const float fresnel = interfaceFresnel(s, c);
    EXPECT_NEAR(interfaceReflectance(s, c, fresnel).x, 2.0F * fresnel / (1.0F + fresnel), 1e-6F) << c;
    EXPECT_NEAR((interfaceReflectance(s, c, fresnel) + interfaceTransmittance(s, fresnel)).x, 1.0F, 1e-6F) << c;
  }
}

TEST(InterfaceTransmittance, HasTheColourOfTheBase) {
  const SurfaceOptics s = makePane(vec3(1.0F, 0.5F, 0.0F));
  const vec3 t = interfaceTransmittance(s, interfaceFresnel(s, 1.0F));
  // 0.04 at each face: 1 − 0.08/1.04.
  EXPECT_NEAR(t.x, 0.923077F, 1e-6F);
  EXPECT_NEAR(t.y, 0.461538F, 1e-6F);
  EXPECT_EQ(t.z, 0.0F);
}

TEST(InterfaceTransmittance, BeyondTheCriticalAngleIsZeroWhateverTheTint) {
  SurfaceOptics s = makeSurface(vec3(1.0F), 0.0F);
  s.transmission = 1.0F;
  s.is_solid = 1;
  s.ior_from = 1.5F;
  s.ior_to = 1.0F;
  s.specular_tint = vec3(0.5F);
  EXPECT_EQ(interfaceTransmittance(s, interfaceFresnel(s, 0.7F)), vec3(0.0F));
  EXPECT_GT(interfaceTransmittance(s, interfaceFresnel(s, 0.8F)).x, 0.5F);
}

TEST(InterfaceTransmittance, OfMetalAndOfWhatDoesNotTransmitIsZero) {
  SurfaceOptics s = makePane(vec3(1.0F));
  s.metallic = 1.0F;
  EXPECT_EQ(interfaceTransmittance(s, 0.04F), vec3(0.0F));
  EXPECT_EQ(interfaceTransmittance(makeSurface(vec3(1.0F), 0.0F), 0.04F), vec3(0.0F));
}

TEST(Receiver, WithoutGlossIsLambertian) {
  SurfaceOptics s = makeSurface(vec3(0.6F, 0.3F, 0.1F), 1.0F);
  s.gloss = 0.0F;
  for (const float c : {0.05F, 0.5F, 1.0F})
    EXPECT_LT(length(evaluateReceiver(s, directionAt(0.3F, 1.0F), directionAt(c, 2.0F), kSpecularAlpha) -
                     s.base * (1.0F / kPi)),
              1e-7F);
}

TEST(Receiver, OfAWhiteBaseUnderASmoothVarnishReturnsWhatArrives) {
  // The varnish's mirror reflection and the base together: R(θo) + (1 − F(θo))·2∫(1 − F(c))c dc/(1 − <F>) = 1.
  for (const float ior : {1.2F, 1.5F, 2.0F}) {
    SurfaceOptics s = makeSurface(vec3(1.0F), 0.0F);
    s.ior_to = ior;
    s.average_fresnel = averageFresnelDielectric(ior);
    for (const float c : {1.0F, 0.6F, 0.2F, 0.05F}) {
      const dvec3 base = computeAlbedo(s, directionAt(c, 0.4F), kSpecularAlpha, 128);
      EXPECT_NEAR(base.x + double{reflectanceAt(s, c).x}, 1.0, 2e-4) << ior << ' ' << c;
    }
  }
}

TEST(Receiver, OfAColouredBaseReturnsItsColourOfWhatEntersTheVarnish) {
  const SurfaceOptics s = makeSurface(vec3(0.8F, 0.5F, 0.2F), 0.0F);
  const float c = 0.5F;
  const dvec3 albedo = computeAlbedo(s, directionAt(c, 0.0F), kSpecularAlpha, 128);
  const dvec3 expected = dvec3(s.base) * (1.0 - double{reflectanceAt(s, c).x});
  EXPECT_LT(glm::length(albedo - expected), 2e-4);
}

TEST(Receiver, ReturnsNoMoreThanArrives) {
  SurfaceOptics white = makeMixture(0.5F);
  white.base = white.specular_tint = vec3(1.0F);
  for (const SurfaceOptics& s : {makeSurface(vec3(1.0F), 0.5F), makeMetal(vec3(1.0F), 0.4F), white})
    for (const float c : {1.0F, 0.5F, 0.1F})
      EXPECT_LE(computeAlbedo(s, directionAt(c, 0.0F), kSpecularAlpha, 128).x, 1.0 + 1e-3) << s.alpha << ' ' << c;
}

TEST(Receiver, IsReciprocal) {
  std::mt19937 generator(3);
  std::uniform_real_distribution<float> unit(0.0F, 1.0F);
  SurfaceOptics from_inside = makeSurface(vec3(0.7F), 0.5F);
  from_inside.ior_from = 1.5F;
  from_inside.ior_to = 1.0F;
  from_inside.average_fresnel = averageFresnelDielectric(1.0F / 1.5F);
  for (const SurfaceOptics& s : {makeSurface(vec3(0.7F, 0.4F, 0.1F), 0.3F), makeMetal(vec3(0.9F, 0.5F, 0.2F), 0.5F),
                                 makeGold(0.3F), makeMixture(0.6F), from_inside})
    for (int i = 0; i < 500; ++i) {
      const vec3 a = directionAt(0.01F + 0.99F * unit(generator), 6.2F * unit(generator));
      const vec3 b = directionAt(0.01F + 0.99F * unit(generator), 6.2F * unit(generator));
      const vec3 ab = evaluateReceiver(s, a, b, kSpecularAlpha), ba = evaluateReceiver(s, b, a, kSpecularAlpha);
      EXPECT_GT(ab.x, 0.0F);
      EXPECT_LT(length(ab - ba), 3e-7F * (length(ab) + length(ba)));
    }
}

TEST(Receiver, CountsTheInterfaceOnlyIfItIsDiffuse) {
  const vec3 wo = directionAt(0.6F, 0.0F), wi = directionAt(0.6F, kPi);
  for (const float alpha : {0.0F, 0.1F, 0.25F, 0.6F}) {
    const SurfaceOptics s = makeSurface(vec3(0.5F), alpha);
    const float fresnel = interfaceFresnel(s, 0.6F);
    const vec3 base = evaluateBase(baseScale(s), baseFactor(s, fresnel), baseFactor(s, fresnel));
    const vec3 both = base + evaluateInterface(s, wo, wi);
    EXPECT_EQ(evaluateReceiver(s, wo, wi, 0.25F), alpha < 0.25F ? base : both) << alpha;
    // A smooth interface is a delta, whatever its class: there is no value to add.
    EXPECT_EQ(evaluateReceiver(s, wo, wi, 0.0F), alpha == 0.0F ? base : both) << alpha;
    EXPECT_EQ(evaluateInterface(s, wo, wi) == vec3(0.0F), alpha == 0.0F) << alpha;
  }
}

TEST(Receiver, OfAMirrorOfMetalIsBlack) {
  EXPECT_EQ(evaluateReceiver(makeGold(0.01F), vec3(0, 0, 1), vec3(0, 0, 1), kSpecularAlpha), vec3(0.0F));
}

TEST(Receiver, IsBlackFromBelow) {
  const SurfaceOptics s = makeMixture(0.5F);
  const vec3 above = directionAt(0.5F, 1.0F), below(above.x, above.y, -above.z), along(1, 0, 0);
  for (const vec3 w : {below, along}) {
    EXPECT_EQ(evaluateReceiver(s, above, w, kSpecularAlpha), vec3(0.0F));
    EXPECT_EQ(evaluateReceiver(s, w, above, kSpecularAlpha), vec3(0.0F));
    EXPECT_EQ(evaluateInterface(s, above, w), vec3(0.0F));
    EXPECT_EQ(evaluateInterface(s, w, above), vec3(0.0F));
  }
}

TEST(Facets, MatchThePlainForm) {
  for (const float alpha : {0.01F, 0.3F, 1.0F})
    for (const float co : {1.0F, 0.5F, 0.02F})
      for (const float ci : {0.9F, 0.3F, 0.02F}) {
        const vec3 wo = directionAt(co, 0.0F), wi = directionAt(ci, 2.0F), h = normalize(wo + wi);
        const double plain = double{ggxD(h, alpha)} * ggxG2(wi, wo, alpha) / (4.0 * wo.z * wi.z);
        EXPECT_NEAR(evaluateFacets(wo, wi, h, alpha) / plain, 1.0, 1e-6) << alpha << ' ' << co << ' ' << ci;
      }
}

TEST(Facets, StayFiniteAtGrazingDirections) {
  // The product of these cosines is 0 in single precision.
  const vec3 wo(1.0F, 0.0F, 1e-30F), wi = normalize(vec3(0.5F, 0.5F, 1e-30F));
  const float value = evaluateFacets(wo, wi, normalize(wo + wi + vec3(0, 0, 0.1F)), 0.5F);
  EXPECT_TRUE(std::isfinite(value));
  EXPECT_GT(value, 0.0F);
}

TEST(InterfaceValue, AtNormalIncidenceIsReflectanceOverFourPiAlphaSquared) {
  // D = 1/(π α²), no masking: R/(4 π α²).
  const SurfaceOptics s = makeMetal(vec3(0.9F, 0.5F, 0.2F), 0.4F);
  const vec3 value = evaluateInterface(s, vec3(0, 0, 1), vec3(0, 0, 1));
  EXPECT_LT(length(value - s.base * (1.0F / (4.0F * kPi * 0.16F))), 1e-6F);
}

}  // namespace
}  // namespace nephroid
