#include "surface_twin.shared.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <vector>

#include "core/optics/fresnel_average.h"
#include "core/optics/photon.shared.h"
#include "shaders/tests/gpu/twins/surface.comp.h"
#include "support/gpu_fixture.h"
#include "support/twin.h"
#include "support/twin_grids.h"

#include "support/tracked_begin.h"

#include "surface_twin.shared.h"

#include "support/tracked_end.h"

namespace nephroid::testing {
namespace {

class SurfaceTwin : public GpuTest {};

/// Every kind of surface: of each weight both ends and one between, of what it switches both choices; any colours.
std::vector<SurfaceOptics> surfaces() {
  const std::vector<vec3> bases{vec3(1.0F), {0.8F, 0.5F, 0.2F}, {1.0F, 0.5F, 0.0F}, vec3(0.0F)};
  const std::vector<vec3> tints{vec3(1.0F), {0.9F, 1.0F, 0.5F}, {0.0F, 0.3F, 1.0F}};
  // Gold, and channels that hardly absorb, with indices on both sides of 1.
  const std::vector<std::array<vec3, 2>> metals{{{{0.18F, 0.42F, 1.37F}, {3.42F, 2.35F, 1.77F}}},
                                                {{{1.5F, 1.0F, 0.6F}, {0.0F, 1e-3F, 0.5F}}}};
  std::vector<SurfaceOptics> result;
  std::uint32_t i = 0;
  for (const float metallic : {0.0F, 0.3F, 1.0F})
    for (const std::uint32_t has_conductor : {0U, 1U})
      for (const float transmission : {0.0F, 0.4F, 1.0F})
        for (const std::uint32_t is_pane : {0U, 1U})
          for (const float gloss : {0.0F, 0.7F, 1.0F})
            for (const float alpha : {0.0F, 5e-4F, 0.25F, 1.0F})
              for (const auto& [ior_from, ior_to] : std::vector<std::array<float, 2>>{
                       {1.0F, 1.5F}, {1.5F, 1.0F}, {1.33F, 1.33F}, {1.0003F, 1.0F}, {1.33F, 2.42F}}) {
                if ((metallic == 0.0F && has_conductor != 0) || (transmission == 0.0F && is_pane != 0)) continue;
                if (transmission == 1.0F && gloss != 1.0F) continue;
                const std::uint32_t chance = mixBits(i++);
                const auto& [ior, k] = metals[(chance >> 16) % metals.size()];
                SurfaceOptics s{};
                s.base = bases[chance % bases.size()];
                s.metallic = metallic;
                s.alpha = alpha;
                s.transmission = transmission;
                s.gloss = gloss;
                s.specular_tint = tints[(chance >> 8) % tints.size()];
                s.ior_from = ior_from;
                s.ior_to = ior_to;
                s.average_fresnel = averageFresnelDielectric(ior_to / ior_from);
                s.conductor_ior = ior;
                s.conductor_k = k;
                s.has_conductor = has_conductor;
                s.is_pane = is_pane;
                s.is_solid = transmission > 0.0F && is_pane == 0 ? 1 : 0;
                result.push_back(s);
              }
  return result;
}

struct Directions {
  vec3 wo, wi;
};

/// Towards each other's mirror image, back where they came from, and any which way; some from below.
std::vector<Directions> pairsOfDirections() {
  std::vector<vec3> all = directions(24);
  // Half vectors about the critical angle and Brewster's of glass, and directions whose cosines' product is 0.
  for (const float c : {0.745355F, 0.745356F, 0.745357F, 0.5547002F, 0.83205F})
    all.emplace_back(std::sqrt((1.0F - c) * (1.0F + c)), 0.0F, c);
  all.emplace_back(1.0F, 0.0F, 1e-25F);
  all.emplace_back(0.6F, 0.8F, 1e-25F);
  std::vector<Directions> result;
  for (std::size_t i = 0; i < all.size(); ++i) {
    const vec3& wo = all[i];
    result.push_back({wo, {-wo.x, -wo.y, wo.z}});
    result.push_back({wo, wo});
    for (const std::size_t step : {3U, 5U, 7U}) result.push_back({wo, all[(step * i + step) % all.size()]});
  }
  return result;
}

/// @param per_surface  how many pairs of directions each surface is seen from
std::vector<SurfaceInput> surfaceInputs(std::uint32_t per_surface) {
  const std::vector<Directions> pairs = pairsOfDirections();
  std::vector<SurfaceInput> inputs;
  std::uint32_t i = 0;
  for (const SurfaceOptics& s : surfaces()) {
    std::vector<float> angles = cosines(16);
    const float ratio = s.ior_from / s.ior_to;
    const float critical = std::sqrt(std::max(1.0F - 1.0F / (ratio * ratio), 0.0F));
    for (const float factor : {0.99F, nextTo(1.0F, 0.0F), 1.0F, nextTo(1.0F, 2.0F), 1.01F})
      angles.push_back(critical * factor);
    for (std::uint32_t j = 0; j < per_surface; ++j) {
      const std::uint32_t chance = mixBits(++i);
      const auto& [wo, wi] = pairs[chance % pairs.size()];
      const float cos_theta = angles[(chance >> 16) % angles.size()];
      const float sum = length(wo + wi);
      inputs.push_back({.base = s.base,
                        .metallic = s.metallic,
                        .alpha = s.alpha,
                        .transmission = s.transmission,
                        .gloss = s.gloss,
                        .specular_tint = s.specular_tint,
                        .ior_from = s.ior_from,
                        .ior_to = s.ior_to,
                        .average_fresnel = s.average_fresnel,
                        .conductor_ior = s.conductor_ior,
                        .conductor_k = s.conductor_k,
                        .has_conductor = static_cast<float>(s.has_conductor),
                        .is_pane = static_cast<float>(s.is_pane),
                        .is_solid = static_cast<float>(s.is_solid),
                        .cos_theta = cos_theta,
                        .fresnel = interfaceFresnel(s, cos_theta),
                        .wo = wo,
                        .wi = wi,
                        .h = sum > 0.0F ? (wo + wi) / sum : vec3(0, 0, 1),
                        .specular_alpha = std::array{0.0F, 0.25F, nextTo(0.25F, 1.0F)}[i % 3]});
    }
  }
  return inputs;
}

TEST_F(SurfaceTwin, GpuAgreesWithCpu) {
  const TwinRun run(device(), shaders::surface_comp, surfaceInputs(16), evaluateSurface, tracked::evaluateSurface);
  // A difference from 1, a quotient by a constant, two products and a sum: 7 ulp of 1.
  NEPHROID_EXPECT_TWINS(run, gloss, {.absolute = 1e-6});
  // As in its own twin, but the quotient of the indices has an error too: 110 ulp, and next to the angle where all is
  // reflected 2e-6. Beyond: closer to that angle, where the slope of the root is infinite.
  NEPHROID_EXPECT_TWINS(run, fresnel, {.absolute = 2e-6, .relative = 1.5e-5, .beyond = 600});
  // The dielectric's is given, so it is the conductor's: 103 ulp.
  NEPHROID_EXPECT_TWINS(run, reflectance, {.relative = 1.5e-5});
  // A pane's quotient, a product, a difference from 1 and two products: 7 ulp of 1 a channel. Its zero beyond the
  // critical angle is exact.
  NEPHROID_EXPECT_TWINS(run, transmittance, {.absolute = 1e-6});
  // Two differences from 1 and a product: 4.5 ulp.
  NEPHROID_EXPECT_TWINS(run, base_weight, {.relative = 6e-7});
  // That, a product, and a quotient by 1 − g<F>, of which 0.4 is left: 12 ulp.
  NEPHROID_EXPECT_TWINS(run, base_scale, {.relative = 1.5e-6});
  // Two products and a difference from 1: 3 ulp of 1 a channel.
  NEPHROID_EXPECT_TWINS(run, base_factor, {.absolute = 6e-7});
  // Two of these, and a scale of up to 2.5/π: 17 ulp of 1.
  NEPHROID_EXPECT_TWINS(run, base, {.absolute = 2.5e-6});
  // The distribution (20 ulp) over a sum of stretches: 34 ulp.
  NEPHROID_EXPECT_TWINS(run, facets, {.relative = 5e-6});
  // The half vector has 13 ulp, and its fourth power is in the distribution: 85 ulp with the facets' own. The rest is
  // Fresnel's, 110 ulp and its change over the cosine. Beyond: half vectors at the critical angle, and pairs of
  // opposite directions along the surface, whose sum has a length of which the square is flushed.
  NEPHROID_EXPECT_TWINS(run, interface_value, {.absolute = 1e-6, .relative = 4e-5, .beyond = 200});
  // The same with the base, whose factor next to grazing incidence has the 110 ulp of F = 1. Beyond: the same, and one
  // direction at the critical angle.
  NEPHROID_EXPECT_TWINS(run, receiver, {.absolute = 5e-6, .relative = 4e-5, .beyond = 160});
}

}  // namespace
}  // namespace nephroid::testing
