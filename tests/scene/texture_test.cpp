#include "scene/texture.h"

#include <gtest/gtest.h>

namespace nephroid {
namespace {

/// Two by one texels: black, white.
TextureImage makeStep() {
  ByteImage image;
  image.width = 2, image.height = 1;
  image.pixels = {0, 0, 0, 255, 255, 255, 255, 255};
  return {"step", image};
}

TEST(SampleTexture, MeetsTexelCentresExactly) {
  TextureRef reference;
  EXPECT_EQ(sampleTexture(makeStep(), reference, vec2(0.25F, 0.5F), false).x, 0.0F);
  EXPECT_EQ(sampleTexture(makeStep(), reference, vec2(0.75F, 0.5F), false).x, 1.0F);
}

TEST(SampleTexture, InterpolatesBetweenCentresAfterDecoding) {
  TextureRef reference;
  EXPECT_NEAR(sampleTexture(makeStep(), reference, vec2(0.5F, 0.5F), true).x, 0.5F, 1e-6F);
}

TEST(SampleTexture, WrapModesDifferBeyondTheEdge) {
  TextureRef repeat, clamp, mirror;
  clamp.wrap_u = Wrap::kClamp;
  mirror.wrap_u = Wrap::kMirror;
  const vec2 beyond(1.25F, 0.5F);
  EXPECT_EQ(sampleTexture(makeStep(), repeat, beyond, false).x, 0.0F);
  EXPECT_EQ(sampleTexture(makeStep(), clamp, beyond, false).x, 1.0F);
  EXPECT_EQ(sampleTexture(makeStep(), mirror, beyond, false).x, 1.0F);
}

TEST(SampleTexture, TransformComesBeforeWrapping) {
  TextureRef reference;
  reference.uv_from_texcoord = mat3(1, 0, 0, 0, 1, 0, 0.5F, 0, 1);
  EXPECT_EQ(sampleTexture(makeStep(), reference, vec2(0.25F, 0.5F), false).x, 1.0F);
}

TEST(SampleTexture, SurvivesAbsurdCoordinates) {
  TextureRef reference;
  for (const float u : {1e30F, -1e30F, kInfinity, std::numeric_limits<float>::quiet_NaN()})
    EXPECT_TRUE(std::isfinite(sampleTexture(makeStep(), reference, vec2(u, u), true).x));
}

}  // namespace
}  // namespace nephroid
