#include "lights_twin.shared.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include "core/optics/photon.shared.h"
#include "shaders/tests/gpu/twins/lights.comp.h"
#include "support/gpu_fixture.h"
#include "support/twin.h"
#include "support/twin_grids.h"

#include "support/tracked_begin.h"

#include "lights_twin.shared.h"

#include "support/tracked_end.h"

namespace nephroid::testing {
namespace {

class LightsTwin : public GpuTest {};

struct Cones {
  float cos_inner, cos_outer;
};

/// Spots seen from inside, from outside and from both sides of their two edges.
std::vector<LightsInput> spots(const std::vector<Cones>& all_cones) {
  const std::vector<glm::vec3> intensities{{1, 1, 1}, {1, 0.5F, 0}, {0, 0, 0}, {0.9F, 0.3F, 1e-6F}};
  const std::vector<float> distances_squared{1e-12F, 1e-4F, 0.3F, 1.0F, 7.0F, 1e10F}, theta = cosines(16);
  std::vector<LightsInput> inputs;
  std::size_t i = 0;
  for (const auto& [cos_inner, cos_outer] : all_cones) {
    std::vector<float> angles = cosines(8);
    angles.push_back(-1.0F);
    for (const float edge : {cos_inner, cos_outer})
      for (const float c : {edge - 1e-3F, edge - 1e-6F, nextTo(edge, -2.0F), edge, nextTo(edge, 2.0F), edge + 1e-6F,
                            edge + 1e-3F, 0.5F * (cos_inner + cos_outer)})
        angles.push_back(c);
    for (const glm::vec3& axis : directions(8))
      for (const float c : angles) {
        // About the axis at that angle; rounding spreads them a little over both sides of an edge.
        const float cos_angle = std::clamp(c, -1.0F, 1.0F);
        const float sin_angle = std::sqrt((1.0F - cos_angle) * (1.0F + cos_angle));
        inputs.push_back({.intensity = intensities[i % intensities.size()],
                          .axis = axis,
                          .dir = glm::normalize(axis * cos_angle + perpendicularTo(axis) * sin_angle),
                          .cos_angle = c,
                          .cos_inner = cos_inner,
                          .cos_outer = cos_outer,
                          .distance_squared = distances_squared[i / 3 % distances_squared.size()],
                          .cos_theta_i = theta[i % theta.size()]});
        ++i;
      }
  }
  return inputs;
}

TEST_F(LightsTwin, GpuAgreesWithCpu) {
  // From a narrow cone to the widest that glTF has, and all directions.
  const std::vector<LightsInput> inputs =
      spots({{0.9F, 0.5F}, {1.0F, 0.6F}, {1.0F, std::cos(0.5F * std::acos(-1.0F))}, {0.8F, 0.0F}, {1.0F, -1.0F}});
  const TwinRun run(device(), shaders::lights_comp, inputs, evaluateLights, tracked::evaluateLights);
  // Two differences and their quotient, squared: 13.5 ulp.
  NEPHROID_EXPECT_TWINS(run, falloff, {.relative = 1.7e-6});
  // A dot product of unit vectors, 5 ulp of 1, over cones whose cosines are at least 0.4 apart, counts twice in the
  // square: 35 ulp of 1 a channel.
  NEPHROID_EXPECT_TWINS(run, spot, {.absolute = 8e-6});
  // A product and a quotient: 4.5 ulp; a product: 1.5 ulp.
  NEPHROID_EXPECT_TWINS(run, from_point, {.relative = 6e-7});
  NEPHROID_EXPECT_TWINS(run, from_sun, {.relative = 2e-7});
  // A sum of squares, its root and a quotient: 20 ulp.
  NEPHROID_EXPECT_TWINS(run, solid_angle, {.relative = 3e-6});
}

TEST_F(LightsTwin, GpuAgreesWithCpuOnHardEdges) {
  const float edge = std::cos(0.3F);
  const std::vector<LightsInput> inputs = spots({{edge, edge},
                                                 {edge, nextTo(edge, 0.0F)},
                                                 {edge, edge - 1e-7F},
                                                 {edge, edge - 1e-5F},
                                                 {1.0F, 1.0F},
                                                 {1.0F, nextTo(1.0F, 0.0F)},
                                                 {0.0F, 0.0F}});
  const TwinRun run(device(), shaders::lights_comp, inputs, evaluateLights, tracked::evaluateLights);
  // Differences of numbers so close are exact, so a quotient and a square: 7.5 ulp.
  NEPHROID_EXPECT_TWINS(run, falloff, {.relative = 1e-6});
  // None or all of the intensity. Beyond: wherever the error of the dot product reaches an edge.
  NEPHROID_EXPECT_TWINS(run, spot, {.absolute = 8e-6, .beyond = 1600});
}

}  // namespace
}  // namespace nephroid::testing
