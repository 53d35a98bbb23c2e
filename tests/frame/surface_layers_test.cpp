#include "frame/surface_layers.h"

#include <cmath>
#include <cstring>
#include <numeric>

#include "core/optics/photon.shared.h"
#include "frame/view.h"
#include "support/gpu_fixture.h"
#include "support/tiny_scenes.h"

namespace nephroid {
namespace {

constexpr std::uint32_t kSize = 64;

/// Layers read back: by layer, row by row.
struct Layers {
  std::vector<std::uint32_t> seen;  ///< two words a texel
  std::vector<vec4> surfaces, depths;
  float depth(std::uint32_t layer, std::size_t i) const {
    return depths[layer / 4 * kSize * kSize + i][static_cast<int>(layer % 4)];
  }
  bool isThere(std::uint32_t layer, std::size_t i) const { return seen[2 * (layer * kSize * kSize + i)] != 0; }
  vec3 place(std::uint32_t layer, std::size_t i) const { return vec3(surfaces[layer * kSize * kSize + i]); }
  vec3 normal(std::uint32_t layer, std::size_t i) const {
    std::uint32_t bits = 0;
    std::memcpy(&bits, &surfaces[layer * kSize * kSize + i].w, sizeof(bits));
    return unpackUnitVector(bits);
  }
};

class SurfaceLayersTest : public testing::GpuTest {
 protected:
  static Layers draw(const SceneData& scene, const ViewRecord& view, std::uint32_t count) {
    gpu::CommandRecorder recorder(device());
    recorder.begin();
    const SceneBuffers buffers(device(), recorder, scene, 0.25F);
    SurfaceLayers layers(device(), buffers, kSize, 1, count);
    std::vector<std::size_t> draws(buffers.draws().size());
    std::iota(draws.begin(), draws.end(), std::size_t{0});
    layers.record(recorder, std::span(&view, 1), draws);
    recorder.submit();
    Layers result;
    const std::vector<std::byte> seen = gpu::readBack(device(), layers.seen());
    const std::vector<std::byte> surfaces = gpu::readBack(device(), layers.surfaces());
    result.seen.resize(seen.size() / sizeof(std::uint32_t));
    const std::vector<std::byte> depths = gpu::readBack(device(), layers.depths());
    result.depths.resize(depths.size() / sizeof(vec4));
    std::memcpy(static_cast<void*>(result.depths.data()), depths.data(), depths.size());
    result.surfaces.resize(surfaces.size() / sizeof(vec4));
    std::memcpy(result.seen.data(), seen.data(), seen.size());
    std::memcpy(static_cast<void*>(result.surfaces.data()), surfaces.data(), surfaces.size());
    return result;
  }
};

TEST_F(SurfaceLayersTest, ABallOverAFloorHasThree) {
  // From above: the ball's upper half, its lower half, the floor; beside the ball the floor alone.
  const SceneData scene = test::makeBallScene(test::makeGlass(1.5F), 256);
  const ViewRecord view = makeParallelView(vec3(0, -1, 0), scene.bounds());
  const Layers layers = draw(scene, view, 4);
  int in_ball = 0;
  for (std::size_t i = 0; i < kSize * kSize; ++i) {
    const vec3 first = layers.place(0, i);
    const double r = std::hypot(double{first.x}, double{first.z});
    // At the silhouette the facets decide.
    if (std::abs(r - 1.0) < 0.02) continue;
    if (r > 1.0) {
      ASSERT_TRUE(layers.isThere(0, i));
      ASSERT_NEAR(first.y, 0.0F, 1e-5F);
      ASSERT_FALSE(layers.isThere(1, i));
      continue;
    }
    ++in_ball;
    const double height = std::sqrt(1.0 - r * r);
    ASSERT_TRUE(layers.isThere(0, i) && layers.isThere(1, i) && layers.isThere(2, i));
    ASSERT_FALSE(layers.isThere(3, i));
    ASSERT_NEAR(first.y, 1.2 + height, 2e-3) << r;
    ASSERT_NEAR(layers.place(1, i).y, 1.2 - height, 2e-3) << r;
    ASSERT_NEAR(layers.place(2, i).y, 0.0, 1e-5);
    // All on the ray of the texel.
    ASSERT_NEAR(layers.place(1, i).x, first.x, 1e-5F);
    ASSERT_NEAR(layers.place(2, i).z, first.z, 1e-5F);
    ASSERT_GT(dot(layers.normal(0, i), vec3(first.x, height, first.z)), 0.999);
    ASSERT_GT(dot(layers.normal(1, i), vec3(first.x, -height, first.z)), 0.999);
    ASSERT_GT(layers.normal(2, i).y, 0.9999F);
  }
  EXPECT_GT(in_ball, 100);
}

TEST_F(SurfaceLayersTest, PanesBehindEachOtherAreInOrder) {
  // In the order in which they are drawn the nearest is neither first nor last; from a point, so that depths are not
  // linear.
  SceneData scene;
  for (const double y : {0.3, 0.9, 0.1, 0.6})
    test::addObject(scene, test::makeFloor(4.0, y), test::makeDiffuse(vec3(1)));
  const ViewRecord view = makeCubeView(vec3(0.1F, 2, 0), 3, scene.bounds());
  const Layers layers = draw(scene, view, 5);
  const std::size_t middle = kSize * kSize / 2 + kSize / 2;
  const float expected[] = {0.9F, 0.6F, 0.3F, 0.1F};
  for (std::uint32_t layer = 0; layer < 4; ++layer) {
    ASSERT_TRUE(layers.isThere(layer, middle)) << layer;
    EXPECT_NEAR(layers.place(layer, middle).y, expected[layer], 1e-5F);
  }
  EXPECT_FALSE(layers.isThere(4, middle));
}

TEST_F(SurfaceLayersTest, NothingIsSeenOfNothing) {
  const SceneData scene = test::makeBallScene(test::makeGlass(1.5F));
  ViewRecord view = makeParallelView(vec3(0, -1, 0), scene.bounds());
  // Far beside the scene.
  view = makePerspectiveView(vec3(100, 0, 0), vec3(1, 0, 0), vec3(0, 1, 0), vec2(0.1F), {1.0F, 10.0F});
  const Layers layers = draw(scene, view, 2);
  for (std::size_t i = 0; i < kSize * kSize; ++i) ASSERT_FALSE(layers.isThere(0, i) || layers.isThere(1, i));
}

TEST_F(SurfaceLayersTest, DepthsAreThoseOfSurfacesFourToATexel) {
  const SceneData scene = test::makeBallScene(test::makeGlass(1.5F), 64);
  const ViewRecord view = makeParallelView(normalize(vec3(0.3F, -1, 0.2F)), scene.bounds());
  for (const std::uint32_t count : {1U, 3U, 6U}) {
    const Layers layers = draw(scene, view, count);
    ASSERT_EQ(layers.depths.size(), (count + 3) / 4 * kSize * kSize);
    for (std::size_t i = 0; i < kSize * kSize; ++i)
      for (std::uint32_t k = 0; k < (count + 3) / 4 * 4; ++k) {
        if (k >= count || !layers.isThere(k, i))
          ASSERT_TRUE(std::isinf(layers.depth(k, i))) << k;
        else
          ASSERT_NEAR(layers.depth(k, i), dot(layers.place(k, i), view.forward), 1e-5F) << k;
      }
  }
}

}  // namespace
}  // namespace nephroid
