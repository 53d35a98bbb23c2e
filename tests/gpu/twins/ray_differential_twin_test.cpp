#include "ray_differential_twin.shared.h"

#include <cmath>
#include <vector>

#include "shaders/tests/gpu/twins/ray_differential.comp.h"
#include "support/gpu_fixture.h"
#include "support/twin.h"
#include "support/twin_grids.h"

#include "support/tracked_begin.h"

#include "ray_differential_twin.shared.h"

#include "support/tracked_end.h"

namespace nephroid::testing {
namespace {

class RayDifferentialTwin : public GpuTest {};

std::vector<RayDifferentialInput> rayDifferentialInputs() {
  const std::vector<glm::vec3> all = directions(30);
  struct Triangle {
    glm::vec3 p0, p1, p2;
  };
  // Right, oblique, thin, and three without area: two corners in one, all corners on a line, all in one.
  const std::vector<Triangle> triangles{
      {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}},        {{1, 2, 3}, {-1, 0.5F, 2}, {0.25F, 4, -1}},
      {{0, 0, 0}, {1, 0, 0}, {0.5F, 0.05F, 0}}, {{1, 1, 1}, {2, 0, 1}, {2, 0, 1}},
      {{0, 0, 0}, {1, 1, 1}, {2, 2, 2}},        {{3, 3, 3}, {3, 3, 3}, {3, 3, 3}}};
  const std::vector<float> ratios{1e-2F, 1.0F / 1.5F, nextTo(1.0F, 0.0F), 1.0F, nextTo(1.0F, 2.0F), 1.0001F,
                                  1.5F,  2.42F};
  std::vector<RayDifferentialInput> inputs;
  std::size_t i = 0;
  for (const glm::vec3& dir : all)
    for (const glm::vec3& n : all) {
      if (glm::dot(dir, n) > 0.0F) continue;
      const auto pick = [&](std::size_t step) { return all[(step * i + step) % all.size()]; };
      const Triangle& triangle = triangles[i % triangles.size()];
      const float scale = i % 5 == 0 ? 0.0F : 0.01F;
      inputs.push_back({.dp_dx = pick(3),
                        .dp_dy = pick(5) * scale,
                        .dd_dx = glm::cross(dir, pick(7)) * scale,
                        .dd_dy = glm::cross(dir, pick(11)),
                        .dir = dir,
                        .n = n,
                        .dn_dx = glm::cross(n, pick(13)),
                        .dn_dy = glm::cross(n, pick(17)) * scale,
                        .path_length = i % 7 == 0 ? 0.0F : std::ldexp(1.0F, static_cast<int>(i % 41) - 20),
                        .ior_ratio = ratios[i % ratios.size()],
                        .p0 = triangle.p0,
                        .p1 = triangle.p1,
                        .p2 = triangle.p2,
                        .n0 = n,
                        .n1 = glm::normalize(n + 0.1F * pick(19)),
                        .n2 = glm::normalize(n + 0.1F * pick(23)),
                        .barycentrics = i % 3 == 0 ? glm::vec3(1, 0, 0) : glm::vec3(0.25F, 0.25F, 0.5F)});
      ++i;
    }
  return inputs;
}

TEST_F(RayDifferentialTwin, GpuAgreesWithCpu) {
  const TwinRun run(device(), shaders::ray_differential_comp, rayDifferentialInputs(), evaluateRayDifferential,
                    tracked::evaluateRayDifferential);
  // Derivatives of at most 1 over vectors of at least 1: a normalisation and a quotient, 19 ulp.
  NEPHROID_EXPECT_TWINS(run, normalized_change, {.absolute = 2.5e-6});
  // The shift along the ray may be larger than what is left of it, by the inverse cosine. Beyond: flights along the
  // plane.
  NEPHROID_EXPECT_TWINS(run, transferred_x, {.absolute = 1e-5, .relative = 1e-5, .beyond = 50});
  NEPHROID_EXPECT_TWINS(run, transferred_y, {.absolute = 1e-5, .relative = 1e-5, .beyond = 50});
  // Whether a direction in the plane is one exactly.
  NEPHROID_EXPECT_TWINS(run, transfer_valid, {.beyond = 30});
  // Two dot products that add up to values of at most 4: 28 ulp of 1.
  NEPHROID_EXPECT_TWINS(run, reflected_x, {.absolute = 4e-6});
  NEPHROID_EXPECT_TWINS(run, reflected_y, {.absolute = 4e-6});
  // The same over the refracted cosine. Beyond: next to the critical angle, where that is 0.
  NEPHROID_EXPECT_TWINS(run, refracted_x, {.absolute = 2e-5, .beyond = 15});
  NEPHROID_EXPECT_TWINS(run, refracted_y, {.absolute = 2e-5, .beyond = 15});
  // At the critical angle rounding decides.
  NEPHROID_EXPECT_TWINS(run, refraction_valid, {.beyond = 2});
  // The height is a difference from the edge: of the thin triangle a tenth is left of it. 10 ulp tenfold. Beyond:
  // corners on a line, whose height is 0 only if a quotient has no error.
  NEPHROID_EXPECT_TWINS(run, gradient, {.relative = 2e-5, .beyond = 280});
  // That gradient (of 20/m) times a change of the point, of 1 cm in the y and 1 m in the x. Beyond: triangles without
  // area.
  NEPHROID_EXPECT_TWINS(run, triangle_normal_change, {.absolute = 1e-5, .beyond = 560});
  NEPHROID_EXPECT_TWINS(run, triangle_normal_x, {.absolute = 7e-4, .beyond = 560});
  NEPHROID_EXPECT_TWINS(run, triangle_normal_y, {.absolute = 1e-5, .beyond = 560});
}

}  // namespace
}  // namespace nephroid::testing
