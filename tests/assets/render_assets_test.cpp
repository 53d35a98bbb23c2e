// Every glTF file that nobody here wrote renders to finite pixels, or is refused as bad input.
#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <set>

#include "nephroid/error.h"
#include "scene/edit.h"
#include "scene/load.h"
#include "techniques/technique.h"

namespace nephroid {
namespace {

std::vector<std::string> listGltfFiles() {
  std::set<std::string> files;
  const auto folder = std::filesystem::path(NEPHROID_ASSET_DIR) / "assets" / "gltf";
  for (const auto& entry : std::filesystem::recursive_directory_iterator(folder))
    if (entry.path().extension() == ".glb" || entry.path().extension() == ".gltf") files.insert(entry.path().string());
  return {files.begin(), files.end()};
}

RenderResult renderSmall(SceneData& scene, std::vector<std::string> layers) {
  completeScene(scene, FloorMode::kOn);
  const Technique& technique = findTechnique("reference");
  RenderSettings settings;
  settings.width = 24, settings.height = 18;
  settings.samples = 1;
  settings.photons = 20000;
  settings.layers = std::move(layers);
  settings.params = ParamSet(technique.params);
  return technique.render(scene, selectCamera(scene, "0"), settings, nullptr, nullptr);
}

TEST(GltfAssets, RenderFiniteOrAreRefused) {
  int rendered = 0;
  for (const std::string& file : listGltfFiles()) {
    SCOPED_TRACE(file);
    try {
      SceneData scene = loadScene(file);
      const RenderResult result = renderSmall(scene, {"beauty"});
      for (const float value : result.image.layers[0].image.pixels) ASSERT_TRUE(std::isfinite(value));
      EXPECT_EQ(result.stats.not_finite, 0U);
      for (const Ledger& ledger : result.ledgers) EXPECT_LE(ledger.residual(), 1e-5);
      ++rendered;
    } catch (const InputError& error) {
      EXPECT_EQ(std::string(error.what()).find('\n'), std::string::npos);
    }
  }
  EXPECT_GE(rendered, 40);
}

/// Flux that reaches receivers after the glass, over what was sent to it.
double depositedShare(const char* file, const std::vector<std::string>& edits) {
  SceneData scene = loadScene((std::filesystem::path(NEPHROID_ASSET_DIR) / "assets" / "gltf" / file).string());
  for (const std::string& edit : edits) applyMaterialEdit(scene, edit);
  const RenderResult result = renderSmall(scene, {"caustic"});
  double deposited = 0.0, emitted = 0.0;
  for (const Ledger& ledger : result.ledgers) deposited += ledger.deposited.x, emitted += ledger.emitted.x;
  return emitted > 0.0 ? deposited / emitted : 0.0;
}

TEST(GltfAssets, GlassCastsItsCaustic) {
  EXPECT_GT(depositedShare("WineGlass-kenney-draco.gltf", {"*:transmission=1,thickness=0.01,roughness=0,metallic=0"}),
            0.3);
  EXPECT_GT(depositedShare("PokalGlasses-draco-webp.glb", {"glass_accurate:thickness=0.01"}), 0.05);
  // A brilliant is cut to send light back up by total reflection: a quarter comes down.
  EXPECT_GT(depositedShare("Diamond.glb", {"*:transmission=1,thickness=1,roughness=0,ior=2.42,baseColor=1,1,1"}), 0.1);
  // As they are: the candle holder's glass is dielectric and smooth only by its texture.
  EXPECT_GT(depositedShare("GlassHurricaneCandleHolder.glb", {}), 0.05);
  EXPECT_GT(depositedShare("AttenuationTest.glb", {}), 0.01);
  EXPECT_GT(depositedShare("DispersionTest.glb", {}), 0.01);
}

}  // namespace
}  // namespace nephroid
