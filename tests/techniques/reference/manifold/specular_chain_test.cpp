// Derivatives of chains against finite differences.
#include "techniques/reference/manifold/specular_chain.h"

#include <glm/gtc/matrix_transform.hpp>

#include "receiver_fixture.h"

namespace nephroid {
namespace {

using test::addObject;
using test::ReceiverFixture;

struct ChainCase {
  const char* name;
  Material material;
  ChainKind kind;
  bool at_infinity;
  bool instanced;
  friend void PrintTo(const ChainCase& c, std::ostream* out) { *out << c.name; }
};

/// A coarse ball with smooth normals: triangles are large against a step, and normals turn much on each.
SceneData makeScene(const ChainCase& c) {
  SceneData scene = test::makeBallScene(c.material, 16);
  if (!c.instanced) return scene;
  // Turned and stretched, and placed twice, so that it is not baked.
  scene.instances[1].world_from_object =
      glm::scale(glm::rotate(mat4(1.0F), 0.4F, normalize(vec3(1, 2, 0))), vec3(1.0F, 1.2F, 0.9F));
  scene.instances.push_back(scene.instances[1]);
  scene.instances.back().world_from_object[3] += vec4(50, 0, 0, 0);
  return scene;
}

class ChainDerivatives : public testing::TestWithParam<ChainCase> {
 protected:
  ChainDerivatives() : scene_(makeScene(GetParam())), at_(scene_, vec3(2.2F, 3, 0.3F), vec3(1.3F, 0, 0.4F)) {}
  vec3 light() const { return GetParam().at_infinity ? normalize(vec3(0.3F, 1, -0.2F)) : vec3(0.4F, 4.0F, -0.9F); }

  SceneData scene_;
  ReceiverFixture at_;
};

TEST_P(ChainDerivatives, AreThoseOfFiniteDifferences) {
  const ChainReceiver receiver = at_.receiver();
  const ChainKind& kind = GetParam().kind;
  SpecularChain chain(at_.world, receiver), beside(at_.world, receiver);
  int compared = 0;
  for (int i = 0; i < 64; ++i) {
    const vec3 aim(-0.4F + 0.11F * static_cast<float>(i % 8), 0.9F + 0.09F * static_cast<float>(i / 8), 0.1F);
    const vec3 dir = normalize(aim - receiver.point().position);
    if (!at_.follow(chain, dir, kind)) continue;
    const ChainConstraint here = chain.constrain(kind.last(), light(), GetParam().at_infinity);
    for (const bool along_y : {false, true}) {
      // The residual is a vector across the normal of the vertex; it is compared in the axes of the middle one, where
      // the turn of the frame does not count to first order if the residual is projected as a vector.
      constexpr float kStep = 2e-3F;
      const vec3 axis = along_y ? chain.axes().y : chain.axes().x;
      vec3 residuals[2];
      bool same_triangles = true;
      for (const int side : {0, 1}) {
        const vec3 turned = normalize(dir + (side == 0 ? -kStep : kStep) * axis);
        same_triangles = same_triangles && at_.follow(beside, turned, kind);
        for (int k = 0; same_triangles && k < kind.count; ++k)
          same_triangles = beside.vertex(k).point.triangle == chain.vertex(k).point.triangle &&
                           beside.vertex(k).point.instance == chain.vertex(k).point.instance;
        if (!same_triangles) break;
        const ChainConstraint c = beside.constrain(kind.last(), light(), GetParam().at_infinity);
        const Frame frame = Frame::fromZ(beside.normalAt(kind.count - 1));
        residuals[side] = c.residual.x * frame.x + c.residual.y * frame.y;
      }
      if (!same_triangles) continue;
      const Frame frame = Frame::fromZ(chain.normalAt(kind.count - 1));
      const vec3 change = (residuals[1] - residuals[0]) / (2.0F * kStep);
      const vec2 measured(dot(change, frame.x), dot(change, frame.y));
      const vec2 exact = along_y ? here.by_y : here.by_x;
      // Positions have 1e-7, over the step 5e-5; the rest is the third derivative.
      EXPECT_LT(length(measured - exact), 2e-3F * std::max(length(exact), 1.0F))
          << i << ": " << measured.x << ", " << measured.y << " and " << exact.x << ", " << exact.y;
      ++compared;
    }
  }
  EXPECT_GE(compared, 8);
}

INSTANTIATE_TEST_SUITE_P(
    Kinds, ChainDerivatives,
    testing::Values(ChainCase{"mirror", test::makeMetal(vec3(1.0F)), test::kMirror, false, false},
                    ChainCase{"mirror_sun", test::makeMetal(vec3(1.0F)), test::kMirror, true, false},
                    ChainCase{"mirror_placed_twice", test::makeMetal(vec3(1.0F)), test::kMirror, false, true},
                    ChainCase{"entry", test::makeGlass(1.5F), test::kEntry, false, false},
                    ChainCase{"through", test::makeGlass(1.5F), test::kThrough, false, false},
                    ChainCase{"through_sun", test::makeGlass(1.33F), test::kThrough, true, false},
                    ChainCase{"through_placed_twice", test::makeGlass(1.5F), test::kThrough, false, true}),
    [](const auto& tested) { return std::string(tested.param.name); });

struct SpreadCase {
  const char* name;
  Material material;
  ChainKind kind;
  vec3 receiver, light, aim;
  friend void PrintTo(const SpreadCase& c, std::ostream* out) { *out << c.name; }
};

class ChainSpread : public testing::TestWithParam<SpreadCase> {
 protected:
  struct Way {
    vec3 dir;  ///< at which light leaves its place
    std::array<std::uint32_t, 2> triangles{};
    float spread = 0.0F;
  };
  std::optional<Way> find(vec3 target) const {
    const SpreadCase& c = GetParam();
    ReceiverFixture at(scene_, target + vec3(0.9F, 0.1F, 0.4F), target);
    const ChainReceiver receiver = at.receiver();
    ManifoldWalk walk(at.world, receiver);
    // From some place nearby or another: facets may hold walks up.
    bool found = false;
    for (int i = 0; i < 25 && !found; ++i) {
      const vec3 aim = c.aim + vec3(0.1F * static_cast<float>(i % 5 - 2), 0, 0.1F * static_cast<float>(i / 5 - 2));
      found = at.follow(walk.chain(), normalize(aim - receiver.point().position), c.kind) &&
              walk.solve(c.kind, {c.light, false}, 1.0F, at.sampler, at.rays);
    }
    if (!found) return std::nullopt;
    const SpecularChain& chain = walk.chain();
    Way way{-chain.towardsLight(c.light, false), {}, chain.spread(c.kind.last(), c.light, false)};
    for (int k = 0; k < c.kind.count; ++k) way.triangles[k] = chain.vertex(k).point.triangle;
    return way;
  }

