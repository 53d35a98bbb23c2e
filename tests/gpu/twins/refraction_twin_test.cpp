#include "refraction_twin.shared.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include "shaders/tests/gpu/twins/refraction.comp.h"
#include "support/gpu_fixture.h"
#include "support/twin.h"
#include "support/twin_grids.h"

#include "support/tracked_begin.h"

#include "refraction_twin.shared.h"

#include "support/tracked_end.h"

namespace nephroid::testing {
namespace {

class RefractionTwin : public GpuTest {};

std::vector<RefractionInput> refractionInputs() {
  const std::vector<glm::vec3> all = directions(30);
  std::vector<RefractionInput> inputs;
  for (const float ratio : {1e-3F, 0.4F, 1.0F / 1.5F, 0.9999F, nextTo(1.0F, 0.0F), 1.0F, nextTo(1.0F, 2.0F), 1.0001F,
                            1.33F, 1.5F, 2.42F, 1e3F}) {
    for (const glm::vec3& dir : all)
      for (const glm::vec3& n : all)
        if (glm::dot(dir, n) <= 0.0F) inputs.push_back({dir, n, ratio});
    if (ratio <= 1.0F) continue;
    // Just within and just beyond the critical angle, where the refracted ray leaves along the interface.
    for (const float factor : {0.99F, 0.9999F, nextTo(1.0F, 0.0F), 1.0F, nextTo(1.0F, 2.0F), 1.0001F, 1.01F}) {
      const float sin_theta = std::min(factor / ratio, 1.0F);
      inputs.push_back({{sin_theta, -std::sqrt((1.0F - sin_theta) * (1.0F + sin_theta)), 0.0F}, {0, 1, 0}, ratio});
    }
  }
  return inputs;
}

TEST_F(RefractionTwin, GpuAgreesWithCpu) {
  const TwinRun run(device(), shaders::refraction_comp, refractionInputs(), evaluateRefraction,
                    tracked::evaluateRefraction);
  // A dot product and a difference of vectors of at most 2: 16 ulp of 1.
  NEPHROID_EXPECT_TWINS(run, reflected, {.absolute = 2e-6});
  // A root, a quotient and a normalisation, over the refracted cosine. Beyond: next to the critical angle, where that
  // is 0.
  NEPHROID_EXPECT_TWINS(run, refracted, {.absolute = 1e-5, .beyond = 200});
  // At the critical angle rounding decides; the bound does not see that with ratio 1 it cannot.
  NEPHROID_EXPECT_TWINS(run, valid, {.beyond = 60});
}

}  // namespace
}  // namespace nephroid::testing
