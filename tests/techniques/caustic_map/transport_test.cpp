#include "techniques/caustic_map/transport.h"

#include <cmath>
#include <cstring>
#include <optional>

#include "closed_form/optics.h"
#include "core/optics/fresnel.shared.h"
#include "scene/load.h"
#include "support/gpu_fixture.h"
#include "support/tiny_scenes.h"
#include "techniques/caustic_map/light_rig.h"

namespace nephroid {
namespace {

constexpr std::uint32_t kGrid = 128;

using TransportTest = testing::GpuTest;
using testing::Flown;
using testing::LightRig;

/// A glass box over a floor.
SceneData makeSlab(vec3 sun, float ior = 1.5F) {
  SceneData scene;
  test::addObject(scene, test::makeFloor(12.0), test::makeDiffuse(vec3(0.6F)));
  test::addObject(scene, makeBox("slab", dvec3(-1, 1, -1), dvec3(1, 1.2, 1)), test::makeGlass(ior));
  scene.lights.push_back(test::makeSun(sun, vec3(1, 2, 3)));
  return scene;
}

TEST_F(TransportTest, ASlabMovesLightAside) {
  const vec3 dir = normalize(vec3(0.5F, -1, 0.2F));
  const SceneData scene = makeSlab(dir);
  LightRig rig(device(), scene);
  const Flown flown = rig.fly({.branch = 1});
  const double cos_i = -double{dir.y}, sin_i = std::sqrt(1.0 - cos_i * cos_i), sin_t = sin_i / 1.5,
               cos_t = std::sqrt(1.0 - sin_t * sin_t);
  const double r = fresnelDielectric(static_cast<float>(cos_i), 1.0F / 1.5F);
  int through = 0;
  for (const Photon& p : flown.photons) {
    if (!hasPhotonFlag(p, kPhotonValid)) continue;
    const vec3 start = rig.startOf(p);
    // Where it meets the upper face, and where it would leave the lower one.
    const dvec3 upper = dvec3(start) + (1.2 - start.y) / dir.y * dvec3(dir);
    const dvec2 across = dvec2(dir.x, dir.z) / sin_i;
    const dvec2 lower = dvec2(upper.x, upper.z) + across * (0.2 * sin_t / cos_t);
    // Through the sides light goes elsewhere.
    if (std::max(std::abs(upper.x), std::abs(upper.z)) > 0.97 || std::max(std::abs(lower.x), std::abs(lower.y)) > 0.97)
      continue;
    ++through;
    const dvec2 end = lower + across * (1.0 * sin_i / cos_i);
    ASSERT_NEAR(p.position.x, end.x, 2e-5) << p.index;
    ASSERT_NEAR(p.position.y, 0.0, 1e-5);
    ASSERT_NEAR(p.position.z, end.y, 2e-5);
    ASSERT_NEAR(dot(p.direction, dir), 1.0F, 1e-6F);
    ASSERT_NEAR(p.flux.y / (2.0 * rig.cellArea() * (1.0 - r) * (1.0 - r)), 1.0, 1e-4);
    ASSERT_NEAR(p.path_length, 1.0 / cos_i, 1e-4);
  }
  EXPECT_GT(through, 2000);
}

TEST_F(TransportTest, WhatASlabReflectsGoesUp) {
  // And what its sides reflect goes down.
  const vec3 dir = normalize(vec3(0.5F, -1, 0.2F));
  const SceneData scene = makeSlab(dir);
  const Flown flown = LightRig(device(), scene).fly({.branch = 0});
  int up = 0, down = 0;
  for (const Photon& p : flown.photons) {
    const std::uint32_t outcome = Flown::outcomeOf(p);
    if (outcome == kOutcomeEscaped && p.direction.y > 0.0F) ++up;
    if (outcome == kOutcomeDeposited) {
      ++down;
      EXPECT_NEAR(p.direction.y, dir.y, 1e-5F);
    }
  }
  EXPECT_GT(up, 2000);
  EXPECT_GT(down, 50);
  EXPECT_EQ(flown.outcomes.count(kOutcomeHidden), 0U);
}

/// Through a ball of radius 1 at (0, 1.2, 0) by formulas; straight down at distance `b` from its axis.
struct BallLens {
  double end;    ///< distance from the axis at y = 0, signed
  double share;  ///< of flux
};
BallLens throughBall(double b, double n) {
  const double i = std::asin(b), t = std::asin(b / n);
  // After both refractions the ray is turned by 2 (i − t), and leaves at the angle 2t − i below the axis.
  const double turn = 2.0 * (i - t), at = 2.0 * t - i;
  const double x = std::sin(at), y = 1.2 - std::cos(at);
  const double r = fresnelDielectric(static_cast<float>(std::cos(i)), static_cast<float>(1.0 / n));
  return {x - y * std::tan(turn), (1.0 - r) * (1.0 - r)};
}

TEST_F(TransportTest, ABallFocuses) {
  SceneData scene = test::makeBallScene(test::makeGlass(1.5F), 512);
  scene.lights.push_back(test::makeSun(vec3(0, -1, 0), vec3(1)));
  LightRig rig(device(), scene);
  const Flown flown = rig.fly({.branch = 1});
  int through = 0, inside = 0;
  double worst = 0.0, sum = 0.0;
  for (const Photon& p : flown.photons) {
    const vec3 start = rig.startOf(p);
    const double b = std::hypot(double{start.x}, double{start.z});
    // At the rim the facets count.
    if (b > 0.97 || b < 1e-3) continue;
    ++inside;
    if (!hasPhotonFlag(p, kPhotonValid)) continue;
    ++through;
    const BallLens lens = throughBall(b, 1.5);
    const double found = (double{p.position.x} * start.x + double{p.position.z} * start.z) / b;
    worst = std::max(worst, std::abs(found - lens.end));
    sum += std::abs(found - lens.end);
    ASSERT_NEAR(p.flux.x / rig.cellArea(), lens.share, 3e-3);
  }
  EXPECT_GT(inside, 5000);
  EXPECT_EQ(through, inside);
  EXPECT_LT(worst, 1e-2);
  EXPECT_LT(sum / through, 2e-4);
}

TEST_F(TransportTest, CellsThatMissABallAreThoseInTheCorners) {
  // A disc in its square has π/4 of it, less what the picture's margin of 0.1 % a side takes.
  for (const vec3& dir : {vec3(0, -1, 0), vec3(1, -2, 0.7F)}) {
    SceneData scene = test::makeBallScene(test::makeGlass(1.5F), 256);
    scene.lights.push_back(test::makeSun(dir, vec3(1)));
    const Flown flown = LightRig(device(), scene).fly({.branch = 0});
    const int beside = flown.outcomes.at(kOutcomeBlocked);
    EXPECT_NEAR(1.0 - beside / static_cast<double>(kGrid * kGrid), 0.25 * kPi / (1.001 * 1.001), 0.005);
  }
}

TEST_F(TransportTest, EveryPhotonSaysWhatBecameOfIt) {
  SceneData scene = test::makeBallScene(test::makeGlass(1.5F), 128);
  // A board that shades half of the ball.
  test::addObject(scene, makeRectangle("board", dvec3(1.0, 3.0, 0.0), dvec3(0, 0, 1.5), dvec3(1.0, 0, 0)),
                  test::makeDiffuse(vec3(0.5F)));
  scene.lights.push_back(test::makePoint(vec3(0, 6, 0), vec3(10)));
  const Flown flown = LightRig(device(), scene).fly({.branch = 1});
  int sum = 0;
  for (const auto& [outcome, count] : flown.outcomes) sum += count;
  EXPECT_EQ(sum, static_cast<int>(kGrid * kGrid));
  // In the corners of the square light passes the ball and meets the floor, which bends nothing.
  EXPECT_GT(flown.outcomes.at(kOutcomeBlocked), static_cast<int>(kGrid * kGrid / 2));
  EXPECT_GT(flown.outcomes.at(kOutcomeDeposited), 3500);
}

/// An equilateral prism of side 1 over a floor; its base is level.
SceneData makePrismScene(const Material& glass, double floor = 40.0) {
  SceneData scene;
  test::addObject(scene, test::makeFloor(floor), test::makeDiffuse(vec3(0.6F)));
  const dvec2 corners[] = {{-0.5, 2.0}, {0.5, 2.0}, {0.0, 2.0 + std::sqrt(0.75)}};
  test::addObject(scene, makePrism("prism", corners, -1.0, 1.0), glass);
  return scene;
}

/// The branches' ends, added up: with each branch more of what was emitted.
void expectBranchesShareTheLight(gpu::Device& device, const SceneData& scene, double share_of_eight) {
  LightRig rig(device, scene);
  const double emitted = rig.emitted().y;
  const Flown first = rig.fly({.branch = 0, .max_events = 24});
  double sum = first.fluxOf(kOutcomeMissed).y + first.fluxOf(kOutcomeBlocked).y + first.fluxAfterGenerators().y;
  for (std::uint32_t branch = 1; branch < 8; ++branch) {
    const Flown flown = rig.fly({.branch = branch, .max_events = 24});
    EXPECT_EQ(flown.fluxOf(kOutcomeBlocked).y, 0.0);
    EXPECT_GE(flown.fluxAfterGenerators().y, 0.0) << branch;
    sum += flown.fluxAfterGenerators().y;
    EXPECT_LE(sum, emitted * (1.0 + 1e-5)) << branch;
  }
  EXPECT_GT(sum, emitted * share_of_eight);
}

TEST_F(TransportTest, BranchesOfAPrismShareTheLight) {
  SceneData scene = makePrismScene(test::makeGlass(1.5F));
  scene.lights.push_back(test::makeSun(vec3(0.1F, -1, 0.3F), vec3(2)));
  expectBranchesShareTheLight(device(), scene, 0.999);
}

TEST_F(TransportTest, BranchesOfACubeShareTheLight) {
  SceneData scene;
  test::addObject(scene, test::makeFloor(20.0), test::makeDiffuse(vec3(0.6F)));
  test::addObject(scene, makeBox("cube", dvec3(-0.5, 1, -0.5), dvec3(0.5, 2, 0.5)), test::makeGlass(1.5F));
  scene.lights.push_back(test::makeSun(vec3(0.5F, -1, 0.2F), vec3(2)));
  expectBranchesShareTheLight(device(), scene, 0.99);
}

TEST_F(TransportTest, BranchesOfABallShareTheLight) {
  SceneData scene = test::makeBallScene(test::makeGlass(1.5F), 128);
  scene.lights.push_back(test::makePoint(vec3(1, 6, 0), vec3(10)));
  expectBranchesShareTheLight(device(), scene, 0.999);
}

/// Angle of deviation of a ray through an equilateral prism, in its plane; nothing if it does not leave the second
/// face.
std::optional<double> deviate(dvec2 dir, double index) {
  const dvec2 left = dvec2(-std::sqrt(0.75), 0.5), right = dvec2(std::sqrt(0.75), 0.5);
  const auto inside = closed_form::refract(dir, left, 1.0, index);
  const auto out = inside ? closed_form::refract(*inside, -right, index, 1.0) : std::nullopt;
  if (!out) return std::nullopt;
  return std::acos(dot(dir, *out));
}

TEST_F(TransportTest, APrismDeviatesEachBandByItsIndex) {
  constexpr double kIndex = 1.5, kAbbe = 20.0;
  Material glass = test::makeGlass(kIndex);
  glass.dispersion = 20.0F / static_cast<float>(kAbbe);
  SceneData scene = makePrismScene(glass, 2.0);
  // Not far from the smallest deviation, from the left and below; light that the base reflects turns by 2 · 0.2 rad.
  const dvec2 dir = normalize(dvec2(std::cos(0.2), std::sin(0.2)));
  scene.lights.push_back(test::makeSun(vec3(dvec3(dir, 0.0)), vec3(2)));
  LightRig rig(device(), scene);
  double first = 0.0, last = 0.0;
  const std::vector<Band> bands = makeBands(6);
  for (std::uint32_t b = 0; b < bands.size(); ++b) {
    const auto wanted = deviate(dir, closed_form::cauchyIndex(kIndex, kAbbe, bands[b].wavelength_nm));
    ASSERT_TRUE(wanted);
    int through = 0;
    double worst = 0.0;
    for (const Photon& p : rig.fly({.branch = 1, .band = bands[b], .band_index = b}).photons) {
      const std::uint32_t outcome = Flown::outcomeOf(p);
      ASSERT_EQ(photonBand(p), b);
      if ((outcome != kOutcomeEscaped && outcome != kOutcomeDeposited) || std::abs(p.direction.z) > 1e-4F) continue;
      const double found = std::acos(std::min(dot(dir, dvec2(p.direction.x, p.direction.y)), 1.0));
      // Through the base and after total reflection it goes elsewhere.
      if (std::abs(found - *wanted) > 0.1) continue;
      ++through;
      worst = std::max(worst, std::abs(found - *wanted));
    }
    EXPECT_GT(through, 2000) << b;
    EXPECT_LT(closed_form::degreesD(worst), 0.01) << b;
    (b == 0 ? first : last) = *wanted;
  }
  // Blue is bent more, by more than what is tolerated.
  EXPECT_GT(closed_form::degreesD(first - last), 2.0);
}

TEST_F(TransportTest, BandsAddUpToOneWhereNothingDisperses) {
  SceneData scene = test::makeBallScene(test::makeGlass(1.5F), 96);
  scene.lights.push_back(test::makeSun(vec3(0.3F, -1, 0), vec3(1, 2, 3)));
  LightRig rig(device(), scene);
  const Flown one = rig.fly({.branch = 1});
  std::vector<dvec3> sums(one.photons.size(), dvec3(0.0));
  const std::vector<Band> bands = makeBands(5);
  for (std::uint32_t b = 0; b < bands.size(); ++b) {
    const Flown flown = rig.fly({.branch = 1, .band = bands[b], .band_index = b});
    for (std::size_t i = 0; i < sums.size(); ++i) {
      sums[i] += dvec3(flown.photons[i].flux);
      ASSERT_EQ(flown.photons[i].position, one.photons[i].position);
      ASSERT_EQ(Flown::outcomeOf(flown.photons[i]), Flown::outcomeOf(one.photons[i]));
    }
  }
  for (std::size_t i = 0; i < sums.size(); ++i)
    for (int c = 0; c < 3; ++c) ASSERT_NEAR(sums[i][c], one.photons[i].flux[c], 2e-6 * rig.cellArea() * 3.0);
}

TEST_F(TransportTest, WhatLiesInWaterBelongsToOneBranch) {
  // An open surface: below it light never comes to leave.
  SceneData scene;
  test::addObject(scene, test::makeFloor(8.0), test::makeDiffuse(vec3(0.6F)));
  test::addObject(scene, makeRectangle("water", dvec3(0, 1, 0), dvec3(0, 0, 2), dvec3(2, 0, 0)),
                  test::makeGlass(1.33F));
  scene.lights.push_back(test::makeSun(vec3(0.3F, -1, 0), vec3(2)));
  LightRig rig(device(), scene);
  const double beside = rig.fly({.branch = 0}).fluxOf(kOutcomeBlocked).y;
  EXPECT_GT(rig.fly({.branch = 1}).fluxOf(kOutcomeDeposited).y, 0.95 * (rig.emitted().y - beside));
  for (const std::uint32_t branch : {2U, 3U}) {
    const Flown flown = rig.fly({.branch = branch});
    EXPECT_EQ(flown.fluxAfterGenerators().y, 0.0) << branch;
    EXPECT_EQ(flown.outcomes.count(kOutcomeDeposited), 0U) << branch;
  }
}

/// Whether lists of cells and forks lead to the same photons as all cells, each branch on its own.
/// @return  valid photons by branch
std::vector<int> expectSameByLists(gpu::Device& device, const SceneData& scene) {
  LightRig rig(device, scene);
  std::vector<int> valid(4);
  for (std::uint32_t branch = 0; branch < 4; ++branch) {
    const Flown all = rig.fly({.branch = branch}), listed = rig.flyListed({.branch = branch});
    int different = 0;
    for (std::size_t i = 0; i < all.photons.size(); ++i) {
      const Photon &a = all.photons[i], &b = listed.photons[i];
      const bool is_valid = hasPhotonFlag(a, kPhotonValid);
      valid[branch] += is_valid ? 1 : 0;
      const bool same = is_valid ? std::memcmp(&a, &b, sizeof(Photon)) == 0 : !hasPhotonFlag(b, kPhotonValid);
      different += same ? 0 : 1;
    }
    EXPECT_EQ(different, 0) << branch;
  }
  return valid;
}

TEST_F(TransportTest, ListsOfCellsLeaveOutNothing) {
  // A ball and a black box: of the cells some meet glass, some what blocks, some nothing.
  SceneData scene = test::makeBallScene(test::makeGlass(1.5F), 64);
  test::addObject(scene, makeBox("blocker", dvec3(0.5, 2.5, -1), dvec3(1.5, 2.6, 1)), test::makeDiffuse(vec3(0.0F)));
  scene.lights.push_back(test::makeSun(vec3(0, -1, 0), vec3(1.0F)));
  const std::vector<int> valid = expectSameByLists(device(), scene);
  EXPECT_GT(valid[1], 1000);
  EXPECT_GT(valid[3], 100);
}

TEST_F(TransportTest, ForksAreTakenUpInsideOfWhatTheyWereInsideOf) {
  // Solids in solids that absorb, and what lets light pass straight through.
  for (const char* name : {"builtin:cognac", "builtin:sphere-in-box", "builtin:pool"}) {
    SceneData scene = loadScene(name);
    completeScene(scene);
    const std::vector<int> valid = expectSameByLists(device(), scene);
    EXPECT_GT(valid[1], 100) << name;
  }
  SceneData scene = test::makeBallScene(test::makeGlass(1.5F), 64);
  Material pane = test::makeGlass(1.5F);
  pane.thickness = 0.0F;
  test::addObject(scene, makeBox("panes", dvec3(-1, 2.5, -1), dvec3(0.2, 2.6, 1)), pane);
  scene.lights.push_back(test::makeSun(vec3(0, -1, 0), vec3(1.0F)));
  EXPECT_GT(expectSameByLists(device(), scene)[3], 10);
}

/// What interpolation makes of photons that are followed too.
struct Interpolated {
  double worst = 0.0, mean = 0.0;  ///< distance between places, over the mean distance of neighbours
  double flux = 0.0;               ///< of all, over that of those that are followed
  double followed = 0.0;           ///< share of cells
  int valid = 0, torn = 0;         ///< photons; those that only one of both has, or that took another way
};
Interpolated interpolate(LightRig& rig, std::uint32_t branch, std::uint32_t spacing) {
  const Flown all = rig.flyListed({.branch = branch});
  const double cells = rig.followed(branch);
  const Flown some = rig.flyListed({.branch = branch, .spacing = spacing});
  Interpolated result{.flux = some.fluxOf(kOutcomeDeposited).y / all.fluxOf(kOutcomeDeposited).y,
                      .followed = rig.followed(branch) / cells};
  double apart = 0.0;
  for (std::size_t i = 0; i < all.photons.size(); ++i) {
    const Photon &a = all.photons[i], &b = some.photons[i];
    const bool is_valid = hasPhotonFlag(a, kPhotonValid);
    if (is_valid != hasPhotonFlag(b, kPhotonValid) || (is_valid && a.chain != b.chain)) ++result.torn;
    if (!is_valid || !hasPhotonFlag(b, kPhotonValid)) continue;
    EXPECT_EQ(b.index, i);
    ++result.valid;
    const double off = length(dvec3(a.position) - dvec3(b.position));
    result.worst = std::max(result.worst, off), result.mean += off;
    const Photon& next = all.photons[i + 1 < all.photons.size() ? i + 1 : i];
    if (hasPhotonFlag(next, kPhotonValid) && next.chain == a.chain) apart += length(dvec3(next.position - a.position));
  }
  result.worst /= apart / result.valid, result.mean /= apart;
  return result;
}

TEST_F(TransportTest, InterpolatedPhotonsEndWhereFollowedOnesDo) {
  SceneData scene = test::makeBallScene(test::makeGlass(1.5F), 512);
  scene.lights.push_back(test::makeSun(vec3(0.2F, -1, 0.1F), vec3(1)));
  LightRig rig(device(), scene, 256);
  for (const std::uint32_t branch : {0U, 1U, 3U})
    for (const std::uint32_t spacing : {2U, 4U}) {
      const Interpolated found = interpolate(rig, branch, spacing);
      SCOPED_TRACE(::testing::Message() << "branch " << branch << " spacing " << spacing);
      EXPECT_LT(found.worst, 0.05);
      EXPECT_LT(found.mean, 0.005);
      EXPECT_NEAR(found.flux, 1.0, 1e-3);
      EXPECT_EQ(found.torn, 0);
      EXPECT_LT(found.followed, 0.5);
      EXPECT_GT(found.valid, 1000);
    }
}

TEST_F(TransportTest, NothingIsInterpolatedAcrossWhatBlocksLight) {
  SceneData scene = test::makeBallScene(test::makeGlass(1.5F), 512);
  // A cell or two wide, some between those that are followed first.
  for (const double z : {-0.4, -0.292, -0.184, -0.076})
    test::addObject(scene, makeBox("bar", dvec3(-2, 2.5, z), dvec3(2, 2.52, z + 0.012)), test::makeDiffuse(vec3(0.0F)));
  scene.lights.push_back(test::makeSun(vec3(0, -1, 0), vec3(1)));
  LightRig rig(device(), scene, 256);
  const Interpolated found = interpolate(rig, 1, 4);
  EXPECT_EQ(found.torn, 0);
  EXPECT_LT(found.followed, 0.6);
}

TEST_F(TransportTest, WhatVariesByTexturesIsFollowed) {
  SceneData scene = test::makeBallScene(test::makeGlass(1.5F), 512);
  for (Mesh& mesh : scene.meshes) mesh.colors.assign(mesh.positions.size(), vec4(1.0F));
  scene.lights.push_back(test::makeSun(vec3(0.2F, -1, 0.1F), vec3(1)));
  LightRig rig(device(), scene);
  const Interpolated found = interpolate(rig, 1, 4);
  EXPECT_EQ(found.followed, 1.0);
  EXPECT_EQ(found.torn, 0);
}

TEST_F(TransportTest, PicturesLeadWhereTheTreeDoes) {
  SceneData ball = test::makeBallScene(test::makeGlass(1.5F), 256);
  ball.lights.push_back(test::makeSun(vec3(0.2F, -1, 0.1F), vec3(1)));
  const SceneData slab = makeSlab(normalize(vec3(0.5F, -1, 0.2F)));
  for (const SceneData* scene : {static_cast<const SceneData*>(&ball), &slab}) {
    LightRig rig(device(), *scene, 256);
    for (const std::uint32_t branch : {0U, 1U, 2U}) {
      const Flown tree = rig.fly({.branch = branch}), pictures = rig.fly({.branch = branch, .search = Search::kPlanes});
      int same = 0, all = 0;
      for (std::size_t i = 0; i < tree.photons.size(); ++i) {
        const Photon &a = tree.photons[i], &b = pictures.photons[i];
        if (!hasPhotonFlag(a, kPhotonValid) && !hasPhotonFlag(b, kPhotonValid)) continue;
        ++all;
        same += a.chain == b.chain && length(a.position - b.position) < 1e-4F ? 1 : 0;
      }
      EXPECT_GE(same, 0.999 * all) << branch;
      EXPECT_GT(all, branch == 1 ? 10000 : -1);
    }
  }
}

}  // namespace
}  // namespace nephroid
