#include "techniques/caustic_map/photon_ledger.h"

#include <cmath>

#include "scene/load.h"
#include "support/gpu_fixture.h"
#include "support/tiny_scenes.h"
#include "techniques/caustic_map/light_rig.h"

namespace nephroid {
namespace {

using PhotonLedgerTest = testing::GpuTest;
using testing::LightRig;

dvec3 lostTo(const Ledger& ledger, LossReason reason) { return ledger.lost[static_cast<std::size_t>(reason)]; }

/// What the reference says of the same scene, from two million photons.
Ledger referenceLedger(const SceneData& scene) {
  const Camera camera = makeCamera("above", vec3(0, 9, 0.1F), vec3(0), 0.8F);
  const RenderResult result = test::renderReference(scene, camera, test::makeSettings(16, 1, 2000000, {"caustic"}));
  return result.ledgers.at(0);
}

void expectCloses(const Ledger& ledger) {
  EXPECT_GT(ledger.emitted.y, 0.0);
  EXPECT_LE(ledger.residual(), 1e-5) << formatLedgers({ledger});
}

Material makeColoured() {
  Material m = test::makeGlass(1.5F);
  m.attenuation_color = vec3(0.1F, 0.5F, 0.9F);
  m.attenuation_distance = 1.0F;
  return m;
}

TEST_F(PhotonLedgerTest, ClosesForSolidsAndMetal) {
  Material varnished = test::makeDiffuse(vec3(0.5F, 0.4F, 0.3F));
  varnished.metallic = 0.5F;
  varnished.roughness = 0.0F;
  for (const Material& material : {test::makeGlass(1.5F), makeColoured(), test::makeMetal(vec3(0.9F, 0.6F, 0.3F)),
                                   varnished, test::makeGlass(1.5F, 0.4F), test::makeMetal(vec3(0.9F), 0.3F)}) {
    SceneData scene = test::makeBallScene(material, 64);
    test::addObject(scene, makeBox("cube", dvec3(1.2, 1, -0.5), dvec3(2.2, 2, 0.5)), material);
    scene.lights.push_back(test::makeSun(vec3(-0.7F, -1, 0.2F), vec3(2, 3, 5)));
    LightRig rig(device(), scene);
    for (const std::uint32_t last : {0U, 1U, 4U}) expectCloses(rig.ledger(last));
    expectCloses(rig.ledger(2, {.follows_weaker = true}));
  }
}

TEST_F(PhotonLedgerTest, ClosesForBuiltInScenes) {
  for (const char* name : {"builtin:ring", "builtin:prism", "builtin:slab", "builtin:cube", "builtin:cognac"}) {
    SCOPED_TRACE(name);
    const SceneData scene = loadScene(name);
    LightRig rig(device(), scene);
    expectCloses(rig.ledger(2));
  }
}

TEST_F(PhotonLedgerTest, ClosesForACubeOfViews) {
  SceneData scene = test::makeBallScene(makeColoured(), 96);
  // So near that it sees the ball at 63° about its middle: from where it is 56° or less one fitted frustum holds it,
  // and there are no other views whose borders might lose or count light twice.
  scene.lights.push_back(test::makePoint(vec3(0.65F, 1.85F, 0.65F), vec3(2, 3, 5)));
  LightRig rig(device(), scene);
  ASSERT_GT(rig.viewCount(), 1U);
  expectCloses(rig.ledger(3));
}

TEST_F(PhotonLedgerTest, ClosesForBands) {
  Material glass = makeColoured();
  glass.dispersion = 1.0F;
  SceneData scene = test::makeBallScene(glass, 96);
  scene.lights.push_back(test::makeSun(vec3(0.3F, -1, 0), vec3(1, 2, 3)));
  LightRig rig(device(), scene);
  Ledger sum;
  // Weights may be negative, so shares of single bands say little: the sum is the light's.
  for (const Band& band : makeBands(4)) sum.add(rig.ledger(2, {.band = band}));
  expectCloses(sum);
  for (int c = 0; c < 3; ++c) EXPECT_NEAR(sum.emitted[c] / rig.emitted()[c], 1.0, 1e-5);
  EXPECT_GT(sum.deposited.y, 0.1 * sum.emitted.y);
}

TEST_F(PhotonLedgerTest, TwoRunsAreEqual) {
  SceneData scene = test::makeBallScene(makeColoured(), 96);
  scene.lights.push_back(test::makePoint(vec3(1, 5, 1), vec3(2, 3, 5)));
  LightRig rig(device(), scene);
  const Ledger first = rig.ledger(2), second = rig.ledger(2);
  EXPECT_EQ(first.deposited, second.deposited);
  EXPECT_EQ(first.absorbed, second.absorbed);
  EXPECT_EQ(first.lostTotal(), second.lostTotal());
}

TEST_F(PhotonLedgerTest, AgreesWithTheReferenceForABall) {
  for (const bool is_sun : {true, false}) {
    SCOPED_TRACE(is_sun ? "sun" : "point");
    SceneData scene = test::makeBallScene(makeColoured(), 128);
    scene.lights.push_back(is_sun ? test::makeSun(vec3(-0.4F, -1, -0.2F), vec3(3))
                                  : test::makePoint(vec3(1, 5, 1), vec3(9)));
    // Red is left at the rim alone, which reflects all of it: 0.2 % more cells that meet the ball than its disc has, as
    // of the point's in a grid of 128, are 2.8 % of red. In grids of 64, 128, 192, 256 and 384 it was 6.4, 2.8, 0.8,
    // −0.1 and 0.3 % off, and so is, in proportion, the count of cells.
    LightRig rig(device(), scene, 256);
    const Ledger ledger = rig.ledger(7, {.max_events = 12}), reference = referenceLedger(scene);
    expectCloses(ledger);
    for (int c = 0; c < 3; ++c) {
      EXPECT_NEAR(ledger.deposited[c] / reference.deposited[c], 1.0, 0.01);
      EXPECT_NEAR(ledger.absorbed[c] / reference.absorbed[c], 1.0, 0.01);
      EXPECT_NEAR(ledger.escaped[c] / reference.escaped[c], 1.0, 0.02);
    }
  }
}

TEST_F(PhotonLedgerTest, AgreesWithTheReferenceForRoughBalls) {
  for (const Material& material : {test::makeGlass(1.5F, 0.4F), test::makeMetal(vec3(0.9F), 0.4F)}) {
    SCOPED_TRACE(material.name);
    SceneData scene = test::makeBallScene(material, 128);
    scene.lights.push_back(test::makeSun(vec3(-0.4F, -1, -0.2F), vec3(3)));
    LightRig rig(device(), scene, 192);
    const Ledger ledger = rig.ledger(5, {.max_events = 12, .seed = 3}), reference = referenceLedger(scene);
    expectCloses(ledger);
    EXPECT_NEAR(ledger.deposited.y / reference.deposited.y, 1.0, 0.02);
    const dvec3 facets = lostTo(ledger, LossReason::kMicrofacet), wanted = lostTo(reference, LossReason::kMicrofacet);
    EXPECT_NEAR(facets.y / ledger.deposited.y, wanted.y / reference.deposited.y, 0.01);
  }
}

TEST_F(PhotonLedgerTest, LightReachesWhatIsNearerThanATexel) {
  // A millimetre under a slab that bends nothing, in pictures with texels of 5 cm across which depths differ as much.
  for (const bool is_sun : {true, false}) {
    SCOPED_TRACE(is_sun ? "sun" : "point");
    SceneData scene;
    test::addObject(scene, test::makeFloor(4.0), test::makeDiffuse(vec3(0.6F)));
    test::addObject(scene, makeBox("slab", dvec3(-1, 0.001, -1), dvec3(1, 0.3, 1)), test::makeGlass(1.0F));
    scene.lights.push_back(is_sun ? test::makeSun(vec3(1, -1, 0.3F), vec3(3))
                                  : test::makePoint(vec3(-2, 2.3F, -0.6F), vec3(9)));
    LightRig rig(device(), scene, 64);
    const Ledger ledger = rig.ledger(1);
    expectCloses(ledger);
    EXPECT_NEAR(ledger.deposited.y / (ledger.emitted.y - ledger.missed.y - ledger.blocked.y), 1.0, 1e-3)
        << formatLedgers({ledger});
  }
}

TEST_F(PhotonLedgerTest, FindsTheWayOutBesideEdges) {
  // The pictures show little of sides that are seen edge-on, and a ray beside an edge leaves within a texel.
  SceneData scene = test::makeBallScene(test::makeGlass(1.5F));
  scene.instances.pop_back();
  test::addObject(scene, makeBox("block", dvec3(-0.5, 0.2, -0.3), dvec3(0.5, 1, 0.3)), test::makeGlass(1.5F));
  scene.lights.push_back(test::makeSun(vec3(0, -1, 0), vec3(5)));
  for (const int degree : {38, 45, 61, 72}) {
    SCOPED_TRACE(degree);
    const float angle = radians(static_cast<float>(degree));
    scene.lights[0].direction = normalize(vec3(std::cos(angle), -2.0F, std::sin(angle)));
    LightRig rig(device(), scene, 64);
    const Ledger ledger = rig.ledger(1);
    expectCloses(ledger);
    EXPECT_LT(lostTo(ledger, LossReason::kHidden).y, 1e-3 * ledger.emitted.y);
  }
}

TEST_F(PhotonLedgerTest, FollowsTheWeakerWay) {
  // Two slabs, one on top of the other, squarely: at the second one R = 0.04 of what the first lets through is
  // reflected and lost, and again of what goes in at its top. The first of these is followed back up.
  SceneData scene;
  test::addObject(scene, test::makeFloor(4.0), test::makeDiffuse(vec3(0.6F)));
  for (const double y : {0.5, 1.0})
    test::addObject(scene, makeBox("slab", dvec3(-1, y, -1), dvec3(1, y + 0.3, 1)), test::makeGlass(1.5F));
  scene.lights.push_back(test::makeSun(vec3(0, -1, 0), vec3(3)));
  LightRig rig(device(), scene, 64);
  const Ledger strong = rig.ledger(1), both = rig.ledger(1, {.follows_weaker = true});
  expectCloses(both);
  const double through = 0.96 * 0.96, back = through * 0.04;
  const auto otherWay = [&](const Ledger& ledger) {
    return lostTo(ledger, LossReason::kOtherWay).y / (ledger.emitted.y - ledger.blocked.y - ledger.missed.y);
  };
  EXPECT_NEAR(otherWay(strong), back + through * 0.96 * 0.04, 1e-3);
  // Up through the first slab it is reflected twice more, the weaker way, which is lost.
  EXPECT_NEAR(otherWay(both), through * 0.96 * 0.04 + back * (0.04 + 0.96 * 0.04), 1e-3);
  EXPECT_NEAR((both.escaped.y - strong.escaped.y) / (both.emitted.y - both.blocked.y - both.missed.y),
              back * 0.96 * 0.96, 1e-3);
}

TEST_F(PhotonLedgerTest, EqSixLosesAThirdOfWhatABallGets) {
  // A mirror that takes nothing: what leaves it is what came. Under a sun the mean of cos θ over a disc of rays, with
  // sin θ = h, is ∫ √(1 − h²) 2h dh = 2/3.
  SceneData scene = test::makeBallScene(test::makeMetal(vec3(1.0F)), 512);
  scene.lights.push_back(test::makeSun(vec3(0.3F, -1, 0.1F), vec3(3)));
  LightRig rig(device(), scene, 256);
  const auto reflected = [&](CellFlux flux) {
    const Ledger ledger = rig.ledger(0, {.flux = flux});
    expectCloses(ledger);
    return ledger.deposited.y + ledger.escaped.y + ledger.lostTotal().y;
  };
  EXPECT_NEAR(reflected(CellFlux::kBeam) / (3.0 * kPi), 1.0, 2e-3);
  EXPECT_NEAR(reflected(CellFlux::kEq6) / (3.0 * kPi), 2.0 / 3.0, 2e-3);
}

/// Two sheets that meet below at an angle, the bisector upright. Light along it is mirrored 180°/angle times before it
/// leaves, since the wedge's images about its edge close the circle.
SceneData makeWedge(float angle_deg, const Material& material) {
  SceneData scene;
  for (const double side : {-1.0, 1.0}) {
    const double half = 0.5 * radians(angle_deg);
    const dvec3 up(side * std::sin(half), std::cos(half), 0);
    test::addObject(scene, makeRectangle("sheet", up, up, dvec3(0, 0, 4)), material);
  }
  scene.lights.push_back(test::makeSun(vec3(0, -1, 0), vec3(3)));
  return scene;
}

TEST_F(PhotonLedgerTest, LightLandsOnWhatMirrorsIt) {
  // Of what arrives, each meeting scatters half and sends on half. The first half is direct light; two photons of a
  // path land; what is scattered from the fourth meeting on has none. Of 128 columns of cells the two beside the edge
  // are nearer to it than the pictures can tell.
  for (const int meetings : {3, 4}) {
    SCOPED_TRACE(meetings);
    const SceneData scene = makeWedge(180.0F / static_cast<float>(meetings), test::makeHalfMirror());
    LightRig rig(device(), scene, 128);
    const Ledger ledger = rig.ledger(0);
    expectCloses(ledger);
    const double arrives = ledger.emitted.y - ledger.missed.y;
    EXPECT_GT(arrives, 0.95 * ledger.emitted.y);
    EXPECT_NEAR(ledger.blocked.y / arrives, 1.0 / 2.0, 1e-3);
    EXPECT_NEAR(ledger.deposited.y / arrives, 1.0 / 4.0 + 1.0 / 8.0, 0.01);
    EXPECT_NEAR(lostTo(ledger, LossReason::kDiffuseShare).y / arrives, meetings == 4 ? 1.0 / 16.0 : 0.0, 2e-3);
    EXPECT_NEAR(ledger.escaped.y / arrives, std::pow(0.5, meetings), 0.01);
  }
}

TEST_F(PhotonLedgerTest, AgreesWithTheReferenceWhereGeneratorsReceive) {
  SceneData scene = test::makeBallScene(test::makeGlass(1.5F), 128);
  Material coated = test::makeMetal(vec3(0.9F, 0.6F, 0.3F));
  coated.metallic = 0.4F;
  scene.materials[0] = coated;
  scene.lights.push_back(test::makeSun(vec3(-0.4F, -1, -0.2F), vec3(3)));
  // The view shows all of the floor.
  LightRig rig(device(), scene, 512);
  const Ledger ledger = rig.ledger(3, {.max_events = 12}), reference = referenceLedger(scene);
  expectCloses(ledger);
  // Of what the floor sends up into the ball, and of what leaves it, the weaker way is not followed.
  for (int c = 0; c < 3; ++c) {
    EXPECT_NEAR(ledger.blocked[c] / reference.blocked[c], 1.0, 0.005);
    EXPECT_NEAR(ledger.deposited[c] / reference.deposited[c], 1.0, 0.05);
    const double after = ledger.deposited[c] + ledger.escaped[c] + ledger.lostTotal()[c];
    EXPECT_NEAR(after / (reference.deposited[c] + reference.escaped[c]), 1.0, 0.005);
  }
}

TEST_F(PhotonLedgerTest, RoughPartsOfAMirrorReceive) {
  // Rough on one half, by a texture, it sends on what falls on the other one alone.
  SceneData scene;
  Mesh sheet = makeRectangle("sheet", dvec3(0), dvec3(0, 0, 1), dvec3(1, 0, 0));
  sheet.texcoords[0].clear();
  for (const vec3& p : sheet.positions) sheet.texcoords[0].emplace_back(0.5F * (p.x + 1.0F), 0.5F);
  Material metal = test::makeMetal(vec3(1.0F), 1.0F);
  scene.images.push_back({"roughness", ByteImage{2, 1, {0, 0, 255, 255, 0, 255, 255, 255}}});
  metal.metallic_roughness_texture = {.image = 0, .wrap_u = Wrap::kClamp, .nearest = true};
  test::addObject(scene, std::move(sheet), metal);
  scene.lights.push_back(test::makeSun(vec3(0.5F, -1, 0), vec3(3)));
  LightRig rig(device(), scene, 128);
  const Ledger ledger = rig.ledger(0);
  expectCloses(ledger);
  const double arrives = ledger.emitted.y - ledger.missed.y;
  EXPECT_NEAR(ledger.blocked.y / arrives, 0.5, 0.01);
  EXPECT_NEAR(ledger.escaped.y / arrives, 0.5, 0.01);
}

TEST_F(PhotonLedgerTest, LightPassesPanesAsShadowsDo) {
  Material pane = test::makeGlass(1.5F);
  pane.thickness = 0.0F;
  pane.base_color = vec4(0.9F, 0.5F, 0.2F, 1.0F);
  // One before the ball, one between it and the floor.
  for (const double height : {2.6, 0.1}) {
    SCOPED_TRACE(height);
    SceneData scene = test::makeBallScene(test::makeGlass(1.5F), 128);
    test::addObject(scene, makeRectangle("pane", dvec3(0, height, 0), dvec3(0, 0, 6), dvec3(6, 0, 0)), pane);
    scene.lights.push_back(test::makeSun(vec3(-0.2F, -1, -0.1F), vec3(3)));
    LightRig rig(device(), scene, 192);
    const Ledger ledger = rig.ledger(4, {.max_events = 12}), reference = referenceLedger(scene);
    expectCloses(ledger);
    for (int c = 0; c < 3; ++c) EXPECT_NEAR(ledger.deposited[c] / reference.deposited[c], 1.0, 0.03) << c;
  }
}

TEST_F(PhotonLedgerTest, PanesThatMirrorLetTheRestPassAsShadowsDo) {
  // Of so high an index a pane casts a caustic: what it reflects. What goes through is no event, and on a receiver
  // direct light.
  Material pane = test::makeGlass(2.2F);
  pane.thickness = 0.0F;
  SceneData wall;
  test::addObject(wall, test::makeFloor(20.0), test::makeDiffuse(vec3(0.6F)));
  test::addObject(wall, makeRectangle("pane", dvec3(0, 1.1, 0), dvec3(0, 1, 0), dvec3(0, 0, 1)), pane);
  wall.lights.push_back(test::makeSun(vec3(-1, -0.7F, 0.2F), vec3(3)));
  LightRig rig(device(), wall, 128);
  const Ledger mirrored = rig.ledger(2), reference = referenceLedger(wall);
  expectCloses(mirrored);
  EXPECT_NEAR(mirrored.deposited.y / reference.deposited.y, 1.0, 0.01);
  EXPECT_NEAR(mirrored.blocked.y / mirrored.emitted.y, 1.0 - mirrored.deposited.y / mirrored.emitted.y, 0.01);

  // Before a ball, the ball's caustic is tinted. What the ball itself reflects is lost, 7 % with what the pane sends
  // back of it, and is in the account.
  SceneData roof = test::makeBallScene(test::makeGlass(1.5F), 128);
  test::addObject(roof, makeRectangle("pane", dvec3(0, 2.6, 0), dvec3(0, 0, 1.2), dvec3(1.2, 0, 0)), pane);
  roof.lights.push_back(test::makeSun(vec3(-0.2F, -1, -0.1F), vec3(3)));
  LightRig above(device(), roof, 192);
  const Ledger tinted = above.ledger(4, {.max_events = 12});
  expectCloses(tinted);
  const double expected = referenceLedger(roof).deposited.y;
  EXPECT_NEAR(tinted.deposited.y / expected, 0.93, 0.02);
  EXPECT_GT(tinted.lost[static_cast<std::size_t>(LossReason::kOtherWay)].y, 0.07 * expected);
}

TEST_F(PhotonLedgerTest, AgreesWithTheReferenceForAPrism) {
  // Total reflection decides who gets what.
  const SceneData scene = loadScene("builtin:prism");
  LightRig rig(device(), scene, 256);
  const Ledger ledger = rig.ledger(6, {.max_events = 16}), reference = referenceLedger(scene);
  expectCloses(ledger);
  EXPECT_NEAR(ledger.deposited.y / reference.deposited.y, 1.0, 0.02) << formatLedgers({ledger, reference});
}

TEST_F(PhotonLedgerTest, NamesWhatIsNotFollowed) {
  SceneData scene = test::makeBallScene(test::makeGlass(1.5F), 96);
  scene.lights.push_back(test::makeSun(vec3(0, -1, 0), vec3(1)));
  LightRig rig(device(), scene);
  const Ledger one = rig.ledger(1), six = rig.ledger(6);
  // Of light that enters some per cent are reflected inside, and of these as few leave later.
  EXPECT_GT(lostTo(one, LossReason::kInternalReflections).y, 0.02 * one.emitted.y);
  EXPECT_LT(lostTo(six, LossReason::kInternalReflections).y, 0.002 * one.emitted.y);
  EXPECT_EQ(lostTo(rig.ledger(0), LossReason::kInternalReflections).y, 0.0);
  EXPECT_GT(lostTo(rig.ledger(0), LossReason::kOtherWay).y, 0.7 * one.emitted.y * 0.95);
  EXPECT_GT(lostTo(rig.ledger(1, {.max_events = 1}), LossReason::kBounceLimit).y, 0.7 * one.emitted.y * 0.95);
}

}  // namespace
}  // namespace nephroid
