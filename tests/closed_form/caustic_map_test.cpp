// Closed forms drawn by caustic maps: the same formulas, scenes and views as for the reference.
#include <gtest/gtest.h>

#include <numeric>

#include <cstdlib>
#include <memory>

#include "closed_form/ball.h"
#include "closed_form/hollow.h"
#include "closed_form/profile.h"
#include "closed_form/ring.h"
#include "closed_form/slab.h"
#include "closed_form/wave.h"
#include "support/scratch_folder.h"

namespace nephroid::closed_form {
namespace {

/// Every render looks over its own shoulder, and none writes into the user's folders.
class CausticMapClosedForm : public ::testing::Test {
 protected:
  static void SetUpTestSuite() {
    cache_ = std::make_unique<nephroid::testing::ScratchFolder>();
    setenv("NEPHROID_VALIDATION", "1", 1);
    setenv("XDG_CACHE_HOME", (*cache_ / "cache").c_str(), 1);
  }
  static void TearDownTestSuite() {
    unsetenv("NEPHROID_VALIDATION");
    unsetenv("XDG_CACHE_HOME");
    cache_.reset();
  }

 private:
  static inline std::unique_ptr<nephroid::testing::ScratchFolder> cache_;
};

/// One frame, with a photon in the middle of each cell.
PlanePicture drawPlane(const SceneData& scene, const PlaneView& view, const std::vector<std::string>& parameters = {},
                       bool ledgers = false) {
  PlaneRender render;
  render.technique = "caustic-map";
  render.parameters = {"grid=512"};
  render.parameters.insert(render.parameters.end(), parameters.begin(), parameters.end());
  render.settings.samples = 1;
  render.settings.ledgers = ledgers;
  return renderPlane(scene, view, std::move(render));
}

void report(const std::string& name, double value) {
  ::testing::Test::RecordProperty(name, fmt::format("{:.6f}", value));
}

TEST_F(CausticMapClosedForm, ASlabShiftsAndDims) {
  for (const double angle_deg : {0.0, 30.0, 60.0}) {
    const SlabCase c{.angle_deg = angle_deg};
    PlaneView view = slabView(c);
    view.columns = 512, view.rows = 32;
    view.width *= 0.5;
    const PlanePicture picture = drawPlane(makeSlabScene(c), view);
    const double error = relativeL1(picture.columnMeans(), std::vector<double>(512, slabIrradiance(c).x));
    report(fmt::format("relative_l1_{}", angle_deg), error);
    EXPECT_LE(error, 0.005) << angle_deg;
  }
}

TEST_F(CausticMapClosedForm, AColouredSlabAbsorbsAlongTheBentPath) {
  const SlabCase c{.angle_deg = 45.0, .color = dvec3(0.9, 0.5, 0.15)};
  const PlanePicture picture = drawPlane(makeSlabScene(c), slabView(c));
  for (int channel = 0; channel < 3; ++channel) {
    const double ratio = meanIrradiance(picture)[channel] / slabIrradiance(c)[channel];
    report(fmt::format("ratio_{}", channel), ratio);
    EXPECT_NEAR(ratio, 1.0, 0.02) << channel;
  }
}

TEST_F(CausticMapClosedForm, ABallDrawsItsRadialProfile) {
  for (const BallCase& c : {BallCase{.gap = 0.015, .view_radius = 0.03}, BallCase{.gap = 0.05, .view_radius = 0.1}}) {
    const PlanePicture picture = drawPlane(makeBallScene(c, 1024), ballView(c, 1024));
    const double error = relativeL1(picture.ringMeans(c.view_radius, 512), ballIrradiance(c, 512));
    report(fmt::format("relative_l1_{}", c.gap), error);
    EXPECT_LE(error, 0.06) << c.gap;
  }
}

/// Share of what is emitted, of the first channel.
double lostShare(const Ledger& ledger, LossReason reason) {
  return ledger.lost[static_cast<std::size_t>(reason)].x / ledger.emitted.x;
}

TEST_F(CausticMapClosedForm, AHollowSphereDrawsItsRadialProfile) {
  // Light passes four surfaces, is reflected totally at the cavity, or passes beside it. Of what the far wall of the
  // cavity reflects, which is 1 % of the flux, rings about the axis make 3 % of the profile. Facets are no smaller than
  // the texels of the light's pictures, of which a search over the mesh starts.
  const HollowCase c{{.gap = 0.05, .view_radius = 0.1}, 0.025};
  const PlanePicture picture = drawPlane(makeHollowScene(c, 512), ballView(c.ball, 1024), {"weaker-ways=true"}, true);
  const double error = relativeL1(picture.ringMeans(c.ball.view_radius, 512), hollowIrradiance(c, 512));
  report("relative_l1", error);
  EXPECT_LE(error, 0.08);
  ASSERT_EQ(picture.ledgers.size(), 1U);
  EXPECT_LE(worstResidual(picture.ledgers), 1e-5);
  const double not_followed = lostShare(picture.ledgers[0], LossReason::kOtherWay);
  const double not_found = lostShare(picture.ledgers[0], LossReason::kHidden);
  report("not_followed", not_followed);
  report("not_found", not_found);
  EXPECT_GT(not_followed, 0.005);
  EXPECT_LT(not_found, 0.01);
}

TEST_F(CausticMapClosedForm, AWaveDrawsItsFolds) {
  for (const double depth : {0.5, 2.0}) {
    const WaveCase c{.depth = depth};
    const PlanePicture picture = drawPlane(makeWaveScene(c, 512), waveView(c));
    const std::vector<double> drawn = picture.columnMeans(), predicted = waveIrradiance(c, 512);
    const double error = relativeL1(drawn, predicted);
    report(fmt::format("relative_l1_{}", depth), error);
    EXPECT_LE(error, 0.08) << depth;
    const auto sum = [](const std::vector<double>& v) { return std::accumulate(v.begin(), v.end(), 0.0); };
    report(fmt::format("energy_{}", depth), sum(drawn) / sum(predicted));
    EXPECT_NEAR(sum(drawn) / sum(predicted), 1.0, 0.02) << depth;
  }
}

TEST_F(CausticMapClosedForm, ARingDrawsTheNephroid) {
  const RingCase c;
  const PlanePicture picture = drawPlane(makeRingScene(c, 2048), ringView(c, 512));
  const double error = relativeL1(axisProfile(picture.irradiance, 32), axisProfile(ringIrradiance(c, 512), 32));
  report("relative_l1", error);
  EXPECT_LE(error, 0.08);
}

}  // namespace
}  // namespace nephroid::closed_form
