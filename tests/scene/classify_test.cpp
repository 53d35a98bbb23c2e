#include "scene/classify.h"

#include <gtest/gtest.h>

namespace nephroid {
namespace {

Material makeGlass() {
  Material m;
  m.roughness = 0;
  m.transmission = 1;
  m.thickness = 1;
  return m;
}

TEST(Classify, MirrorIsAGeneratorAndNoReceiver) {
  Material m;
  m.metallic = 1;
  m.roughness = 0;
  m.base_color = vec4(0.5F, 0.5F, 0.5F, 1);
  const Classification c = classify(m);
  EXPECT_TRUE(c.is_generator);
  EXPECT_FALSE(c.is_receiver);
  EXPECT_FLOAT_EQ(c.specular_albedo, 0.5F);
}

TEST(Classify, DarkMetalIsOnlyAWeakGenerator) {
  Material m;
  m.metallic = 1;
  m.roughness = 0;
  m.base_color = vec4(0.09F, 0.09F, 0.09F, 1);
  EXPECT_FALSE(classify(m).is_generator);
  EXPECT_TRUE(classify(m).is_weak_generator);
}

// ((1.5 − 1)/(1.5 + 1))² = 0.04 is reflected, 0.96 transmitted.
TEST(Classify, SolidGlassIsAGeneratorByItsTransmission) {
  const Classification c = classify(makeGlass());
  EXPECT_TRUE(c.is_generator);
  EXPECT_FALSE(c.is_receiver);
  EXPECT_NEAR(c.specular_albedo, 0.04F, 1e-6F);
  EXPECT_NEAR(c.specular_transmission, 0.96F, 1e-6F);
}

// Both faces: R' = 2R/(1 + R) = 0.08/1.04.
TEST(Classify, SmoothPaneTransmitsWithoutAnEvent) {
  Material m = makeGlass();
  m.thickness = 0;
  const Classification c = classify(m);
  EXPECT_FALSE(c.is_generator);
  EXPECT_TRUE(c.is_weak_generator);
  EXPECT_FALSE(c.is_receiver);
  EXPECT_EQ(c.specular_transmission, 0.0F);
  EXPECT_NEAR(c.specular_albedo, 0.08F / 1.04F, 1e-6F);
}

TEST(Classify, RoughnessAtTheBoundIsDiffuse) {
  Material m = makeGlass();
  m.roughness = 0.5F;  // alpha = 0.25, the bound itself: S is strictly below it
  EXPECT_FALSE(classify(m).is_generator);
  EXPECT_TRUE(classify(m).is_receiver);
  m.roughness = 0.49F;
  EXPECT_TRUE(classify(m).is_generator);
  EXPECT_FALSE(classify(m).is_receiver);
  EXPECT_FALSE(classify(m, 0.2F).is_generator);
}

TEST(Classify, RoughDielectricIsLambertian) {
  Material m;
  m.base_color = vec4(0.6F, 0.6F, 0.6F, 1);
  const Classification c = classify(m);
  EXPECT_TRUE(c.is_receiver);
  EXPECT_FALSE(c.is_generator);
  EXPECT_FALSE(c.is_weak_generator);
  EXPECT_FLOAT_EQ(c.diffuse_albedo, 0.6F);
  EXPECT_EQ(c.specular_albedo, 0.0F);
}

TEST(Classify, VarnishIsAWeakGeneratorAndAReceiver) {
  Material m;
  m.roughness = 0;
  m.base_color = vec4(0.5F, 0.5F, 0.5F, 1);
  const Classification c = classify(m);
  EXPECT_FALSE(c.is_generator);
  EXPECT_TRUE(c.is_weak_generator);
  EXPECT_TRUE(c.is_receiver);
  EXPECT_NEAR(c.specular_albedo, 0.04F, 1e-6F);
  EXPECT_NEAR(c.diffuse_albedo, 0.5F * 0.96F, 1e-6F);
}

TEST(Classify, HalfTransmissiveSurfaceIsBoth) {
  Material m = makeGlass();
  m.transmission = 0.5F;
  EXPECT_TRUE(classify(m).is_generator);
  EXPECT_TRUE(classify(m).is_receiver);
}

TEST(Classify, BlackRoughSurfaceIsNeither) {
  Material m;
  m.base_color = vec4(0, 0, 0, 1);
  EXPECT_FALSE(classify(m).is_receiver);
  EXPECT_FALSE(classify(m).is_generator);
}

// Gold-like n = 0.2, k = 3: ((0.8)² + 9)/((1.2)² + 9) = 9.64/10.44.
TEST(Classify, ComplexIndexReplacesTheBaseColour) {
  Material m;
  m.metallic = 1;
  m.roughness = 0;
  m.base_color = vec4(0, 0, 0, 1);
  m.conductor_ior = vec3(0.2F);
  m.conductor_k = vec3(3.0F);
  EXPECT_NEAR(classify(m).specular_albedo, 9.64F / 10.44F, 1e-5F);
}

TEST(Classify, ReasonNamesTheDecidingNumbers) {
  Material m;
  m.metallic = 1;
  m.roughness = 0.2F;
  EXPECT_EQ(classify(m).reason, "metal, alpha 0.04 < 0.25, specular albedo 1 > 0.1");
}

}  // namespace
}  // namespace nephroid
