// Where walks end, against textbook optics.
#include "techniques/reference/manifold/walk.h"

#include <glm/gtc/matrix_transform.hpp>

#include "receiver_fixture.h"

namespace nephroid {
namespace {

using test::addObject;
using test::ReceiverFixture;

/// The root of a function that rises from below to above zero.
template <class Function>
double bisect(const Function& f, double low, double high) {
  for (int i = 0; i < 100; ++i) (f(0.5 * (low + high)) < 0.0 ? low : high) = 0.5 * (low + high);
  return 0.5 * (low + high);
}

TEST(ManifoldWalk, FindsSnellsWayThroughASlab) {
  SceneData scene;
  addObject(scene, test::makeFloor(20.0), test::makeDiffuse(vec3(0.5F)));
  addObject(scene, makeBox("slab", dvec3(-6, 1.0, -6), dvec3(6, 1.5, 6)), test::makeGlass(1.5F));
  ReceiverFixture at(scene, vec3(-1.0F, 0.5F, 0.0F), vec3(-1.5F, 0, 0));
  const vec3 light(2.0F, 4.0F, 0.0F);
  const ChainReceiver receiver = at.receiver();
  ManifoldWalk walk(at.world, receiver);
  for (const vec3 aim : {vec3(-1.2F, 1, 0.4F), vec3(1.0F, 1, -0.5F), vec3(-3.0F, 1, 2.0F)}) {
    ASSERT_TRUE(at.follow(walk.chain(), normalize(aim - receiver.point().position), test::kThrough));
    ASSERT_TRUE(walk.solve(test::kThrough, {light, false}, 8.0F, at.sampler, at.rays));
    // Sines in air are 1.5 times those in glass: 1.0 m of air below, 0.5 m of glass, 2.5 m of air above, 3.5 m across.
    const double tangent = bisect(
        [](double t) {
          const double sine_glass = t / std::sqrt(1.0 + t * t) / 1.5;
          return 3.5 * t + 0.5 * sine_glass / std::sqrt(1.0 - sine_glass * sine_glass) - 3.5;
        },
        0.0, 2.0);
    EXPECT_NEAR(walk.chain().vertex(0).point.position.x, -1.5 + tangent, 1e-4);
    EXPECT_NEAR(walk.chain().vertex(0).point.position.z, 0.0, 1e-4);
    EXPECT_NEAR(walk.chain().vertex(1).point.position.x, 2.0 - 2.5 * tangent, 1e-4);
  }
}

TEST(ManifoldWalk, SolvesAlhazensProblem) {
  // Where on a ball is a point mirrored into another? Equal angles, in the plane of both and the centre.
  const SceneData scene = test::makeBallScene(test::makeMetal(vec3(1.0F)), 1024);
  ReceiverFixture at(scene, vec3(2.8F, 2, 0), vec3(2.5F, 0, 0));
  const vec3 light(1.2F, 4.0F, 0.0F);
  const dvec2 centre(0.0, 1.2), from(2.5, 0.0), to(1.2, 4.0);
  const double angle = bisect(
      [&](double a) {
        const dvec2 n(std::cos(a), std::sin(a)), p = centre + n, in = glm::normalize(from - p),
                                                 out = glm::normalize(to - p);
        return glm::dot(out, dvec2(-n.y, n.x)) * -1.0 + glm::dot(in, dvec2(n.y, -n.x));
      },
      -0.3, 1.2);
  const ChainReceiver receiver = at.receiver();
  ManifoldWalk walk(at.world, receiver);
  for (const vec3 aim : {vec3(0.9F, 1.3F, 0.3F), vec3(0.7F, 1.6F, -0.4F)}) {
    ASSERT_TRUE(at.follow(walk.chain(), normalize(aim - receiver.point().position), test::kMirror));
    ASSERT_TRUE(walk.solve(test::kMirror, {light, false}, 1.0F, at.sampler, at.rays));
    const vec3 found = walk.chain().vertex(0).point.position;
    EXPECT_NEAR(found.x, centre.x + std::cos(angle), 1e-4);
    EXPECT_NEAR(found.y, centre.y + std::sin(angle), 1e-4);
    EXPECT_NEAR(found.z, 0.0, 1e-4);
  }
}

TEST(ManifoldWalk, RunsAlongTheAxisOfABallLens) {
  SceneData scene = test::makeBallScene(test::makeGlass(1.5F), 1024);
  // Turned about its centre, so that no pole of the mesh is on the axis.
  const mat4 to_centre = glm::translate(mat4(1.0F), vec3(0, 1.2F, 0));
  scene.instances[1].world_from_object =
      to_centre * glm::rotate(mat4(1.0F), 1.0F, vec3(1, 0, 0)) * glm::inverse(to_centre);
  ReceiverFixture at(scene, vec3(2, 1, 0), vec3(0, 0, 0));
  const ChainReceiver receiver = at.receiver();
  ManifoldWalk walk(at.world, receiver);
  ASSERT_TRUE(at.follow(walk.chain(), normalize(vec3(0.08F, 1, 0.05F)), test::kThrough));
  ASSERT_TRUE(walk.solve(test::kThrough, {vec3(0, 6, 0), false}, 1.0F, at.sampler, at.rays));
  EXPECT_NEAR(length(walk.chain().dir() - vec3(0, 1, 0)), 0.0, 1e-3);
  // On the axis: thin lenses of the two surfaces, a distance 2 apart, spread a pencil of the point at 3.8 m above the
  // upper vertex to the area A(h)·ω: paraxial matrices, reduced by the index.
  //   [1 0.2; 0 1] · [1 0; −0.5 1] · [1 2/1.5; 0 1] · [1 0; −0.5 1] · [1 3.8; 0 1], element (0, 1)
  const double power = 0.5, thick = 2.0 / 1.5;
  double height = 3.8, angle = 1.0;
  angle -= power * height;
  height += thick * angle;
  angle -= power * height;
  height += 0.2 * angle;
  EXPECT_NEAR(walk.chain().spread(Bounce::kTransmit, vec3(0, 6, 0), false) / (height * height), 1.0, 0.01);
}

TEST(ManifoldWalk, ComesBackFromBeyondTheCriticalAngle) {
  SceneData scene;
  addObject(scene, test::makeFloor(20.0), test::makeDiffuse(vec3(0.5F)));
  Mesh water = makeRectangle("water", dvec3(0, 1, 0), dvec3(0, 0, 5), dvec3(5, 0, 0));
  addObject(scene, water, test::makeGlass(1.33F));
  ReceiverFixture at(scene, vec3(0.2F, 0.5F, 0), vec3(0, 0, 0));
  const ChainReceiver receiver = at.receiver();
  ManifoldWalk walk(at.world, receiver);
  // The seed is beyond the critical angle: the residual has a value there all the same.
  ASSERT_TRUE(at.follow(walk.chain(), normalize(vec3(1.3F, 1, 0)), test::kEntry));
  ASSERT_TRUE(walk.solve(test::kEntry, {normalize(vec3(1, 0.3F, 0)), true}, 7.0F, at.sampler, at.rays));
  const double sine = 1.0 / std::sqrt(1.09) / 1.33;
  EXPECT_NEAR(walk.chain().vertex(0).point.position.x, sine / std::sqrt(1.0 - sine * sine), 1e-4);
  // To a light below the horizon there is none.
  ASSERT_TRUE(at.follow(walk.chain(), normalize(vec3(0.3F, 1, 0)), test::kEntry));
  EXPECT_FALSE(walk.solve(test::kEntry, {normalize(vec3(1, -0.3F, 0)), true}, 7.0F, at.sampler, at.rays));
}

}  // namespace
}  // namespace nephroid