 private:
  SceneData scene_ = test::makeBallScene(GetParam().material, 24);
};

/// How the direction at which light leaves its place turns as the receiver moves: the inverse of the spread.
TEST_P(ChainSpread, IsThatOfNeighbouringReceivers) {
  // Neighbours are on the same triangles, so small is the step.
  constexpr float kStep = 1e-3F;
  const vec3 middle = GetParam().receiver;
  const auto here = find(middle);
  ASSERT_TRUE(here);
  vec3 turns[2];
  for (const int axis : {0, 1}) {
    const vec3 shift = axis == 0 ? vec3(kStep, 0, 0) : vec3(0, 0, kStep);
    const auto before = find(middle - shift), after = find(middle + shift);
    ASSERT_TRUE(before && after);
    ASSERT_TRUE(before->triangles == here->triangles && after->triangles == here->triangles) << "move the receiver";
    turns[axis] = (after->dir - before->dir) / (2.0F * kStep);
  }
  EXPECT_NEAR(1.0F / (here->spread * length(cross(turns[0], turns[1]))), 1.0F, 0.02F);
}

INSTANTIATE_TEST_SUITE_P(Kinds, ChainSpread,
                         testing::Values(SpreadCase{"mirror", test::makeMetal(vec3(1.0F)), test::kMirror,
                                                    vec3(1.6F, 0, 0.4F), vec3(4, 3, -1), vec3(0.9F, 1.3F, 0.1F)},
                                         SpreadCase{"through", test::makeGlass(1.5F), test::kThrough,
                                                    vec3(0.07F, 0, 0.03F), vec3(0.3F, 6, 0.2F),
                                                    vec3(0.1F, 1.2F, 0.1F)}),
                         [](const auto& tested) { return std::string(tested.param.name); });

}  // namespace
}  // namespace nephroid
