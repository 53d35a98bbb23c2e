// Where paths gather photons, and lights that are guided there.
#include "techniques/reference/gather_places.h"

#include <gtest/gtest.h>

#include "support/tiny_scenes.h"
#include "techniques/reference/guide_pilot.h"
#include "techniques/reference/photon_batch.h"

namespace nephroid {
namespace {

constexpr int kSize = 64;
constexpr vec3 kAim(2.0F, 0.0F, 1.0F);

/// A wide pane of glass, a metre thick, above a floor under the sun; a camera that sees a small part of that through
/// it.
class GatherPlacesTest : public testing::Test {
 protected:
  GatherPlacesTest()
      : scene_(makeScene()),
        camera_(makeCamera("through glass", kAim + vec3(0.4F, 8.0F, 0.0F), kAim, radians(14))),
        world_(scene_, camera_, kSize, kSize, ReferenceOptions{}),
        needs_({"specular"}),
        path_tracer_(world_, needs_) {
    path_tracer_.leaveToPhotons({.specular_caustic = true});
    path_tracer_.gatherFrom(&photons_, {.specular_caustic = true});
  }
  static SceneData makeScene() {
    SceneData scene;
    test::addObject(scene, test::makeFloor(16.0), test::makeDiffuse(vec3(0.6F)));
    test::addObject(scene, makeBox("slab", dvec3(-8, 1, -8), dvec3(8, 2, 8)), test::makeGlass(1.5F));
    scene.lights.push_back(test::makeSun(vec3(0.2F, -1, 0.1F), vec3(5.0F), 0.5F));
    return scene;
  }
  GatherPlaces findPlaces() { return {world_, camera_, kSize, kSize, path_tracer_, needs_}; }

  SceneData scene_;
  Camera camera_;
  ReferenceWorld world_;
  LayerNeeds needs_;
  GatheredPhotons photons_;
  PathTracer path_tracer_;
};

TEST_F(GatherPlacesTest, AreWhatIsSeenThroughGlass) {
  const GatherPlaces places = findPlaces();
  ASSERT_FALSE(places.empty());
  int seen = 0;
  for (int z = 0; z < 9; ++z)
    for (int x = 0; x < 9; ++x) {
      const vec2 offset = 0.7F * (vec2(static_cast<float>(x), static_cast<float>(z)) / 4.0F - 1.0F);
      if (places.isNear(kAim + vec3(offset.x, 0.0F, offset.y))) ++seen;
    }
  EXPECT_EQ(seen, 81);
  for (const vec3 far : {vec3(2, 0, 0), vec3(-2, 0, 0), vec3(0, 0, 2), vec3(0, 0, -2), vec3(0, 1, 0)})
    EXPECT_FALSE(places.isNear(kAim + far)) << far.x << ' ' << far.y << ' ' << far.z;
}

TEST_F(GatherPlacesTest, WithoutGlassBeforeTheCameraAreNone) {
  camera_ = makeCamera("beside", vec3(0, 0.5F, 0), vec3(1, 0, 0), radians(14));
  EXPECT_TRUE(findPlaces().empty());
}

TEST_F(GatherPlacesTest, GetMorePhotonsOfTheSameFlux) {
  const GatherPlaces places = findPlaces();
  LightTracer tracer(world_, {});
  tracer.keepDeposits(false);
  PhotonBatch batch(tracer, PhotonBatch::kMaxPhotons, kSize, kSize);
  struct Arrived {
    double flux = 0.0, all_flux = 0.0;
    int photons = 0;
  };
  const auto trace = [&] {
    Arrived arrived;
    batch.trace(0, [] { return false; });
    for (const PhotonBatch::Chunk& chunk : batch.chunks())
      for (const GridPhoton& photon : chunk.tally.caustic_deposits) {
        const double flux = photon.flux.x * batch.scaleOf(chunk);
        arrived.all_flux += flux;
        if (places.isNear(photon.position)) arrived.flux += flux, ++arrived.photons;
      }
    return arrived;
  };
  const Arrived even = trace();
  const auto lights = guideToPlaces(world_, tracer, {batch.shares(), {}, 0.7F}, places);
  const Arrived guided = trace();
  ASSERT_EQ(lights.size(), 1U);
  ASSERT_GT(even.photons, 2000);
  // What guiding brings where nothing smooths it: 0.3 + 0.7 over the share that is of use, which edges lessen.
  const double share = lights[0].seen_even;
  EXPECT_LT(share, 0.05);
  EXPECT_GT(guided.photons, 0.5 * (0.3 + 0.7 / share) * even.photons);
  EXPECT_NEAR(guided.photons / (1.0 * even.photons), lights[0].seen_guided / share,
              0.05 * lights[0].seen_guided / share);
  EXPECT_NEAR(guided.flux, even.flux, 0.01 * even.flux);
  EXPECT_NEAR(guided.all_flux, even.all_flux, 0.005 * even.all_flux);
}

TEST_F(GatherPlacesTest, LeaveLightsEvenThatSendMostOfTheirPhotonsThereAnyway) {
  camera_ = makeCamera("from far", vec3(0.4F, 40.0F, 0.0F), vec3(0), radians(22));
  const GatherPlaces places = findPlaces();
  LightTracer tracer(world_, {});
  tracer.keepDeposits(false);
  const PhotonBatch batch(tracer, PhotonBatch::kMaxPhotons, kSize, kSize);
  EXPECT_TRUE(guideToPlaces(world_, tracer, {batch.shares(), {}, 0.7F}, places).empty());
}

}  // namespace
}  // namespace nephroid
