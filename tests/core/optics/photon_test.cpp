#include "core/optics/photon.shared.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>
#include <set>

#include "core/math.h"

namespace nephroid {
namespace {

class RandomVectors {
 public:
  vec3 operator()() { return {normal_(generator_), normal_(generator_), normal_(generator_)}; }

 private:
  std::mt19937 generator_{17};
  std::normal_distribution<float> normal_;
};

TEST(UnitVector, SurvivesPacking) {
  RandomVectors random;
  float worst = 0;
  for (int i = 0; i < 20000; ++i) {
    const vec3 v = normalize(random());
    worst = std::max(worst, length(unpackUnitVector(packUnitVector(v)) - v));
  }
  EXPECT_LT(worst, 1e-4F);
  for (const vec3 axis : {vec3(1, 0, 0), vec3(0, 1, 0), vec3(0, 0, 1), vec3(-1, 0, 0), vec3(0, -1, 0), vec3(0, 0, -1)})
    EXPECT_EQ(unpackUnitVector(packUnitVector(axis)), axis);
}

TEST(LightBandFlags, ComeApartAgain) {
  Photon p{};
  p.light_band_flags = packLightBandFlags(65535, 17, kPhotonValid | kPhotonLeftScene);
  EXPECT_EQ(photonLight(p), 65535U);
  EXPECT_EQ(photonBand(p), 17U);
  EXPECT_TRUE(hasPhotonFlag(p, kPhotonValid));
  EXPECT_TRUE(hasPhotonFlag(p, kPhotonLeftScene));
  EXPECT_FALSE(hasPhotonFlag(p, kPhotonFootprintValid));
}

/// The shape of the ellipse { a·u + b·v } as the matrix a·aᵀ + b·bᵀ, which no choice of conjugate half-axes changes.
mat3 computeShape(vec3 a, vec3 b) { return glm::outerProduct(a, a) + glm::outerProduct(b, b); }

float computeDistance(const mat3& a, const mat3& b) {
  float sum = 0;
  for (int c = 0; c < 3; ++c) sum += dot(a[c] - b[c], a[c] - b[c]);
  return std::sqrt(sum);
}

float computeSignedArea(vec3 a, vec3 b, vec3 n) { return dot(cross(a, b), n); }

TEST(PhotonFootprint, KeepsShapeAreaAndHandedness) {
  RandomVectors random;
  for (int i = 0; i < 5000; ++i) {
    const vec3 n = normalize(random());
    // Fifteen decades of size; half-axes in the plane.
    const float size = std::pow(10.0F, static_cast<float>(i % 15) - 10.0F);
    const vec3 a = size * cross(n, random()), b = size * cross(n, random());
    const Photon p = setPhotonFootprint(Photon{}, a, b, n);
    ASSERT_TRUE(hasPhotonFlag(p, kPhotonFootprintValid));
    const Footprint f = photonFootprint(p, n);
    const mat3 shape = computeShape(a / size, b / size);
    EXPECT_LT(computeDistance(computeShape(f.axis_a / size, f.axis_b / size), shape),
              2e-4F * computeDistance(shape, mat3(0)));
    const float area = computeSignedArea(a / size, b / size, n);
    EXPECT_NEAR(computeSignedArea(f.axis_a / size, f.axis_b / size, n), area,
                2e-6F * dot(a / size, a / size) + 2e-6F * dot(b / size, b / size));
    EXPECT_NEAR(dot(f.axis_a, f.axis_b), 0.0F, 1e-5F * length(f.axis_a) * length(f.axis_b));
    EXPECT_GE(length(f.axis_a), length(f.axis_b) * (1 - 1e-5F));
  }
}

TEST(PhotonFootprint, KeepsTheAreaOfAnEllipseNextToAFold) {
  // Half-axes of 1 and 1e-6: two packed vectors of 2 × 16 bits would give any area between 0 and 30 times this.
  const vec3 n(0, 1, 0), a(0.6F, 0, 0.8F), b(0.8e-6F, 0, -0.6e-6F);
  const Footprint f = photonFootprint(setPhotonFootprint(Photon{}, a, b, n), n);
  EXPECT_NEAR(computeSignedArea(f.axis_a, f.axis_b, n) / computeSignedArea(a, b, n), 1.0F, 1e-5F);
}

TEST(PhotonFootprint, IsTheSameForNearlyTheSameNormal) {
  // Walls have normals with a zero that is now 1e-9 and now −1e-9: no frame may flip.
  const vec3 a(0, 0.3F, 0.1F), b(0, 0.05F, -0.2F);
  for (const float tilt : {1e-9F, -1e-9F, 0.0F, -0.0F}) {
    const vec3 n = normalize(vec3(1, tilt, tilt));
    const Footprint f = photonFootprint(setPhotonFootprint(Photon{}, a, b, vec3(1, 0, 0)), n);
    EXPECT_LT(computeDistance(computeShape(f.axis_a, f.axis_b), computeShape(a, b)), 1e-4F);
  }
}

TEST(PhotonFootprint, DropsWhatIsOffTheReceiver) {
  const vec3 n(0, 0, 1);
  const Footprint f = photonFootprint(setPhotonFootprint(Photon{}, vec3(2, 0, 5), vec3(0, 1, -3), n), n);
  EXPECT_LT(computeDistance(computeShape(f.axis_a, f.axis_b), computeShape(vec3(2, 0, 0), vec3(0, 1, 0))), 1e-3F);
}

TEST(PhotonFootprint, OfPointsLinesAndCirclesIsFinite) {
  const vec3 n(0, 0, 1), x(1, 0, 0), y(0, 1, 0);
  const auto pack = [&](vec3 a, vec3 b) { return photonFootprint(setPhotonFootprint(Photon{}, a, b, n), n); };
  EXPECT_EQ(pack(vec3(0), vec3(0)).axis_a, vec3(0));
  EXPECT_EQ(pack(vec3(0), vec3(0)).axis_b, vec3(0));
  const Footprint line = pack(x, 2.0F * x);
  EXPECT_NEAR(length(line.axis_a), std::sqrt(5.0F), 1e-5F);
  EXPECT_EQ(length(line.axis_b), 0.0F);
  const Footprint circle = pack(x, y), mirrored = pack(y, x);
  EXPECT_NEAR(computeSignedArea(circle.axis_a, circle.axis_b, n), 1.0F, 1e-6F);
  EXPECT_NEAR(computeSignedArea(mirrored.axis_a, mirrored.axis_b, n), -1.0F, 1e-6F);
  // (1, 0), (0, −1) is a pure mirror: there the rotation part vanishes.
  EXPECT_NEAR(computeSignedArea(pack(x, -y).axis_a, pack(x, -y).axis_b, n), -1.0F, 1e-6F);
}

TEST(HashChain, TellsSurfacesAndTheirOrderApart) {
  EXPECT_NE(hashChain(hashChain(0, 1), 2), hashChain(hashChain(0, 2), 1));
  EXPECT_NE(hashChain(0, 0), 0U);
  // All chains of up to three of 40 surfaces, 65,640 of them: the expected number of collisions is 0.5.
  std::set<uint> seen;
  std::size_t count = 0;
  const auto add = [&](uint chain) {
    seen.insert(chain);
    ++count;
    return chain;
  };
  for (uint a = 0; a < 40; ++a) {
    const uint one = add(hashChain(0, a));
    for (uint b = 0; b < 40; ++b) {
      const uint two = add(hashChain(one, b));
      for (uint c = 0; c < 40; ++c) add(hashChain(two, c));
    }
  }
  EXPECT_LE(count - seen.size(), 3U);
}

}  // namespace
}  // namespace nephroid
