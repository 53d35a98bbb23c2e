// A mixture of BSDF and guide reflects as much as the BSDF alone.
#include "techniques/reference/guided_bsdf.h"

#include <gtest/gtest.h>

#include "core/sampling/sampler.h"
#include "core/sampling/warp.h"
#include "support/surface.h"
#include "support/tiny_scenes.h"

namespace nephroid {
namespace {

using test::Surface;

const vec3 kTowardsEye = normalize(vec3(-0.5F, 0.8F, 0.2F));

/// Lessons that saw light on one side of the surface, partly below its horizon.
DirectionLobe makeLobe() {
  std::vector<DirectionLesson> lessons;
  for (std::uint32_t i = 0; i < 4096; ++i) {
    Sampler sampler(1, 2, i);
    const vec3 dir = sampleUniformSphere(sampler.next2D());
    lessons.push_back({.position = vec3(0),
                       .dir = dir,
                       .distance = 2.0F,
                       .pdf = pdfSolidAngleUniformSphere(),
                       .pdf_bsdf = pdfSolidAngleUniformSphere(),
                       .value = dot(dir, normalize(vec3(1.0F, 0.1F, 0.0F))) > 0.9F ? 1.0F : 0.0F,
                       .rays = 1.0F});
  }
  return DirectionLobe(lessons);
}

/// Mean over many ways of what each weighs, and of the same times one coordinate of its direction.
struct Moments {
  dvec3 albedo{0.0}, towards_x{0.0};
};
Moments measure(const GuidedBsdf& bsdf, std::initializer_list<WayBy> by) {
  constexpr std::uint32_t kDraws = 1 << 15;
  Moments moments;
  std::uint32_t stream = 0;
  for (const WayBy how : by) {
    ++stream;
    for (std::uint32_t i = 0; i < kDraws; ++i) {
      Sampler sampler(6, stream, i);
      const vec2 u = sampler.next2D();
      const auto way = bsdf.sample(u, sampler.next1D(), how);
      if (!way) continue;
      const dvec3 weight = dvec3(way->sample.weight) / static_cast<double>(kDraws * by.size());
      moments.albedo += weight;
      moments.towards_x += weight * static_cast<double>(way->sample.dir.x);
      EXPECT_EQ(way->sample.transmitted, way->sample.dir.y < 0.0F);
    }
  }
  return moments;
}

void expectSameMoments(const Material& material) {
  const Surface surface(material);
  const Bsdf bsdf = surface.at(kTowardsEye);
  const DirectionLobe lobe = makeLobe();
  const Moments alone = measure(GuidedBsdf(bsdf, nullptr, vec3(0)), {WayBy::kChance});
  const GuidedBsdf mixture(bsdf, &lobe, vec3(0));
  for (const Moments& mixed : {measure(mixture, {WayBy::kChance}), measure(mixture, {WayBy::kGuide, WayBy::kBsdf})}) {
    for (int c = 0; c < 3; ++c) {
      EXPECT_GT(alone.albedo[c], 0.05);
      EXPECT_NEAR(mixed.albedo[c], alone.albedo[c], 0.01 * alone.albedo[c]) << c;
      EXPECT_NEAR(mixed.towards_x[c], alone.towards_x[c], 0.01 * alone.albedo[c]) << c;
    }
  }
}

TEST(GuidedBsdf, ReflectsAsMuchAsTheBsdfAlone) {
  expectSameMoments(test::makeDiffuse(vec3(0.8F, 0.4F, 0.2F)));
  Material metal = test::makeMetal(vec3(0.9F, 0.6F, 0.3F));
  metal.roughness = 0.8F;
  expectSameMoments(metal);
}

TEST(GuidedBsdf, TransmitsAsMuchAsTheBsdfAlone) {
  Material frosted = test::makeGlass(1.5F);
  frosted.roughness = 0.8F;
  expectSameMoments(frosted);
}

TEST(GuidedBsdf, CountsByTheDensityOfBoth) {
  const Surface surface(test::makeDiffuse(vec3(0.5F)));
  const Bsdf bsdf = surface.at(kTowardsEye);
  const DirectionLobe lobe = makeLobe();
  const GuidedBsdf mixture(bsdf, &lobe, vec3(0));
  for (std::uint32_t i = 0; i < 64; ++i) {
    Sampler sampler(7, 0, i);
    const vec2 u = sampler.next2D();
    const auto way = mixture.sample(u, sampler.next1D(), WayBy::kChance);
    if (!way) continue;
    const float by_bsdf = way->sample.dir.y / kPi;
    EXPECT_NEAR(way->pdf_bsdf, by_bsdf, 1e-5F);
    EXPECT_NEAR(way->sample.pdf, 0.5F * lobe.pdf(vec3(0), way->sample.dir) + 0.5F * by_bsdf, 1e-4F * way->sample.pdf);
    EXPECT_EQ(mixture.pdf(way->sample.dir, way->pdf_bsdf), way->sample.pdf);
  }
}

}  // namespace
}  // namespace nephroid
