#include "trace/bsdf.h"

#include <gtest/gtest.h>

#include <utility>
#include <vector>

#include "core/sampling/sampler.h"
#include "core/sampling/warp.h"
#include "support/surface.h"
#include "support/tiny_scenes.h"

namespace nephroid {
namespace {

using test::makeDiffuse;
using test::makeGlass;
using test::makeMetal;
using test::Surface;

vec3 directionAt(float angle_deg) { return {std::sin(radians(angle_deg)), std::cos(radians(angle_deg)), 0.0F}; }

/// Directional albedo of all classes by sampling.
dvec3 measureAlbedo(const Surface& surface, vec3 wo, Transport transport, int count = 1 << 14) {
  const Bsdf bsdf = surface.at(wo);
  dvec3 sum(0.0);
  for (int i = 0; i < count; ++i) {
    Sampler sampler(1, 2, static_cast<std::uint32_t>(i));
    const vec2 u = sampler.next2D(), v = sampler.next2D();
    const float p_specular = bsdf.specularProbability();
    const bool specular = v.x < p_specular;
    const auto s = bsdf.sample(specular ? EventClass::kSpecular : EventClass::kDiffuse, u, v.y, transport);
    if (s) sum += dvec3(s->weight) / static_cast<double>(specular ? p_specular : 1.0F - p_specular);
  }
  return sum / static_cast<double>(count);
}

TEST(Bsdf, FullyRoughDielectricIsLambertian) {
  const Surface surface(makeDiffuse(vec3(0.6F, 0.3F, 0.1F)));
  const Bsdf bsdf = surface.at(directionAt(50));
  EXPECT_FALSE(bsdf.hasSpecular());
  const BsdfValue value = bsdf.evaluate(EventClass::kDiffuse, directionAt(-20), Transport::kRadiance);
  EXPECT_NEAR(value.f.x, 0.6F / kPi, 1e-6F);
  EXPECT_NEAR(value.f.z, 0.1F / kPi, 1e-6F);
}

TEST(Bsdf, LambertianOnesAreConstantWhereTheyReflect) {
  const Surface matte(makeDiffuse(vec3(0.6F, 0.3F, 0.1F)));
  for (const float wo : {5.0F, 80.0F}) {
    const Bsdf bsdf = matte.at(directionAt(wo));
    const auto constant = bsdf.constantDiffuse();
    ASSERT_TRUE(constant);
    for (const float wi : {-89.0F, -20.0F, 45.0F, 91.0F, 130.0F, 180.0F}) {
      const vec3 f = bsdf.evaluate(EventClass::kDiffuse, directionAt(wi), Transport::kRadiance).f;
      EXPECT_EQ(f, bsdf.reflectsFrom(directionAt(wi)) ? *constant : vec3(0.0F)) << wi;
    }
  }
  Material varnish = makeDiffuse(vec3(0.6F));
  varnish.roughness = 0.0F;
  for (const Material& m : {varnish, makeGlass(1.5F, 0.8F), makeMetal(vec3(0.9F), 0.8F)})
    EXPECT_FALSE(Surface(m).at(directionAt(30)).constantDiffuse()) << m.name;
}

TEST(Bsdf, WhiteSurfacesNeitherGainNorLose) {
  // Smooth interfaces conserve exactly; rough ones lose what single scattering loses between microfacets, never gain.
  Material varnish = makeDiffuse(vec3(1.0F));
  varnish.roughness = 0.0F;
  for (const float angle : {0.0F, 40.0F, 70.0F, 85.0F}) {
    for (const Material& m : {varnish, makeGlass(1.5F), makeMetal(vec3(1.0F))})
      EXPECT_NEAR(measureAlbedo(Surface(m), directionAt(angle), Transport::kFlux).x, 1.0, 2e-3)
          << m.name << ' ' << angle;
    for (const Material& m : {makeGlass(1.5F, 0.3F), makeMetal(vec3(1.0F), 0.3F), makeGlass(1.5F, 0.8F)}) {
      const double albedo = measureAlbedo(Surface(m), directionAt(angle), Transport::kFlux).x;
      EXPECT_LE(albedo, 1.0 + 2e-3) << m.name << ' ' << angle;
      EXPECT_GE(albedo, 0.6) << m.name << ' ' << angle;
    }
  }
}

TEST(Bsdf, RefractedRadianceScalesByTheSquaredIndexRatio) {
  const Surface surface(makeGlass(1.5F));
  const Bsdf bsdf = surface.at(directionAt(30));
  const auto flux = bsdf.sample(EventClass::kSpecular, vec2(0.5F), 0.99F, Transport::kFlux);
  const auto radiance = bsdf.sample(EventClass::kSpecular, vec2(0.5F), 0.99F, Transport::kRadiance);
  ASSERT_TRUE(flux && radiance && flux->transmitted);
  EXPECT_NEAR(radiance->weight.x / flux->weight.x, 1.0F / 2.25F, 1e-5F);
  EXPECT_NEAR(std::abs(flux->dir.x), std::sin(radians(30)) / 1.5F, 1e-6F);
}

TEST(Bsdf, PaneGoesStraightOnWithoutAnEvent) {
  Material pane = makeGlass(1.5F);
  pane.thickness = 0.0F;
  const Surface surface(pane);
  const Bsdf bsdf = surface.at(directionAt(35));
  const auto s = bsdf.sample(EventClass::kSpecular, vec2(0.5F), 0.99F, Transport::kFlux);
  ASSERT_TRUE(s);
  EXPECT_TRUE(s->pass);
  EXPECT_NEAR(length(s->dir + directionAt(35)), 0.0F, 1e-6F);
}

TEST(Bsdf, ThinPaneTransmittanceAtNormalIncidence) {
  Material pane = makeGlass(1.5F);
  pane.thickness = 0.0F;
  const Surface surface(pane);
  // R = 0.04 at each side, 2R/(1+R) for the pane with all its inner reflections.
  EXPECT_NEAR(passTransmittance(surface.resolved, 1.0F, 1.0F).x, 1.0F - 0.08F / 1.04F, 1e-6F);
}

TEST(Bsdf, EvaluationMatchesSampling) {
  // ∫ f·cos over the sphere, by uniform directions, against the mean weight of samples, class by class.
  const Material materials[] = {makeMetal(vec3(0.9F, 0.5F, 0.2F), 0.4F), makeGlass(1.5F, 0.4F), makeGlass(1.5F, 0.7F),
                                makeDiffuse(vec3(0.5F))};
  for (Material m : materials) {
    if (m.name == "diffuse") m.roughness = 0.7F;
    const Surface surface(m);
    const Bsdf bsdf = surface.at(directionAt(40));
    for (const EventClass c : {EventClass::kSpecular, EventClass::kDiffuse}) {
      if (!bsdf.isEvaluable(c)) continue;
      constexpr int kCount = 1 << 17;
      double uniform = 0.0, sampled = 0.0, density = 0.0;
      for (std::uint32_t i = 0; i < kCount; ++i) {
        Sampler sampler(3, 4, i);
        const vec2 u = sampler.next2D(), v = sampler.next2D();
        const vec3 wi = sampleUniformSphere(u);
        const BsdfValue value = bsdf.evaluate(c, wi, Transport::kFlux);
        uniform += 4.0 * kPi * value.f.x * std::abs(wi.y) / kCount;
        density += 4.0 * kPi * value.pdf / kCount;
        if (const auto s = bsdf.sample(c, v, sampler.next1D(), Transport::kFlux))
          sampled += static_cast<double>(s->weight.x) / kCount;
      }
      EXPECT_NEAR(uniform, sampled, 0.02 * sampled) << m.name << ' ' << m.roughness;
      EXPECT_LE(density, 1.02) << m.name;
      EXPECT_GE(density, 0.8) << m.name;
    }
  }
}

TEST(Bsdf, SampleAgreesWithItsOwnEvaluation) {
  for (const Material& m : {makeGlass(1.33F, 0.4F), makeMetal(vec3(0.8F), 0.35F)}) {
    const Surface surface(m);
    for (const Transport transport : {Transport::kFlux, Transport::kRadiance}) {
      const Bsdf bsdf = surface.at(directionAt(25), 1.0F, 1.33F);
      for (std::uint32_t i = 0; i < 200; ++i) {
        Sampler sampler(9, 1, i);
        const vec2 u = sampler.next2D();
        const auto s = bsdf.sample(EventClass::kSpecular, u, sampler.next1D(), transport);
        if (!s) continue;
        const BsdfValue value = bsdf.evaluate(EventClass::kSpecular, s->dir, transport);
        EXPECT_NEAR(value.pdf / s->pdf, 1.0F, 2e-2F);
        EXPECT_NEAR(value.f.x * std::abs(s->dir.y) / (value.pdf * s->weight.x), 1.0F, 2e-2F);
      }
    }
  }
}

TEST(Bsdf, IsReciprocalForReflection) {
  Material varnish = makeDiffuse(vec3(0.7F));
  varnish.roughness = 0.6F;
  for (const Material& m : {varnish, makeMetal(vec3(0.9F), 0.5F)}) {
    const Surface surface(m);
    const vec3 a = directionAt(20), b = normalize(vec3(-0.3F, 0.5F, 0.6F));
    for (const EventClass c : {EventClass::kSpecular, EventClass::kDiffuse}) {
      const float ab = surface.at(a).evaluate(c, b, Transport::kRadiance).f.x;
      const float ba = surface.at(b).evaluate(c, a, Transport::kRadiance).f.x;
      EXPECT_NEAR(ab, ba, 1e-4F * (ab + ba));
    }
  }
}

TEST(Bsdf, RefractionIsReciprocalUpToTheSquaredIndices) {
  // f(a→b)/n_b² = f(b→a)/n_a² for radiance (Veach 1997, §5.2).
  const Surface surface(makeGlass(1.5F, 0.4F));
  const vec3 outside = directionAt(20), inside = normalize(vec3(-0.3F, -0.9F, 0.1F));
  const float in_to_out =
      surface.at(outside, 1.0F, 1.5F).evaluate(EventClass::kSpecular, inside, Transport::kRadiance).f.x;
  const float out_to_in =
      surface.at(inside, 1.5F, 1.0F).evaluate(EventClass::kSpecular, outside, Transport::kRadiance).f.x;
  EXPECT_GT(in_to_out, 0.0F);
  EXPECT_NEAR(out_to_in / 2.25F, in_to_out, 1e-3F * in_to_out);
}

TEST(Bsdf, IsWhatTheSharedFormulasSayOfAReceiver) {
  // What shaders evaluate is what is sampled here, for every kind of receiver, from outside and from inside.
  std::vector<Material> materials{makeDiffuse(vec3(0.8F, 0.5F, 0.2F)), makeMetal(vec3(0.9F, 0.6F, 0.3F), 0.7F),
                                  makeMetal(vec3(0.9F), 0.1F), makeGlass(1.5F, 0.8F), makeGlass(1.5F)};
  Material mixture = makeDiffuse(vec3(0.8F, 0.5F, 0.2F));
  mixture.metallic = 0.4F;
  mixture.transmission = 0.3F;
  for (const float thickness : {0.0F, 1.0F})
    for (const float roughness : {0.0F, 0.3F, 0.5F, 0.8F, 1.0F}) {
      mixture.thickness = thickness;
      mixture.roughness = roughness;
      materials.push_back(mixture);
    }
  Material gold = makeMetal(vec3(1.0F), 0.6F);
  gold.conductor_ior = vec3(0.18F, 0.42F, 1.37F);
  gold.conductor_k = vec3(3.42F, 2.35F, 1.77F);
  materials.push_back(gold);
  const vec3 normal = normalize(vec3(0.3F, 0.9F, -0.2F));
  const Frame frame = Frame::fromZ(normal);
  int lit = 0;
  for (const Material& m : materials) {
    Surface surface(m);
    surface.resolved.specular_tint = vec3(1.0F, 0.8F, 0.5F);
    surface.point.normal_geometric = surface.point.normal_shading = normal;
    for (const auto& [ior_from, inner] : {std::pair{1.0F, 1.5F}, std::pair{1.5F, 1.0F}}) {
      const float ior_to = surface.resolved.is_solid ? inner : m.ior;
      const SurfaceOptics optics =
          makeSurfaceOptics(surface.resolved, ior_from, ior_to, averageFresnel(ior_to / ior_from));
      for (std::uint32_t i = 0; i < 200; ++i) {
        Sampler sampler(4, 2, i);
        const vec3 wo = sampleCosineHemisphere(sampler.next2D());
        vec3 wi = sampleCosineHemisphere(sampler.next2D());
        if (i % 8 == 0) wi.z = -wi.z;
        const vec3 expected = evaluateReceiver(optics, wo, wi, kDefaultSpecularAlpha);
        // What is transmitted is not the receiver's.
        const vec3 value = wi.z > 0.0F ? surface.at(frame.toWorld(wo), ior_from, inner)
                                             .evaluate(EventClass::kDiffuse, frame.toWorld(wi), Transport::kRadiance)
                                             .f
                                       : vec3(0.0F);
        // Near the critical angle the last bits of a direction are seen in F.
        EXPECT_LE(length(value - expected), 2e-3F * length(expected) + 1e-7F) << m.name << ' ' << m.roughness;
        lit += maxComponent(expected) > 0.0F;
      }
    }
  }
  EXPECT_GT(lit, 3000);
}

TEST(AverageFresnel, IsReciprocalAndKnownAtGlass) {
  EXPECT_NEAR(averageFresnel(1.5F), 0.0918F, 2e-4F);
  EXPECT_NEAR((1.0F - averageFresnel(1.5F)) / 2.25F, 1.0F - averageFresnel(1.0F / 1.5F), 1e-5F);
  EXPECT_EQ(averageFresnel(1.0F), 0.0F);
}

}  // namespace
}  // namespace nephroid
