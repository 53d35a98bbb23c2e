// Which paths are left to walks.
#include "techniques/reference/manifold/share.h"

#include "receiver_fixture.h"

namespace nephroid {
namespace {

/// A ray straight down on a ball of a material, and the share of a photon that is mirrored there `events` times.
bool isWalked(const Material& material, int events, bool from_environment = false) {
  const SceneData scene = test::makeBallScene(material);
  const test::ReceiverFixture at(scene, vec3(0.1F, 4, 0.1F), vec3(0.1F, 0, 0.1F));
  ManifoldShare share(from_environment);
  for (int i = 0; i < events; ++i) share.add(at.encounter, vec3(0, 1, 0), vec3(0, 1, 0), kDefaultSpecularAlpha);
  return share.isWalked();
}

TEST(ManifoldShare, IsOneOrTwoSmoothEvents) {
  const Material metal = test::makeMetal(vec3(0.9F));
  EXPECT_FALSE(isWalked(metal, 0));
  EXPECT_TRUE(isWalked(metal, 1));
  EXPECT_TRUE(isWalked(metal, 2));
  EXPECT_FALSE(isWalked(metal, 3));
  EXPECT_FALSE(isWalked(metal, 1, true));
  EXPECT_TRUE(isWalked(test::makeGlass(1.5F), 2));
  EXPECT_FALSE(isWalked(test::makeGlass(1.5F, 0.3F), 1));
}

TEST(ManifoldShare, HasNoPanesPrismsHolesOrNormalMaps) {
  Material pane = test::makeGlass(1.5F);
  pane.thickness = 0.0F;
  EXPECT_FALSE(isWalked(pane, 1));
  Material prism = test::makeGlass(1.5F);
  prism.dispersion = 1.0F;
  EXPECT_FALSE(isWalked(prism, 1));
  Material sieve = test::makeMetal(vec3(0.9F));
  sieve.alpha_mode = AlphaMode::kBlend;
  EXPECT_FALSE(isWalked(sieve, 1));
}

TEST(ManifoldShare, EndsWhereTheShadingNormalLooksAway) {
  SurfacePoint point{};
  point.normal_geometric = vec3(0, 1, 0);
  point.normal_shading = normalize(vec3(1, 0.5F, 0));
  EXPECT_TRUE(isSeenFromItsSide(point, normalize(vec3(1, 1, 0))));
  EXPECT_TRUE(isSeenFromItsSide(point, normalize(vec3(-1, -1, 0))));
  EXPECT_FALSE(isSeenFromItsSide(point, normalize(vec3(-1, 0.2F, 0))));
  EXPECT_FALSE(isSeenFromItsSide(point, normalize(vec3(1, -0.2F, 0))));
}

}  // namespace
}  // namespace nephroid
