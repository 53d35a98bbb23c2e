// Renders that are stopped and taken up again against the same without a stop; files that are not what they should be.
#include "techniques/reference/checkpoint.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <chrono>
#include <fstream>
#include <thread>

#include "core/file.h"
#include "nephroid/error.h"
#include "scene/fingerprint.h"
#include "support/scratch_folder.h"
#include "support/tiny_scenes.h"

namespace nephroid {
namespace {

using test::makeDiffuse;
using test::makeGlass;
using test::makeSettings;
using ::testing::HasSubstr;

/// Asks to stop after so many reports.
class StopAfter : public ProgressSink {
 public:
  explicit StopAfter(int reports) : left_(reports) {}
  void update(double, const std::string&) override {
    if (--left_ == 0) stop_.request();
  }
  const StopToken& token() const { return stop_; }

 private:
  int left_;
  StopToken stop_;
};

/// A glass ball over a floor, a lamp that photons and paths find.
SceneData makeScene() {
  SceneData scene = test::makeBallScene(makeGlass(1.5F), 48);
  Material lamp = makeDiffuse(vec3(0.0F));
  lamp.emission = vec3(5.0F, 4.0F, 3.0F);
  test::addObject(scene, makeRectangle("lamp", dvec3(0, 4, 0), dvec3(1, 0, 0), dvec3(0, 0, 1)), lamp);
  scene.cameras.push_back(makeCamera("ball", vec3(3.5F, 4.0F, 3.0F), vec3(0, 0.6F, 0), radians(45)));
  return scene;
}

/// Stops again and again, each time after `reports` passes, until the render is done.
RenderResult renderInPieces(const SceneData& scene, RenderSettings settings, const std::string& file, int reports) {
  settings.checkpoint.path = file;
  for (int piece = 0; piece < 1000; ++piece) {
    StopAfter stop(reports);
    RenderResult result = findTechnique("reference").render(scene, scene.cameras[0], settings, &stop, &stop.token());
    if (!result.interrupted) return result;
  }
  ADD_FAILURE() << "never done";
  return {};
}

void expectSame(const RenderResult& a, const RenderResult& b) {
  ASSERT_EQ(a.image.layers.size(), b.image.layers.size());
  for (std::size_t i = 0; i < a.image.layers.size(); ++i)
    EXPECT_TRUE(a.image.layers[i].image.pixels == b.image.layers[i].image.pixels) << a.image.layers[i].name;
  EXPECT_EQ(a.image.metadata, b.image.metadata);
  EXPECT_EQ(a.stats.rays, b.stats.rays);
  EXPECT_EQ(formatLedgersJson(a.ledgers), formatLedgersJson(b.ledgers));
}

struct Case {
  std::string name;
  std::vector<std::string> layers;
  double target_error = 0;
  std::string estimator = "auto";
};

class Resumed : public ::testing::TestWithParam<Case> {};

TEST_P(Resumed, GivesThePixelsOfAnUninterruptedRender) {
  const testing::ScratchFolder folder;
  const SceneData scene = makeScene();
  RenderSettings settings = makeSettings(12, 12, 40'000, GetParam().layers);
  settings.target_error = GetParam().target_error;
  settings.params.set("estimator", GetParam().estimator);
  const RenderResult whole = test::renderReference(scene, scene.cameras[0], settings);
  expectSame(renderInPieces(scene, settings, (folder / "often").string(), 1), whole);
  expectSame(renderInPieces(scene, settings, (folder / "seldom").string(), 5), whole);
}

INSTANTIATE_TEST_SUITE_P(Layers, Resumed,
                         ::testing::Values(Case{"all", {"beauty", "specular_caustic", "irradiance", "albedo"}},
                                           Case{"eye", {"direct"}}, Case{"lights", {"caustic"}},
                                           Case{"errors",
                                                {"beauty_error", "specular_caustic_error", "specular_caustic_bias"}},
                                           Case{"target", {"beauty"}, 0.3}, Case{"adaptive", {"beauty"}, 0.03},
                                           Case{"vcm", {"beauty", "specular_caustic"}, 0, "vcm"}),
                         [](const auto& tested) { return tested.param.name; });

TEST(Checkpoint, OfAPassThatWasCutShortKeepsItsRows) {
  const testing::ScratchFolder folder;
  const SceneData scene = makeScene();
  RenderSettings settings = makeSettings(96, 24, 0, {"direct", "specular"});
  settings.params.set("estimator", "path");
  const RenderResult whole = test::renderReference(scene, scene.cameras[0], settings);
  settings.checkpoint.path = (folder / "rows").string();
  settings.threads = 2;
  RenderResult result;
  do {
    StopToken stop;
    // Whenever it comes, mostly amid a pass.
    std::jthread stopper([&] {
      std::this_thread::sleep_for(std::chrono::milliseconds(37));
      stop.request();
    });
    try {
      result = findTechnique("reference").render(scene, scene.cameras[0], settings, nullptr, &stop);
    } catch (const InterruptedError&) {
      result.interrupted = true;
    }
  } while (result.interrupted);
  expectSame(result, whole);
}

TEST(Checkpoint, OfAFinishedRenderTakesALargerBudget) {
  const testing::ScratchFolder folder;
  const SceneData scene = makeScene();
  RenderSettings settings = makeSettings(12, 4, 0, {"direct"});
  settings.checkpoint.path = (folder / "more").string();
  test::renderReference(scene, scene.cameras[0], settings);
  settings.samples = 9;
  const RenderResult more = test::renderReference(scene, scene.cameras[0], settings);
  EXPECT_THAT(more.notes.front(), HasSubstr("with 4 samples"));
  settings.checkpoint.path.clear();
  expectSame(more, test::renderReference(scene, scene.cameras[0], settings));
}

TEST(Checkpoint, OfAnotherRenderIsRefusedAndNamesWhatDiffers) {
  const testing::ScratchFolder folder;
  const SceneData scene = makeScene();
  RenderSettings settings = makeSettings(8, 2, 1000, {"beauty"});
  settings.checkpoint.path = (folder / "other").string();
  test::renderReference(scene, scene.cameras[0], settings);
  const auto expectRefused = [&](const SceneData& other, const Camera& camera, const RenderSettings& changed,
                                 const std::string& what) {
    try {
      test::renderReference(other, camera, changed);
      ADD_FAILURE() << what;
    } catch (const InputError& error) {
      EXPECT_THAT(error.what(), HasSubstr("its " + what + " is"));
      EXPECT_THAT(error.what(), HasSubstr(settings.checkpoint.path));
    }
  };
  RenderSettings changed = settings;
  changed.seed = 1;
  expectRefused(scene, scene.cameras[0], changed, "seed");
  changed = settings, changed.width = 9;
  expectRefused(scene, scene.cameras[0], changed, "size");
  changed = settings, changed.layers = {"beauty", "direct"};
  expectRefused(scene, scene.cameras[0], changed, "list of layers");
  changed = settings, changed.target_error = 0.1;
  expectRefused(scene, scene.cameras[0], changed, "list of estimated errors");
  changed = settings, changed.params.set("max-bounces", "5");
  expectRefused(scene, scene.cameras[0], changed, "parameter max-bounces");
  Camera turned = scene.cameras[0];
  turned.fov_y *= 1.01F;
  expectRefused(scene, turned, settings, "camera");
  SceneData edited = scene;
  edited.meshes[1].positions[7].x += 1e-6F;
  expectRefused(edited, scene.cameras[0], settings, "scene");
}

TEST(Checkpoint, IsReadBackUnlessAByteIsChangedOrMissing) {
  const testing::ScratchFolder folder;
  const std::string path = (folder / "bytes").string();
  const CheckpointFacts facts{{"seed", "1"}, {"size", "2x2"}};
  StateWriter state;
  state.value(3.5);
  state.value(std::uint8_t{7});
  writeCheckpoint(path, facts, state.bytes());
  EXPECT_EQ(readCheckpoint(path, facts), state.bytes());

  const std::vector<std::byte> good = readFile(path);
  for (std::size_t i = 0; i < good.size(); ++i) {
    std::vector<std::byte> changed = good;
    changed[i] ^= std::byte{0x10};
    writeFileAtomically(path, changed);
    EXPECT_THROW(readCheckpoint(path, facts), InputError) << i;
    writeFileAtomically(path, std::span(good).first(i));
    EXPECT_THROW(readCheckpoint(path, facts), InputError) << i;
  }
  writeFileAtomically(path, good);
  EXPECT_THROW(readCheckpoint(path, {{"seed", "1"}}), InputError);
  EXPECT_THROW(readCheckpoint(path, {{"seed", "1"}, {"size", "2x2"}, {"more", "x"}}), InputError);
}

TEST(Checkpoint, StateThatDoesNotFitIsNoticed) {
  StateWriter writer;
  writer.value(1.0);
  double a = 0, b = 5;
  StateReader too_short(writer.bytes());
  too_short.value(a);
  too_short.value(b);
  EXPECT_FALSE(too_short.isDone());
  EXPECT_EQ(b, 5.0);
  float half = 0;
  StateReader too_long(writer.bytes());
  too_long.value(half);
  EXPECT_FALSE(too_long.isDone());
}

TEST(Checkpoint, ThatCannotBeWrittenCostsNothingButIsTold) {
  const SceneData scene = makeScene();
  RenderSettings settings = makeSettings(8, 2, 1000, {"beauty"});
  settings.checkpoint.path = "/nonexistent/folder/checkpoint";
  const RenderResult result = test::renderReference(scene, scene.cameras[0], settings);
  EXPECT_THAT(result.checkpoint_failure, HasSubstr("/nonexistent/folder"));
  settings.checkpoint.path.clear();
  expectSame(result, test::renderReference(scene, scene.cameras[0], settings));
}

TEST(Fingerprint, IsOfTheContentAlone) {
  const SceneData scene = makeScene();
  SceneData same = scene;
  same.name = "other";
  same.warnings.emplace_back("w");
  EXPECT_EQ(fingerprintScene(same), fingerprintScene(scene));
  const auto expectOther = [&](auto&& edit) {
    SceneData edited = scene;
    edit(edited);
    EXPECT_NE(fingerprintScene(edited), fingerprintScene(scene));
  };
  expectOther([](SceneData& s) { s.materials[0].ior = 1.51F; });
  expectOther([](SceneData& s) { s.materials[0].conductor_ior = vec3(1.0F); });
  expectOther([](SceneData& s) { s.instances[0].casts = false; });
  expectOther([](SceneData& s) { s.meshes[0].triangles.pop_back(); });
  expectOther([](SceneData& s) { s.lights.push_back(test::makeSun(vec3(0, -1, 0), vec3(1))); });
  expectOther([](SceneData& s) { s.environment = Environment{std::make_shared<Image>(4, 2, 3, 1.0F)}; });
}

}  // namespace
}  // namespace nephroid
