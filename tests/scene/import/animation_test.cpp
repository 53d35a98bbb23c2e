#include <gtest/gtest.h>

#include <cmath>

#include "nephroid/error.h"
#include "scene/import/gltf_animation.h"
#include "support/gltf_builder.h"

namespace nephroid::gltf {
namespace {

using testing_support::GltfBuilder;

Curve makeCurve(Interpolation interpolation, std::vector<vec4> values) {
  return {interpolation, false, {1.0F, 3.0F}, std::move(values)};
}

TEST(SampleCurve, InterpolatesLinearlyAndHoldsItsEnds) {
  const Curve curve = makeCurve(Interpolation::kLinear, {vec4(0), vec4(4)});
  EXPECT_EQ(sampleCurve(curve, 0.0F).x, 0.0F);
  EXPECT_EQ(sampleCurve(curve, 1.5F).x, 1.0F);
  EXPECT_EQ(sampleCurve(curve, 3.0F).x, 4.0F);
  EXPECT_EQ(sampleCurve(curve, 9.0F).x, 4.0F);
}

TEST(SampleCurve, StepsAtTheNextKey) {
  const Curve curve = makeCurve(Interpolation::kStep, {vec4(0), vec4(4)});
  EXPECT_EQ(sampleCurve(curve, 2.999F).x, 0.0F);
  EXPECT_EQ(sampleCurve(curve, 3.0F).x, 4.0F);
}

/// A Hermite spline reproduces every cubic from its values and slopes: f(t) = t³ on [1, 3], slopes 3t².
TEST(SampleCurve, ReproducesACubicFromItsSlopes) {
  const Curve curve = makeCurve(Interpolation::kCubicSpline, {vec4(0), vec4(1), vec4(3), vec4(27), vec4(27), vec4(0)});
  for (const float t : {1.0F, 1.3F, 2.0F, 2.9F}) EXPECT_NEAR(sampleCurve(curve, t).x, t * t * t, 1e-4F) << t;
}

/// Half of a quarter turn is an eighth turn, along the shorter way also where one quaternion is negated.
TEST(SampleCurve, RotatesAlongTheShorterWay) {
  const float h = std::sqrt(0.5F);
  for (const float sign : {1.0F, -1.0F}) {
    Curve curve = makeCurve(Interpolation::kLinear, {vec4(0, 0, 0, 1), sign * vec4(0, h, 0, h)});
    curve.is_rotation = true;
    const vec4 middle = sampleCurve(curve, 2.0F);
    EXPECT_NEAR(std::abs(middle.y), std::sin(kPi / 8), 1e-6F);
    EXPECT_NEAR(std::abs(middle.w), std::cos(kPi / 8), 1e-6F);
  }
}

/// A triangle that moves from x = 0 to x = 2 in a second.
void addMovingTriangle(GltfBuilder& builder) {
  const int node = builder.addNode({{"mesh", builder.addTriangleMesh()}});
  const int times = builder.addFloats({0, 1});
  const int values = builder.addVec3({{0, 0, 0}, {2, 0, 0}});
  builder.append("animations",
                 {{"samplers", {{{"input", times}, {"output", values}}}},
                  {"channels", {{{"sampler", 0}, {"target", {{"node", node}, {"path", "translation"}}}}}}});
}

TEST(NodeAnimation, MovesTheInstanceAndGivesTheDuration) {
  GltfBuilder builder;
  addMovingTriangle(builder);
  const SceneData scene = builder.load(0.25F);
  EXPECT_FLOAT_EQ(scene.instances.at(0).world_from_object[3].x, 0.5F);
  EXPECT_FLOAT_EQ(scene.duration, 1.0F);
}

TEST(NodeAnimation, RefusesKeysThatRunBackwards) {
  GltfBuilder builder;
  addMovingTriangle(builder);
  const int times = builder.addFloats({1, 0});
  builder.root["animations"][0]["samplers"][0]["input"] = times;
  EXPECT_THROW(builder.load(), InputError);
}

TEST(NodeAnimation, RefusesFewerValuesThanKeys) {
  GltfBuilder builder;
  addMovingTriangle(builder);
  builder.root["animations"][0]["samplers"][0]["interpolation"] = "CUBICSPLINE";
  EXPECT_THROW(builder.load(), InputError);
}

}  // namespace
}  // namespace nephroid::gltf
