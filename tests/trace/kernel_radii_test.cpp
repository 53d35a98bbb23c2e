// Radii by density: as many photons under every kernel, and less blur for it.
#include "trace/kernel_radii.h"

#include <gtest/gtest.h>

#include <functional>
#include <random>

#include "trace/kernel_map.h"

namespace nephroid {
namespace {

constexpr vec3 kNormal(0.0F, 0.8F, -0.6F);

/// Photons at random over a tilted square of side 2, denser where `density`, at most 1, is.
std::vector<GridPhoton> makePhotons(int count, unsigned seed, const std::function<float(vec2)>& density) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<float> side(-1.0F, 1.0F), chance(0.0F, 1.0F);
  std::vector<GridPhoton> photons;
  while (photons.size() < static_cast<std::size_t>(count)) {
    const vec2 at(side(random), side(random));
    if (chance(random) < density(at))
      photons.push_back({vec3(at.x, 0.6F * at.y, 0.8F * at.y), vec3(0, -1, 0), vec3(1.0F), kNormal});
  }
  return photons;
}
vec3 onPlane(float u, float v) { return {u, 0.6F * v, 0.8F * v}; }

int countWithin(const std::vector<GridPhoton>& photons, vec3 centre, float radius) {
  int count = 0;
  for (const GridPhoton& p : photons) count += dot(p.position - centre, p.position - centre) <= radius * radius;
  return count;
}

TEST(KernelRadii, HoldAsManyPhotonsWhereTheyAreDenseAsWhereTheyAreSparse) {
  const auto twoHalves = [](vec2 at) { return at.x < 0.0F ? 1.0F : 0.05F; };
  const auto pilot = makePhotons(40'000, 1, twoHalves), others = makePhotons(40'000, 2, twoHalves);
  const KernelRadii radii(pilot, 12.0F, 1e-4F, 1.0F);
  std::mt19937 random(3);
  std::uniform_real_distribution<float> within(0.2F, 0.8F);
  for (const float sign : {-1.0F, 1.0F}) {
    double sum = 0.0;
    constexpr int kPlaces = 400;
    for (int i = 0; i < kPlaces; ++i) {
      const vec3 at = onPlane(sign * within(random), within(random) - 0.5F);
      sum += countWithin(others, at, radii.at(at));
    }
    EXPECT_NEAR(sum / kPlaces, 12.0, 1.5) << sign;
  }
}

TEST(KernelRadii, KeepTheirRange) {
  const auto photons = makePhotons(20'000, 4, [](vec2 at) { return std::exp(-20.0F * dot(at, at)); });
  const KernelRadii radii(photons, 10.0F, 0.02F, 0.05F);
  EXPECT_EQ(radii.at(onPlane(0.0F, 0.0F)), 0.02F);
  EXPECT_EQ(radii.at(onPlane(0.99F, 0.99F)), 0.05F);
}

TEST(KernelRadii, OfTooFewPhotonsAreTheWidest) {
  const auto photons = makePhotons(3, 5, [](vec2) { return 1.0F; });
  const KernelRadii radii(photons, 10.0F, 0.01F, 0.25F);
  EXPECT_EQ(radii.at(vec3(0.0F)), 0.25F);
  EXPECT_EQ(radii.at(vec3(100.0F)), 0.25F);
}

TEST(KernelMap, FindsExactlyTheKernelsThatHoldAPoint) {
  const auto photons = makePhotons(3000, 6, [](vec2 at) { return std::exp(-3.0F * dot(at, at)); });
  const KernelRadii radii(photons, 10.0F, 0.005F, 0.3F);
  constexpr float kScale = 0.7F;
  const KernelMap map(photons, radii, kScale);
  std::mt19937 random(7);
  std::uniform_real_distribution<float> side(-1.1F, 1.1F), height(-0.02F, 0.02F);
  int all = 0;
  for (int i = 0; i < 500; ++i) {
    const vec3 at = onPlane(side(random), side(random)) + height(random) * kNormal;
    const vec3 normal = normalize(kNormal + vec3(20.0F * height(random)));
    int expected = 0, found = 0;
    for (const GridPhoton& p : photons) {
      const float radius = kScale * radii.at(p.position), most = kKernelFlatness * radius;
      const vec3 offset = p.position - at, along = offset - dot(offset, kNormal) * kNormal;
      expected += dot(along, along) < radius * radius && std::abs(dot(offset, normal)) <= most &&
                  std::abs(dot(offset, kNormal)) <= most;
    }
    map.visitKernels(at, normal, [&](const KernelPhoton& photon, float squared_radius) {
      ++found;
      const vec3 offset = photon.position - at, along = offset - dot(offset, kNormal) * kNormal;
      EXPECT_NEAR(squared_radius, dot(along, along) * photon.inverse_axes, 1e-6);
    });
    EXPECT_EQ(found, expected);
    all += found;
  }
  EXPECT_GT(all, 1000);
}

TEST(KernelMap, SpreadsThePhotonOverItsDiscWithoutARest) {
  const std::vector<GridPhoton> one = makePhotons(1, 9, [](vec2) { return 1.0F; });
  const KernelMap map(one, KernelRadii(one, 10.0F, 0.1F, 0.1F), 1.0F);
  constexpr int kPlaces = 200;
  constexpr float kSide = 0.25F / kPlaces;
  double whole = 0.0, half = 0.0;
  for (int i = 0; i < kPlaces * kPlaces; ++i) {
    const vec3 off = onPlane(kSide * (static_cast<float>(i % kPlaces) - 0.5F * kPlaces),
                             kSide * (static_cast<float>(i / kPlaces) - 0.5F * kPlaces));
    map.visitKernels(one[0].position + off, kNormal, [&](const KernelPhoton& photon, float squared_radius) {
      whole += photon.weightAt(squared_radius) * kSide * kSide;
      half += photon.halfWeightAt(squared_radius) * kSide * kSide;
    });
  }
  EXPECT_NEAR(whole, 1.0, 1e-3);
  EXPECT_NEAR(half, 1.0, 1e-3);
}

TEST(KernelMap, SpreadsAFootprintOverItsEllipse) {
  // Askew to the grid; r² is the distance in half-axes, and what lies along the longer one counts farther out.
  constexpr float kLong = 0.21F, kShort = 0.05F;
  const vec3 u = normalize(onPlane(0.6F, 0.8F)), v = cross(kNormal, u);
  GridPhoton photon{onPlane(0.3F, -0.2F), vec3(0, -1, 0), vec3(1.0F), kNormal};
  photon.axes = {kLong * u, kShort * v};
  const std::vector<GridPhoton> one{photon};
  const KernelMap map(one, KernelRadii(one, 10.0F, 0.12F, 0.12F), 1.0F);
  constexpr int kPlaces = 300;
  constexpr float kSide = 0.5F / kPlaces;
  double whole = 0.0, along = 0.0, across = 0.0;
  for (int i = 0; i < kPlaces * kPlaces; ++i) {
    const float x = kSide * (static_cast<float>(i % kPlaces) - 0.5F * kPlaces);
    const float y = kSide * (static_cast<float>(i / kPlaces) - 0.5F * kPlaces);
    map.visitKernels(photon.position + x * u + y * v, kNormal, [&](const KernelPhoton& kernel, float squared_radius) {
      EXPECT_NEAR(squared_radius, x * x / (kLong * kLong) + y * y / (kShort * kShort), 1e-4);
      const double weight = kernel.weightAt(squared_radius) * kSide * kSide;
      whole += weight, along += weight * x * x, across += weight * y * y;
    });
  }
  EXPECT_NEAR(whole, 1.0, 2e-3);
  // Of Epanechnikov's kernel over a disc of radius 1 the variance is a sixth.
  EXPECT_NEAR(along / (kLong * kLong), 1.0 / 6.0, 2e-3);
  EXPECT_NEAR(across / (kShort * kShort), 1.0 / 6.0, 2e-3);
}

TEST(KernelMap, KeepsFootprintsWithinBoundsOfTheDisc) {
  GridPhoton photon{onPlane(0.0F, 0.0F), vec3(0, -1, 0), vec3(1.0F), kNormal};
  const vec3 u(1, 0, 0), v = cross(kNormal, u);
  photon.axes = {10.0F * u, 1e-6F * v};
  const std::vector<GridPhoton> one{photon};
  const KernelMap map(one, KernelRadii(one, 10.0F, 0.1F, 0.1F), 1.0F);
  const auto isUnder = [&](vec3 offset) {
    bool found = false;
    map.visitKernels(photon.position + offset, kNormal, [&](const KernelPhoton&, float) { found = true; });
    return found;
  };
  EXPECT_TRUE(isUnder(0.19F * u) && !isUnder(0.21F * u));
  EXPECT_TRUE(isUnder(0.029F * v) && !isUnder(0.031F * v));
}

TEST(KernelMap, DoesNotReachAroundCorners) {
  // A wall above a floor: what ended on either, half a radius from where they meet, does not count on the other.
  constexpr float kRadius = 0.1F, kOff = 0.5F * kRadius;
  const vec3 up(0, 1, 0), out(0, 0, 1);
  const std::vector<GridPhoton> photons{{kOff * up, -out, vec3(1.0F), out}, {kOff * out, -up, vec3(1.0F), up}};
  const KernelMap map(photons, KernelRadii(photons, 10.0F, kRadius, kRadius), 1.0F);
  const auto count = [&](vec3 at, vec3 normal) {
    int found = 0;
    map.visitKernels(at, normal, [&](const KernelPhoton&, float) { ++found; });
    return found;
  };
  EXPECT_EQ(count(kOff * up, out), 1);
  EXPECT_EQ(count(kOff * out, up), 1);
  // On a step of the floor, as high as what ended on the wall but off the wall's plane.
  EXPECT_EQ(count(0.25F * kRadius * up + 0.45F * kRadius * out, up), 1);
}

/// A bright line on dim ground, as caustics are: mean over many batches of the profile that kernels make of it, over
/// the true one, as relative L1.
double errorOfLine(const std::function<KernelRadii(const std::vector<GridPhoton>&)>& choose) {
  constexpr int kPhotons = 20'000, kBatches = 20, kRows = 21, kColumns = 80;
  constexpr float kHalfWidth = 0.04F, kGround = 0.02F;
  const auto line = [](vec2 at) { return std::abs(at.x) < kHalfWidth ? 1.0F : kGround; };
  const double scale = kPhotons / (4.0 * (kHalfWidth + kGround * (1.0 - kHalfWidth)));
  const KernelRadii radii = choose(makePhotons(kPhotons, 8, line));
  std::vector<double> profile(kColumns, 0.0);
  for (unsigned b = 0; b < kBatches; ++b) {
    const KernelMap map(makePhotons(kPhotons, 100 + b, line), radii, 1.0F);
    for (int i = 0; i < kColumns * kRows; ++i) {
      const vec3 at = onPlane(0.005F * (static_cast<float>(i % kColumns - kColumns / 2) + 0.5F),
                              0.04F * static_cast<float>(i / kColumns - kRows / 2));
      map.visitKernels(at, kNormal, [&](const KernelPhoton& p, float squared_radius) {
        profile[static_cast<std::size_t>(i % kColumns)] += p.weightAt(squared_radius) / (scale * kBatches * kRows);
      });
    }
  }
  double error = 0.0, whole = 0.0;
  for (int i = 0; i < kColumns; ++i) {
    const float x = 0.005F * (static_cast<float>(i - kColumns / 2) + 0.5F);
    error += std::abs(profile[static_cast<std::size_t>(i)] - line(vec2(x, 0.0F)));
    whole += line(vec2(x, 0.0F));
  }
  return error / whole;
}

TEST(KernelRadii, BlurALineLessThanOneWidthDoes) {
  constexpr float kExpected = 10.0F;
  const double by_density =
      errorOfLine([](const std::vector<GridPhoton>& pilot) { return KernelRadii(pilot, kExpected, 1e-3F, 10.0F); });
  const double even = errorOfLine([](const std::vector<GridPhoton>& pilot) {
    const float radius = std::sqrt(kExpected * 4.0F / (kPi * 20'000.0F));
    return KernelRadii(pilot, kExpected, radius, radius);
  });
  EXPECT_LT(by_density, 0.6 * even);
}

}  // namespace
}  // namespace nephroid
