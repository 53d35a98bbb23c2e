#include "microfacet_twin.shared.h"

#include <vector>

#include "shaders/tests/gpu/twins/microfacet.comp.h"
#include "support/gpu_fixture.h"
#include "support/twin.h"
#include "support/twin_grids.h"

#include "support/tracked_begin.h"

#include "microfacet_twin.shared.h"

#include "support/tracked_end.h"

namespace nephroid::testing {
namespace {

class MicrofacetTwin : public GpuTest {};

std::vector<MicrofacetInput> microfacetInputs() {
  const std::vector<glm::vec3> all = directions(40);
  const float below_1 = nextTo(1.0F, 0.0F);
  // Four corners first.
  const std::vector<glm::vec2> us{{0.0F, 0.0F},   {0.0F, below_1}, {below_1, 0.0F}, {below_1, below_1}, {0.5F, 0.5F},
                                  {0.25F, 1e-7F}, {0.75F, 0.9F},   {0.1F, 0.99F},   {0.3F, 0.2F},       {0.6F, 0.7F}};
  std::vector<MicrofacetInput> inputs;
  std::size_t i = 0;
  for (const float alpha : {5e-4F, 1e-2F, 0.1F, 0.25F, 0.5F, 1.0F})
    for (const glm::vec3& wo : all)
      for (const glm::vec3& h : all) {
        if (wo.z < 0.0F) continue;
        const glm::vec3 wi = all[(7 * i + 3) % all.size()];
        inputs.push_back({wo, wi, h, alpha, us[4 + i++ % (us.size() - 4)]});
      }
  // Each u with each direction; a facet that no direction sees, because at alpha 0 there is no inverse; and no grazing
  // direction there, whose stretched length would be 0.
  for (const float alpha : {0.0F, 1e-6F, 0.1F, 1.0F})
    for (const glm::vec3& wo : all)
      for (const glm::vec2& u : us)
        if (wo.z > 0.0F || (wo.z == 0.0F && alpha > 0.0F)) inputs.push_back({wo, wo, {0.0F, 0.0F, -1.0F}, alpha, u});
  return inputs;
}

TEST_F(MicrofacetTwin, GpuAgreesWithCpu) {
  const TwinRun run(device(), shaders::microfacet_comp, microfacetInputs(), evaluateMicrofacet,
                    tracked::evaluateMicrofacet);
  // A square of a sum of squares, nothing cancels: 20 ulp.
  NEPHROID_EXPECT_TWINS(run, distribution, {.relative = 2.5e-6});
  // A root (5 ulp) of a sum of squares (half of 8 ulp).
  NEPHROID_EXPECT_TWINS(run, stretch, {.relative = 1.2e-6});
  // The stretch, sums and products of it, a quotient: 21 ulp. Infinite on both at grazing directions.
  NEPHROID_EXPECT_TWINS(run, lambda, {.relative = 3e-6});
  // The stretch and a quotient: 13.5 ulp; two of each: 17 ulp; two of the former multiplied: 29 ulp.
  NEPHROID_EXPECT_TWINS(run, g1, {.relative = 2e-6});
  NEPHROID_EXPECT_TWINS(run, g2, {.relative = 2.5e-6});
  NEPHROID_EXPECT_TWINS(run, g2_transmission, {.relative = 4e-6});
  // Sine and cosine are only good to 2⁻¹¹, and the sum of w and its mirror image is normalised: twice that where the
  // sum is 0.2 long. Beyond: u.y next to 1, where w and its image almost cancel.
  NEPHROID_EXPECT_TWINS(run, facet, {.absolute = 5e-3, .beyond = 290});
  // The distribution times dot(wo, h), whose own sum may cancel to a tenth. Beyond: facets that wo sees edge-on.
  NEPHROID_EXPECT_TWINS(run, pdf, {.relative = 1e-5, .beyond = 140});
  // atan is good to 4096 ulp of half a turn. Beyond: where the azimuth is 0 and may as well be a whole turn, and where
  // there is none, as GLSL has no atan(0, 0).
  NEPHROID_EXPECT_TWINS(run, inverse, {.absolute = 3e-4, .beyond = 120});
}

}  // namespace
}  // namespace nephroid::testing
