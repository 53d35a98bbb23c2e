#include "tonemap_twin.shared.h"

#include <cmath>
#include <cstdint>
#include <vector>

#include "shaders/tests/gpu/twins/tonemap.comp.h"
#include "support/gpu_fixture.h"
#include "support/twin.h"
#include "support/twin_grids.h"

#include "support/tracked_begin.h"

#include "tonemap_twin.shared.h"

#include "support/tracked_end.h"

namespace nephroid::testing {
namespace {

class TonemapTwin : public GpuTest {};

TEST_F(TonemapTwin, GpuAgreesWithCpu) {
  std::vector<TonemapInput> inputs;
  // Both sides of each seam, and far beyond the clamp.
  for (const float value : {0.0F, 1e-30F, 0.0031307F, 0.0031309F, 0.04044F, 0.04046F, 1.0F, 1e4F, 1e20F, 3e38F})
    inputs.push_back({value});
  for (std::uint32_t i = 1; i <= 1000; ++i) inputs.push_back({static_cast<float>(i) * 0.004F});
  const TwinRun run(device(), shaders::tonemap_comp, inputs, evaluateTonemap, tracked::evaluateTonemap);
  // All in [0, 1], so absolute. A power may be off by 16 ulp of its exponent: 5e-6 where the curve is steepest.
  NEPHROID_EXPECT_TWINS(run, filmic, {.absolute = 3e-6});
  NEPHROID_EXPECT_TWINS(run, coded, {.absolute = 5e-6});
  NEPHROID_EXPECT_TWINS(run, decoded, {.absolute = 5e-6});
}

TEST_F(TonemapTwin, RankIsWhatTheQuantileSays) {
  for (std::uint32_t n = 1; n < 5000; ++n) ASSERT_EQ(highlightRank(n), (99 * n + 99) / 100) << n;
}

}  // namespace
}  // namespace nephroid::testing
