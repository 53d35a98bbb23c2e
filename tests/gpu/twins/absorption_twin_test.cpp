#include "absorption_twin.shared.h"

#include <limits>
#include <vector>

#include "shaders/tests/gpu/twins/absorption.comp.h"
#include "support/gpu_fixture.h"
#include "support/twin.h"
#include "support/twin_grids.h"

#include "support/tracked_begin.h"

#include "absorption_twin.shared.h"

#include "support/tracked_end.h"

namespace nephroid::testing {
namespace {

class AbsorptionTwin : public GpuTest {};

TEST_F(AbsorptionTwin, GpuAgreesWithCpu) {
  constexpr float kInfinite = std::numeric_limits<float>::infinity();
  const std::vector<float> values{0.0F,  1e-30F, 1e-6F, 1e-3F,  0.1F,   0.5F, 1.0F, 3.0F,  10.0F,
                                  30.0F, 87.0F,  88.0F, 100.0F, 104.0F, 1e3F, 1e6F, 1e30F, kInfinite};
  std::vector<AbsorptionInput> inputs;
  for (const float sigma_a : values)
    for (const float other : {0.0F, 0.7F, 20.0F, kInfinite})
      for (const float distance : values) inputs.push_back({{sigma_a, other, 0.5F * sigma_a}, distance});
  const TwinRun run(device(), shaders::absorption_comp, inputs, evaluateAbsorption, tracked::evaluateAbsorption);
  // A factor in [0, 1], so absolute. At optical depth d the product is off by 1.5 d ulp and exp by (4 + 2 d) ulp of
  // e^−d, which is most at d = 0: 4 ulp a channel, √3 times that for three.
  NEPHROID_EXPECT_TWINS(run, transmitted, {.absolute = 1e-6});
  NEPHROID_EXPECT_TWINS(run, channel, {.absolute = 5e-7});
}

}  // namespace
}  // namespace nephroid::testing
