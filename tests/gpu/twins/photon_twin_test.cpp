#include "photon_twin.shared.h"

#include <array>
#include <cstdint>
#include <vector>

#include "shaders/tests/gpu/twins/photon.comp.h"
#include "support/gpu_fixture.h"
#include "support/twin.h"
#include "support/twin_grids.h"

#include "support/tracked_begin.h"

#include "photon_twin.shared.h"

#include "support/tracked_end.h"

namespace nephroid::testing {
namespace {

class PhotonTwin : public GpuTest {};

/// @param size  of the footprints
std::vector<PhotonInput> photonInputs(float size) {
  const std::vector<glm::vec3> all = directions(60);
  // Half-axes: a circle, ellipses along and across, skewed, mirrored, thin ones, a line, a point.
  const std::vector<std::array<glm::vec3, 2>> footprints{{{{1, 0, 0}, {0, 1, 0}}},
                                                         {{{2, 0, 0}, {0, 1, 0}}},
                                                         {{{0, 2, 0}, {-0.5F, 0, 0}}},
                                                         {{{1, 1, 0}, {-1, 2, 0.5F}}},
                                                         {{{1, 0.3F, 2}, {0.2F, -1, 1}}},
                                                         {{{1, 0, 1}, {1, 1e-4F, 1}}},
                                                         {{{3, 1, 2}, {3, 1, 2.001F}}},
                                                         {{{1, 2, 3}, {-2, -4, -6}}},
                                                         {{{1, 2, 3}, {0, 0, 0}}},
                                                         {{{0, 0, 0}, {0, 0, 0}}},
                                                         {{{1, 2, 0}, {1e-6F, 2e-6F, 7e-6F}}},
                                                         {{{0.5F, 0.25F, -1}, {1, -0.5F, 0.125F}}}};
  std::vector<PhotonInput> inputs;
  std::size_t i = 0;
  for (const auto& [a, b] : footprints)
    for (const glm::vec3& n : all) {
      const std::uint32_t bits = mixBits(static_cast<std::uint32_t>(i));
      inputs.push_back({size * a, size * b, n, all[(5 * i + 2) % all.size()], static_cast<float>(bits >> 16),
                        static_cast<float>(bits & 0xFFFFU), static_cast<float>(i % 256)});
      ++i;
    }
  // Corners, edges and folds of the octahedron's square; −32768 has no counterpart and must act as −32767.
  const std::vector<float> codes{0, 1, 2, 16383, 16384, 32766, 32767, 32768, 32769, 49152, 65534, 65535};
  for (const float upper : codes)
    for (const float lower : codes) {
      PhotonInput input = inputs[i++ % inputs.size()];
      input.upper = upper;
      input.lower = lower;
      inputs.push_back(input);
    }
  return inputs;
}

TEST_F(PhotonTwin, GpuAgreesWithCpu) {
  const TwinRun run(device(), shaders::photon_comp, photonInputs(1.0F), evaluatePhoton, tracked::evaluatePhoton);
  // Integers are exact.
  NEPHROID_EXPECT_TWINS(run, light_band_flags, {});
  NEPHROID_EXPECT_TWINS(run, light, {});
  NEPHROID_EXPECT_TWINS(run, band, {});
  NEPHROID_EXPECT_TWINS(run, flags, {});
  NEPHROID_EXPECT_TWINS(run, has_flag, {});
  NEPHROID_EXPECT_TWINS(run, mixed, {});
  NEPHROID_EXPECT_TWINS(run, chain, {});
  // Beyond: coordinates of ½, as diagonals have, tie between two codes.
  NEPHROID_EXPECT_TWINS(run, packed_unit, {.beyond = 60});
  // Two quotients of 4 ulp, folded sums of them, and division by a length that is at least 1/√3: 62 ulp.
  NEPHROID_EXPECT_TWINS(run, unpacked_unit, {.absolute = 8e-6});
  // One normalisation of an exact vector: 12 ulp.
  NEPHROID_EXPECT_TWINS(run, perpendicular, {.absolute = 1.5e-6});
  // Products, a length, a root and a quotient of it: 20 ulp.
  NEPHROID_EXPECT_TWINS(run, major_direction, {.absolute = 2.5e-6});
  NEPHROID_EXPECT_TWINS(run, footprint_flags, {});
  // The half-axes projected on a frame, 20 ulp each, give a direction whose error grows as |a|·|b|/(|a|² − |b|²), up to
  // a hundred times here. The lengths inherit it in the bound, not in truth: there they are stationary. Beyond:
  // circles, which have no longer axis.
  NEPHROID_EXPECT_TWINS(run, footprint_major, {.relative = 2e-4, .beyond = 10});
  NEPHROID_EXPECT_TWINS(run, footprint_minor, {.absolute = 2e-4, .beyond = 10});
  // Each code that the direction's error reaches is right, and nearly always it reaches one more. What that amounts to
  // the axes say: a step, 3e-5 rad and up to twice that where the octahedron is stretched, on half-axes of up to 5 m,
  // and the error of the lengths.
  NEPHROID_EXPECT_TWINS(run, footprint_orientation, {.beyond = run.inputs().size()});
  NEPHROID_EXPECT_TWINS(run, footprint_axis_a, {.absolute = 1e-3, .beyond = 15});
  NEPHROID_EXPECT_TWINS(run, footprint_axis_b, {.absolute = 1e-3, .beyond = 15});
}

TEST_F(PhotonTwin, GpuAgreesWithCpuOnFootprintsOfAnySize) {
  for (const float size : {1e-9F, 1e6F}) {
    SCOPED_TRACE(size);
    const TwinRun run(device(), shaders::photon_comp, photonInputs(size), evaluatePhoton, tracked::evaluatePhoton);
    // As above, in units of the size: an ellipse is scaled to 1 before anything is squared.
    NEPHROID_EXPECT_TWINS(run, footprint_major, {.relative = 2e-4, .beyond = 10});
    NEPHROID_EXPECT_TWINS(run, footprint_minor, {.absolute = 2e-4 * size, .beyond = 10});
    NEPHROID_EXPECT_TWINS(run, footprint_axis_a, {.absolute = 1e-3 * size, .beyond = 15});
    NEPHROID_EXPECT_TWINS(run, footprint_axis_b, {.absolute = 1e-3 * size, .beyond = 15});
  }
}

}  // namespace
}  // namespace nephroid::testing
