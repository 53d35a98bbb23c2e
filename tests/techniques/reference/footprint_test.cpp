// Footprints of photons: where neighbours truly end, and how they are laid over pixels.
#include "techniques/reference/footprint.h"

#include <gtest/gtest.h>

#include <numeric>

#include "support/tiny_scenes.h"
#include "techniques/reference/footprint_pilot.h"
#include "techniques/reference/footprint_splat.h"

namespace nephroid {
namespace {

using test::addObject;
using test::makeDiffuse;
using test::makeGlass;

constexpr int kSize = 256;

/// A scene under one light, its tracer, and what the camera sees of it from above.
class FootprintTest : public testing::Test {
 protected:
  void build(SceneData scene) {
    scene_ = std::move(scene);
    camera_ = makeCamera("above", vec3(3.5F, 5.0F, 3.0F), vec3(0.6F, 0, 0.5F), radians(40));
    world_ = std::make_unique<ReferenceWorld>(scene_, camera_, kSize, kSize, ReferenceOptions{});
    tracer_ = std::make_unique<LightTracer>(*world_, PhotonPaths{.caustic = true});
    view_ = std::make_unique<ReceiverView>(*world_);
    tracer_->spreadOver(view_.get());
  }
  static SceneData makeBallUnderLight(Material material, float light_radius) {
    SceneData scene = test::makeBallScene(std::move(material), 512);
    scene.lights.push_back(test::makePoint(vec3(-1.0F, 5.0F, -0.8F), vec3(50.0F), light_radius));
    return scene;
  }

