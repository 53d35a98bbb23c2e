#include "core/optics/refraction.shared.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "core/math.h"

namespace nephroid {
namespace {

/// Random unit dir and n with dot(dir, n) <= 0.
class RandomHit {
 public:
  struct Hit {
    vec3 dir, n;
  };
  Hit operator()() {
    Hit hit{makeUnit(), makeUnit()};
    if (dot(hit.dir, hit.n) > 0) hit.n = -hit.n;
    return hit;
  }

 private:
  vec3 makeUnit() { return normalize(vec3(normal_(generator_), normal_(generator_), normal_(generator_))); }
  std::mt19937 generator_{8};
  std::normal_distribution<float> normal_;
};

TEST(Reflect, KeepsTheTangentAndTurnsTheNormalPart) {
  RandomHit random;
  for (int i = 0; i < 1000; ++i) {
    const auto [dir, n] = random();
    const vec3 r = reflectDir(dir, n);
    EXPECT_NEAR(length(r), 1.0F, 1e-6F);
    EXPECT_NEAR(dot(r, n), -dot(dir, n), 1e-6F);
    EXPECT_LT(length(cross(r, n) - cross(dir, n)), 1e-6F);
  }
}

TEST(Refract, ObeysSnell) {
  RandomHit random;
  for (int i = 0; i < 3000; ++i) {
    const auto [dir, n] = random();
    for (const float ratio : {0.5F, 1 / 1.5F, 0.999F, 1.001F, 1.5F}) {
      const Refraction refracted = refractDir(dir, n, ratio);
      const dvec3 sin_from = glm::cross(dvec3(dir), dvec3(n));
      ASSERT_EQ(refracted.valid, length(vec3(sin_from)) * ratio <= 1.0F) << "ratio " << ratio;
      if (!refracted.valid) continue;
      // n1 sin θ1 = n2 sin θ2, as vectors so that the plane of incidence is tested as well.
      EXPECT_LT(length(vec3(glm::cross(dvec3(refracted.dir), dvec3(n)) - sin_from * double{ratio})), 5e-7F);
      EXPECT_LE(dot(refracted.dir, n), 0.0F);
      EXPECT_NEAR(length(refracted.dir), 1.0F, 2e-7F);
    }
  }
}

TEST(Refract, ReturnsInvalidBeyondCriticalAngle) {
  // sin θ_c = 1/1.5 = 0.66667.
  const auto at = [](float sine) {
    return refractDir(vec3(sine, -std::sqrt(1 - sine * sine), 0), vec3(0, 1, 0), 1.5F);
  };
  EXPECT_FALSE(at(0.667F).valid);
  EXPECT_EQ(at(0.667F).dir, vec3(0));
  EXPECT_TRUE(at(0.666F).valid);
}

TEST(Refract, AtIndexRatioOneGoesStraightOn) {
  RandomHit random;
  for (int i = 0; i < 1000; ++i) {
    const auto [dir, n] = random();
    const Refraction refracted = refractDir(dir, n, 1.0F);
    ASSERT_TRUE(refracted.valid);
    EXPECT_LT(length(refracted.dir - dir), 4e-7F) << "no more than normalising costs";
  }
  const Refraction grazing = refractDir(vec3(1, 0, 0), vec3(0, 1, 0), 1.0F);
  EXPECT_TRUE(grazing.valid);
  EXPECT_EQ(grazing.dir, vec3(1, 0, 0));
}

TEST(Refract, IsReversible) {
  RandomHit random;
  for (int i = 0; i < 1000; ++i) {
    const auto [dir, n] = random();
    const Refraction in = refractDir(dir, n, 1 / 1.5F);
    const Refraction back = refractDir(-in.dir, -n, 1.5F);
    // At grazing incidence the way back starts at the critical angle, where rounding costs half of the digits.
    if (dot(dir, n) > -0.05F) continue;
    ASSERT_TRUE(back.valid);
    EXPECT_LT(length(back.dir + dir), 1e-5F);
  }
}

TEST(Refract, ThroughAParallelSlabKeepsTheDirection) {
  const vec3 n(0, 1, 0), dir = normalize(vec3(0.8F, -0.5F, 0.1F));
  vec3 d = dir;
  for (int i = 0; i < 100; ++i) d = refractDir(refractDir(d, n, 1 / 1.5F).dir, n, 1.5F).dir;
  EXPECT_LT(length(d - dir), 1e-5F);
  EXPECT_NEAR(length(d), 1.0F, 2e-7F);
}

}  // namespace
}  // namespace nephroid
