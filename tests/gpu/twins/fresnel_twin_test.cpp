#include "fresnel_twin.shared.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include "shaders/tests/gpu/twins/fresnel.comp.h"
#include "support/gpu_fixture.h"
#include "support/twin.h"
#include "support/twin_grids.h"

#include "support/tracked_begin.h"

#include "fresnel_twin.shared.h"

#include "support/tracked_end.h"

namespace nephroid::testing {
namespace {

class FresnelTwin : public GpuTest {};

std::vector<FresnelInput> dielectricsAndPanes() {
  std::vector<FresnelInput> inputs;
  for (const float ratio : {1e-3F, 0.4F, 1.0F / 1.5F, 0.75F, 0.9999F, nextTo(1.0F, 0.0F), 1.0F, nextTo(1.0F, 2.0F),
                            1.0001F, 1.33F, 1.5F, 2.42F, 1e3F}) {
    std::vector<float> cos_theta_i = cosines(64);
    // About the critical angle and Brewster's.
    const float critical = std::sqrt(std::max(1.0F - 1.0F / (ratio * ratio), 0.0F));
    const float brewster = ratio / std::sqrt(1.0F + ratio * ratio);
    for (const float turn : {critical, brewster})
      for (const float factor : {0.99F, nextTo(1.0F, 0.0F), 1.0F, nextTo(1.0F, 2.0F), 1.000001F, 1.01F})
        cos_theta_i.push_back(turn * factor);
    for (const float c : cos_theta_i)
      inputs.push_back(
          {c, ratio, {0.0F, 0.04F, 1.0F}, {1.0F, 1.0F, 1.0F}, {0.0F, 0.0F, 0.0F}, std::min(std::abs(c), 1.0F)});
  }
  return inputs;
}

std::vector<FresnelInput> conductors() {
  std::vector<FresnelInput> inputs;
  const std::vector<float> iors{1e-3F, 0.2F, 0.9F, 1.0F, nextTo(1.0F, 2.0F), 1.5F, 3.0F, 10.0F};
  for (const float ior : iors)
    for (const float k : {0.0F, 1e-6F, 1e-3F, 0.5F, 1.0F, 3.0F, 20.0F})
      for (const float c : cosines(32))
        inputs.push_back({c, 0.5F, {0.5F, 0.9F, 0.99F}, {ior, 0.5F * ior, 2.0F}, {k, k, 0.1F * k}, 0.5F});
  return inputs;
}

TEST_F(FresnelTwin, GpuAgreesWithCpu) {
  const TwinRun run(device(), shaders::fresnel_comp, dielectricsAndPanes(), evaluateFresnel, tracked::evaluateFresnel);
  // The amplitudes have 30 to 40 ulp from a root, a square and a quotient, and are squared: 80 ulp. Beyond: next to the
  // critical angle, where the slope of the root is infinite, and at grazing incidence with a ratio next to 1.
  NEPHROID_EXPECT_TWINS(run, dielectric, {.relative = 1e-5, .beyond = 55});
  // A fifth power: 13.5 ulp.
  NEPHROID_EXPECT_TWINS(run, schlick, {.relative = 2e-6});
  // A sum and a quotient: 4.5 ulp.
  NEPHROID_EXPECT_TWINS(run, pane, {.relative = 6e-7});
}

TEST_F(FresnelTwin, GpuAgreesWithCpuOnMetals) {
  const TwinRun run(device(), shaders::fresnel_comp, conductors(), evaluateFresnel, tracked::evaluateFresnel);
  // Three roots, then quotients of squares: 165 ulp at most. Beyond: k next to 0 at the critical angle of ior < 1,
  // where the complex root is 0.
  NEPHROID_EXPECT_TWINS(run, conductor, {.relative = 2e-5, .beyond = 30});
  NEPHROID_EXPECT_TWINS(run, conductor_channel, {.relative = 2e-5, .beyond = 30});
}

}  // namespace
}  // namespace nephroid::testing
