#include "dispersion_twin.shared.h"

#include <vector>

#include "shaders/tests/gpu/twins/dispersion.comp.h"
#include "support/gpu_fixture.h"
#include "support/twin.h"
#include "support/twin_grids.h"

#include "support/tracked_begin.h"

#include "dispersion_twin.shared.h"

#include "support/tracked_end.h"

namespace nephroid::testing {
namespace {

class DispersionTwin : public GpuTest {};

TEST_F(DispersionTwin, GpuAgreesWithCpu) {
  std::vector<DispersionInput> inputs;
  for (const float ior : {1.0F, nextTo(1.0F, 2.0F), 1.0003F, 1.33F, 1.5F, 1.7F, 2.42F, 4.0F})
    for (const float dispersion : {0.0F, 1e-6F, 0.1F, 20.0F / 64.17F, 0.5F, 1.0F, 2.0F, 20.0F})
      for (const float wavelength_nm :
           {1.0F, 100.0F, 360.0F, 400.0F, 486.1F, 550.0F, 587.55F, 587.6F, 656.3F, 700.0F, 830.0F, 1e4F, 1e9F})
        inputs.push_back({ior, dispersion, wavelength_nm});
  const TwinRun run(device(), shaders::dispersion_comp, inputs, evaluateDispersion, tracked::evaluateDispersion);
  // A sum of few terms: 3 ulp in the visible. Near 1 nm it is all in the product of four factors: 15 ulp.
  NEPHROID_EXPECT_TWINS(run, ior, {.relative = 2e-6});
}

}  // namespace
}  // namespace nephroid::testing