  SceneData scene_;
  Camera camera_;
  std::unique_ptr<ReferenceWorld> world_;
  std::unique_ptr<LightTracer> tracer_;
  std::unique_ptr<ReceiverView> view_;
};

TEST(Footprint, OnASurfaceIsTheCellOfABeamOverTheCosine) {
  // A beam one metre wide straight down on a slope of 3 to 4.
  Footprint footprint({.place = 1.0F, .direction = 0.0F}, vec3(0, -1, 0));
  SurfacePoint point;
  point.normal_geometric = vec3(0.0F, 0.8F, -0.6F);
  footprint.transfer(vec3(0, -1, 0), 2.0F, point);
  constexpr float kCell = 1e-4F;
  const auto [longer, shorter] = footprint.halfAxesOn(point.normal_geometric, kCell);
  EXPECT_NEAR(kPi * length(longer) * length(shorter), kCell / 0.8F, 1e-3F * kCell);
  EXPECT_NEAR(length(longer) / length(shorter), 1.0F / 0.8F, 1e-3F);
  EXPECT_NEAR(std::abs(dot(longer, vec3(0.0F, 0.6F, 0.8F))), length(longer), 1e-3F * length(longer));
  EXPECT_NEAR(dot(shorter, point.normal_geometric), 0.0F, 1e-6F);
  footprint.choose(0.25F);
  EXPECT_NEAR(length(footprint.halfAxesOn(point.normal_geometric, kCell)[0]), 2.0F * length(longer), 1e-5F);
}

/// Cells so small that the ball's way with light is straight over them.
constexpr FootprintScale kSmallCell{1e-9F, 0.0F};

TEST_F(FootprintTest, SaysWhereNeighboursEnd) {
  for (const Material& material : {makeGlass(1.5F), test::makeMetal(vec3(0.9F)), makeGlass(1.5F, 0.2F)}) {
    build(makeBallUnderLight(material, 0.1F));
    const Emitter& emitter = *tracer_->emitters()[0];
    int pairs = 0, close = 0;
    for (std::uint32_t i = 0; i < 2000; ++i) {
      PhotonWave::Photon photon{{}, Sampler(1, 2, i)};
      photon.emitted = emitter.emit(photon.sampler);
      const auto landing = tracer_->findLanding(0, photon, kSmallCell);
      if (!landing) continue;
      // To the end of the cell's first axis of direction: on the border of the ellipse of directions alone.
      const EmissionExtent extent = emitter.extentOf(photon.emitted);
      const Frame frame = Frame::fromZ(photon.emitted.dir);
      PhotonWave::Photon neighbour = photon;
      neighbour.emitted.dir =
          normalize(photon.emitted.dir + frame.x * (extent.direction * landing->direction_share / std::sqrt(kPi)));
      const auto other = tracer_->findLanding(0, neighbour, kSmallCell);
      if (!other) continue;
      ++pairs;
      // The ellipse is that of both kinds of axes, so what one makes is inside; and no less than a tenth of it, for
      // shares are chosen so that both reach equally far.
      const float r2 = squaredRadiusAt(*landing, other->film);
      if (r2 <= 1.1F && length(other->film - landing->film) > 0.1F * std::min(landing->reach.x, landing->reach.y))
        ++close;
    }
    ASSERT_GT(pairs, 100) << material.name;
    EXPECT_GT(close, (material.roughness > 0.0F ? 0.9 : 0.97) * pairs) << material.name << ' ' << material.roughness;
  }
}

TEST_F(FootprintTest, AreTheConeOfALightOnABareFloorBehindASlab) {
  // Through a flat slab neighbours keep their directions: a footprint is the light's solid angle over the distance,
  // first order in the angle. Straight down from 5 m, 1 m of glass of index 2 shortens the way by half of that.
  SceneData scene;
  addObject(scene, test::makeFloor(8.0), makeDiffuse(vec3(0.6F)));
  addObject(scene, makeBox("slab", dvec3(-3, 0.5, -3), dvec3(3, 1.5, 3)), makeGlass(2.0F));
  scene.lights.push_back(test::makePoint(vec3(0, 5, 0), vec3(50.0F)));
  build(std::move(scene));
  const EmissionExtent extent{0.0F, 0.01F};
  Footprint footprint(extent, vec3(0, -1, 0));
  SurfacePoint point{};
  point.normal_geometric = vec3(0, 1, 0);
  point.instance = 1;
  footprint.transfer(vec3(0, -1, 0), 3.5F, point);
  footprint.bend(world_->scene, point, vec3(0, -1, 0), vec3(0, -1, 0), true, 0.5F);
  footprint.transfer(vec3(0, -1, 0), 1.0F, point);
  footprint.bend(world_->scene, point, vec3(0, -1, 0), vec3(0, -1, 0), true, 2.0F);
  footprint.transfer(vec3(0, -1, 0), 0.5F, point);
  ASSERT_TRUE(footprint.valid());
  for (const vec3& axis : footprint.axes().direction)
    EXPECT_NEAR(length(axis), 0.01F / std::sqrt(kPi) * (5.0F - 0.5F), 1e-6F);
}

/// A round footprint of radius `radius` pixels about `film` on the floor of the ball scene.
FootprintSplat makeRound(const ReceiverView& view, vec2 film, float radius) {
  FootprintSplat s{};
  const int x = static_cast<int>(film.x), y = static_cast<int>(film.y);
  s.splat.pixel = static_cast<std::uint32_t>(y * view.width() + x);
  s.film = film;
  s.reach = vec2(radius);
  s.xx = s.yy = 1.0F / (radius * radius);
  s.steps = radius < 1.5F ? 4 : 1;
  s.instance = view.at(x, y).instance;
  s.normal = vec3(0, 1, 0);
  s.thickness = 1e-3F;
  return s;
}

double sumOfWeights(const ReceiverView& view, const FootprintSplat& s, int row_begin, int row_end) {
  double sum = 0.0;
  visitFootprint(view, s, row_begin, row_end, [&](const FootprintRow& row) {
    for (int x = row.x_first; x < row.x_end; ++x) sum += row.weights[static_cast<std::size_t>(x - row.x_first)];
  });
  return sum;
}

TEST_F(FootprintTest, WeightsAddUpToOneAlsoAtEdges) {
  build(makeBallUnderLight(makeGlass(1.5F), 0.1F));
  int at_edges = 0;
  for (int y = 1; y < kSize; y += 7) {
    for (int x = 1; x < kSize; x += 7) {
      if (view_->at(x, y).instance != 0) continue;  // the floor
      for (const float radius : {0.8F, 3.3F, 12.0F}) {
        FootprintSplat s = makeRound(*view_, vec2(x, y) + 0.37F, radius);
        ASSERT_TRUE(normalizeFootprint(*view_, s)) << x << ' ' << y << ' ' << radius;
        const double above = sumOfWeights(*view_, s, 0, y), below = sumOfWeights(*view_, s, y, kSize);
        ASSERT_NEAR(above + below, 1.0, 1e-5) << x << ' ' << y << ' ' << radius;
        visitFootprint(*view_, s, 0, kSize, [&](const FootprintRow& row) {
          for (int i = row.x_first; i < row.x_end; ++i) {
            if (view_->at(i, row.y).instance == 0) continue;
            ++at_edges;
            ASSERT_EQ(row.weights[static_cast<std::size_t>(i - row.x_first)], 0.0F) << "on the ball";
          }
        });
      }
    }
  }
  EXPECT_GT(at_edges, 1000);
}

TEST_F(FootprintTest, SmallerThanAPixelCountsForThatPixelAlone) {
  build(makeBallUnderLight(makeGlass(1.5F), 0.1F));
  int x = 20;
  const int y = 200;
  while (view_->at(x, y).instance != 0) ++x;
  FootprintSplat inside = makeRound(*view_, vec2(x, y) + 0.5F, 0.4F);
  EXPECT_FALSE(normalizeFootprint(*view_, inside));
  FootprintSplat across = makeRound(*view_, vec2(x, y) + vec2(0.95F, 0.5F), 0.4F);
  EXPECT_TRUE(normalizeFootprint(*view_, across));
}

TEST(FootprintScale, NarrowsSlowlyAndThenFast) {
  constexpr std::size_t kPixels = 1 << 18;
  const auto cell = [](std::uint64_t batch) { return scaleFootprints(0.1F, 1 << 18, batch, kPixels).cell; };
  // N^(−2/3) while photons are few: eight times as many make a quarter, but for (1 + N/64)² a pixel.
  EXPECT_NEAR(cell(7) / cell(0), 0.25 * std::pow((1 + 1.0 / 64) / (1 + 8.0 / 64), 2), 1e-4);
  // N^(−8/3) when they are many.
  EXPECT_NEAR(cell(80'000 - 1) / cell(10'000 - 1), std::pow(8.0, -8.0 / 3.0), 1e-4);
}

TEST_F(FootprintTest, PilotFindsSmoothSurfacesStraightAndRoughReliefsNot) {
  const auto overlapOf = [&](SceneData scene) {
    build(std::move(scene));
    return chooseFootprintOverlaps(*tracer_, {200'000}, 1).at(0);
  };
  EXPECT_GE(overlapOf(makeBallUnderLight(makeGlass(1.5F), 0.1F)), 0.025F);
  // The same ball with every vertex off its place by up to 2 % of the radius, its normals as they were: each triangle
  // goes its own way.
  SceneData rough = makeBallUnderLight(makeGlass(1.5F), 0.1F);
  std::uint32_t state = 1;
  for (Mesh& mesh : rough.meshes) {
    if (mesh.normals.empty() || mesh.positions.size() < 1000) continue;
    for (vec3& normal : mesh.normals) {
      state = state * 1664525U + 1013904223U;
      normal = normalize(normal + 0.3F * vec3((state >> 8) & 255U, (state >> 16) & 255U, state >> 24) / 255.0F - 0.15F);
    }
  }
  EXPECT_LT(overlapOf(std::move(rough)), 0.01F);
}

TEST(FilmOffset, IsTheDerivativeOfTheConnection) {
  for (const bool orthographic : {false, true}) {
    Camera camera = makeCamera("c", vec3(3, 4, 2), vec3(0), radians(50));
    if (orthographic) camera.ortho_height = 6.0F;
    const CameraModel model(camera, 300, 200);
    const vec3 position(0.3F, -0.2F, 0.5F);
    for (const vec3& axis : {vec3(1, 0, 0), vec3(0, 1, 0), vec3(0, 0, 1)}) {
      const float step = 0.01F;
      const vec2 difference = model.connect(position + step * axis)->film - model.connect(position - step * axis)->film;
      const vec2 derivative = model.filmOffset(position, axis);
      EXPECT_NEAR(derivative.x, difference.x / (2 * step), 0.02F);
      EXPECT_NEAR(derivative.y, difference.y / (2 * step), 0.02F);
    }
  }
}

}  // namespace
}  // namespace nephroid
