// From where receivers are seen that a caustic may reach.
#include <algorithm>

#include "frame/receiver_map.shared.h"
#include "frame/receiver_views.h"
#include "frame/scene_buffers.h"
#include "support/gpu_fixture.h"
#include "support/tiny_scenes.h"

namespace nephroid {
namespace {

class ReceiverViewsTest : public testing::GpuTest {
 protected:
  static ReceiverViews makeViews(const SceneData& scene) {
    gpu::CommandRecorder recorder(device());
    recorder.begin();
    const SceneBuffers buffers(device(), recorder, scene, 0.25F);
    recorder.submit();
    return makeReceiverViews(scene, buffers.draws());
  }
};

void expectForwards(const ReceiverViews& made, std::vector<vec3> expected) {
  ASSERT_EQ(made.views.size(), expected.size());
  for (const ViewRecord& view : made.views) EXPECT_EQ(std::ranges::count(expected, view.forward), 1);
}

TEST_F(ReceiverViewsTest, AFloorIsSeenFromTheSideOfTheGlassAlone) {
  expectForwards(makeViews(test::makeBallScene(test::makeGlass(1.5F))), {vec3(0, -1, 0)});
}

TEST_F(ReceiverViewsTest, ThereAreNoneWithoutGenerators) {
  EXPECT_TRUE(makeViews(test::makeBallScene(test::makeDiffuse(vec3(0.5F)))).views.empty());
}

TEST_F(ReceiverViewsTest, AClosedBoxIsSeenFromOutside) {
  // Beside the ball: its far side, its bottom and its inside cannot be reached.
  SceneData scene = test::makeBallScene(test::makeGlass(1.5F));
  test::addObject(scene, makeBox("box", dvec3(2.5, 0, -0.5), dvec3(3.5, 1, 0.5)), test::makeDiffuse(vec3(0.5F)));
  expectForwards(makeViews(scene), {vec3(0, -1, 0), vec3(1, 0, 0), vec3(0, 0, 1), vec3(0, 0, -1)});
}

TEST_F(ReceiverViewsTest, APlaceIsWhereItsCoordinatesSay) {
  // Deposits find a place by axes, pictures are drawn by matrices.
  SceneData scene = test::makeBallScene(test::makeGlass(1.5F));
  test::addObject(scene, makeBox("box", dvec3(2.5, 0, -0.5), dvec3(3.5, 1, 0.5)), test::makeDiffuse(vec3(0.5F)));
  const ReceiverViews made = makeViews(scene);
  const vec3 place(2.5F, 0.7F, -0.3F);
  for (std::size_t v = 0; v < made.views.size(); ++v) {
    const ViewRecord& view = made.views[v];
    const std::uint32_t axis = made.axes >> (4 * v) & 15U;
    EXPECT_EQ(made.views_by_axis >> (4 * axis) & 15U, v);
    EXPECT_EQ(view.forward[static_cast<int>(axis / 2)], axis % 2 == 0 ? -1.0F : 1.0F);
    const vec3 off = seenAlong(axis / 2, (place - made.centre) / made.half);
    EXPECT_NEAR(dot(view.clip_row_x, vec4(place, 1.0F)), off.x, 1e-6F);
    EXPECT_NEAR(dot(view.clip_row_y, vec4(place, 1.0F)), off.y, 1e-6F);
    // Between the nearest and the farthest that is drawn.
    EXPECT_GT(dot(view.clip_row_z, vec4(place, 1.0F)), 0.0F);
    EXPECT_LT(dot(view.clip_row_z, vec4(place, 1.0F)), 1.0F);
  }
}

}  // namespace
}  // namespace nephroid
