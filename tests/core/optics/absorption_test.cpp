#include "core/optics/absorption.shared.h"

#include <gtest/gtest.h>

#include <cmath>

#include "core/math.h"

namespace nephroid {
namespace {

TEST(Transmittance, IsBeerLambert) {
  const vec3 t = transmittance(vec3(0.5F, 1.0F, 20.0F), 0.7F);
  EXPECT_FLOAT_EQ(t.x, static_cast<float>(std::exp(-0.35)));
  EXPECT_FLOAT_EQ(t.y, static_cast<float>(std::exp(-0.7)));
  EXPECT_FLOAT_EQ(t.z, static_cast<float>(std::exp(-14.0)));
}

TEST(Transmittance, IsExactlyOneWithoutPathOrAbsorber) {
  EXPECT_EQ(transmittance(vec3(3.0F), 0.0F), vec3(1));
  EXPECT_EQ(transmittance(vec3(0.0F), 5.0F), vec3(1));
}

TEST(Transmittance, IsANumberAtInfinity) {
  EXPECT_EQ(transmittance(vec3(kInfinity), 0.0F), vec3(1));
  EXPECT_EQ(transmittance(vec3(0.0F), kInfinity), vec3(1));
  EXPECT_EQ(transmittance(vec3(1e30F), 1e30F), vec3(0));
  EXPECT_EQ(transmittance(vec3(kInfinity), 1.0F), vec3(0));
}

TEST(Transmittance, OfAPathIsTheProductOfItsParts) {
  const vec3 sigma(0.3F, 2.0F, 9.0F);
  const vec3 whole = transmittance(sigma, 1.0F), parts = transmittance(sigma, 0.4F) * transmittance(sigma, 0.6F);
  for (int c = 0; c < 3; ++c) EXPECT_NEAR(whole[c] / parts[c], 1.0F, 2e-6F);
}

}  // namespace
}  // namespace nephroid
