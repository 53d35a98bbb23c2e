#include "trace/photon_grid.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <random>
#include <vector>

namespace nephroid {
namespace {

std::vector<GridPhoton> makePhotons(int count, float scale) {
  std::mt19937 random(11);
  std::uniform_real_distribution<float> uniform(-scale, scale);
  std::vector<GridPhoton> photons;
  for (int i = 0; i < count; ++i)
    photons.push_back({vec3(uniform(random), 0.1F * uniform(random), uniform(random)), vec3(0, -1, 0), vec3(1.0F)});
  return photons;
}

TEST(PhotonGrid, FindsExactlyThePhotonsWithinTheRadius) {
  const auto photons = makePhotons(3000, 2.0F);
  const PhotonGrid grid(photons, 0.25F);
  std::mt19937 random(12);
  std::uniform_real_distribution<float> uniform(-2.2F, 2.2F);
  for (int i = 0; i < 300; ++i) {
    const vec3 at(uniform(random), 0.1F * uniform(random), uniform(random));
    int expected = 0, found = 0;
    for (const GridPhoton& p : photons) expected += dot(p.position - at, p.position - at) <= 0.25F * 0.25F;
    grid.visitNear(at, [&](const GridPhoton&) { ++found; });
    EXPECT_EQ(found, expected);
  }
}

TEST(PhotonGrid, OfNothingFindsNothing) {
  const PhotonGrid grid({}, 1.0F);
  grid.visitNear(vec3(0), [](const GridPhoton&) { FAIL(); });
}

TEST(ChooseGatherRadius, FindsAboutAsManyAsExpectedAtAnyScale) {
  for (const float scale : {0.01F, 1.0F, 100.0F}) {
    const auto photons = makePhotons(20000, scale);
    // Flat: the box is a tenth as high as wide, so a disc of the plane holds what is asked for.
    const float radius = chooseGatherRadius(photons, 20.0F);
    EXPECT_NEAR(radius / scale, std::sqrt(20.0F * 4.0F / (kPi * 20000.0F)), 2e-3F);
  }
}

}  // namespace
}  // namespace nephroid
