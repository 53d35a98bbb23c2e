#include "scene/sky.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "nephroid/error.h"
#include "scene/edit.h"

namespace nephroid {
namespace {

/// Irradiance on a plane with the given normal, by summing texels as the reader of the image would.
double integrateIrradiance(const Image& image, dvec3 normal) {
  double sum = 0;
  const double pi = std::numbers::pi;
  for (int y = 0; y < image.height; ++y)
    for (int x = 0; x < image.width; ++x) {
      const double theta = pi * (y + 0.5) / image.height, phi = 2 * pi * ((x + 0.5) / image.width - 0.5);
      const dvec3 dir(std::sin(phi) * std::sin(theta), std::cos(theta), -std::cos(phi) * std::sin(theta));
      const double solid_angle = 2 * pi / image.width * (pi / image.height) * std::sin(theta);
      const vec3 radiance = image.rgb(x, y);
      sum += std::max(0.0, glm::dot(dir, normal)) * solid_angle * (radiance.x + radiance.y + radiance.z) / 3;
    }
  return sum;
}

TEST(Sky, GivesTheHorizontalIrradianceAskedFor) {
  for (const float turbidity : {2.0F, 3.0F, 6.0F, 10.0F})
    for (const float elevation : {0.0F, 10.0F, 45.0F, 90.0F}) {
      const Image sky =
          renderSky({.turbidity = turbidity, .elevation_deg = elevation, .azimuth_deg = 33, .irradiance = 7}, 256, 128);
      EXPECT_NEAR(integrateIrradiance(sky, {0, 1, 0}), 7.0, 0.07) << turbidity << " " << elevation;
    }
}

TEST(Sky, IsFiniteAndPositiveAboveTheHorizon) {
  const Image sky = renderSky({.turbidity = 2, .elevation_deg = 5}, 128, 64);
  for (int y = 0; y < sky.height; ++y)
    for (int x = 0; x < sky.width; ++x) {
      ASSERT_TRUE(isFinite(sky.rgb(x, y)));
      ASSERT_GE(minComponent(sky.rgb(x, y)), 0.0F);
      ASSERT_GT(maxComponent(sky.rgb(x, y)), 0.0F);
    }
}

// Ground of albedo 0.2 under irradiance E has the radiance 0.2 E / pi.
TEST(Sky, HasConstantGroundBelowTheHorizon) {
  const Image sky = renderSky({.irradiance = 2}, 64, 32);
  for (int y = 16; y < 32; ++y) EXPECT_NEAR(sky.rgb(5, y).y, 0.4F / kPi, 1e-6F);
}

TEST(Sky, IsBrightestTowardsTheSun) {
  // Azimuth 90 is +X, which the layout puts at u = 0.75; elevation 30 is at v = 1/3.
  const Image sky = renderSky({.elevation_deg = 30, .azimuth_deg = 90}, 360, 180);
  int best_x = 0, best_y = 0;
  float best = 0;
  for (int y = 0; y < 90; ++y)
    for (int x = 0; x < 360; ++x)
      if (luminance(sky.rgb(x, y)) > best) best = luminance(sky.rgb(x, y)), best_x = x, best_y = y;
  EXPECT_NEAR(best_x, 270, 2);
  EXPECT_NEAR(best_y, 60, 4);
}

TEST(Sky, IsBlueAwayFromTheSun) {
  const Image sky = renderSky({.turbidity = 2, .elevation_deg = 45, .azimuth_deg = 0}, 64, 32);
  const vec3 opposite = sky.rgb(32, 8);  // azimuth 180 (−Z), elevation 45
  EXPECT_GT(opposite.z, 1.3F * opposite.x);
}

TEST(Environment, SkyIsChosenByNameWithItsSettings) {
  const Environment sky = loadEnvironment("sky:irradiance=3,elevation=60,turbidity=4", 30, 2);
  EXPECT_NEAR(integrateIrradiance(*sky.radiance, {0, 1, 0}), 3.0, 0.03);
  EXPECT_EQ(sky.rotation_deg, 30.0F);
  EXPECT_EQ(sky.scale, 2.0F);
  EXPECT_EQ(sky.radiance->width, 512);
  EXPECT_NEAR(integrateIrradiance(*loadEnvironment("sky", 0, 1).radiance, {0, 1, 0}), 1.5, 0.015);
}

TEST(Environment, RefusesSettingsThatTheSkyDoesNotHave) {
  EXPECT_THROW(loadEnvironment("sky:cloud=1", 0, 1), UsageError);
  EXPECT_THROW(loadEnvironment("sky:turbidity=99", 0, 1), UsageError);
  EXPECT_THROW(loadEnvironment("sky", 0, -1), UsageError);
}

TEST(Environment, MissingPictureIsBadInput) { EXPECT_THROW(loadEnvironment("/nowhere/at-all.exr", 0, 1), InputError); }

}  // namespace
}  // namespace nephroid
