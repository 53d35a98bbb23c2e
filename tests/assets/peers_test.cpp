// Four caustic scenes with converged references from an independent light tracer: radiance of `direct` + `caustic`.
#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>

#include "core/image/image_io.h"
#include "metrics/metrics.h"
#include "scene/edit.h"
#include "scene/load.h"
#include "techniques/technique.h"

namespace nephroid {
namespace {

struct Peer {
  const char* scene;
  const char* reference;
  /// Largest relative L1 at this photon count: noise of ours and of the reference, measured, and half again. The pool's
  /// sun spreads few photons over many pixels; it takes 100 M of them to see that it looks the same (L1 0.06).
  double l1;
};
void PrintTo(const Peer& peer, std::ostream* out) { *out << peer.scene; }

class PeerScenes : public testing::TestWithParam<Peer> {};

TEST_P(PeerScenes, AgreeInTheMeanAndLookTheSame) {
  const std::filesystem::path folder = std::filesystem::path(NEPHROID_ASSET_DIR) / "peers";
  const std::string name = GetParam().scene;
  SceneData scene = loadScene((folder / (name + ".glb")).string());
  completeScene(scene);
  const auto mask_image = std::get<ByteImage>(loadImage(folder / (name + "_mask.png")));
  std::vector<std::uint8_t> mask;
  for (std::size_t i = 0; i < mask_image.pixels.size(); i += 4) mask.push_back(mask_image.pixels[i]);
  const LayeredImage reference = readExr(folder / (std::string(GetParam().reference) + ".exr"));

  const Technique& technique = findTechnique("reference");
  RenderSettings settings;
  settings.width = mask_image.width, settings.height = mask_image.height;
  settings.samples = 4;
  settings.photons = 4'000'000;
  settings.layers = {"direct", "caustic"};
  settings.params = ParamSet(technique.params);
  const RenderResult result = technique.render(scene, selectCamera(scene, "0"), settings, nullptr, nullptr);
  const Image sum = evaluateLayerExpression(result.image, "direct+caustic");
  const Image& truth = reference.layers.at(0).image;

  const dvec3 ours = maskedMean(sum, mask), theirs = maskedMean(truth, mask);
  // The engine's own noise in the mean over tens of thousands of pixels is below a tenth of this tolerance.
  for (int c = 0; c < 3; ++c) EXPECT_NEAR(ours[c] / theirs[c], 1.0, 0.005) << "channel " << c;
  EXPECT_LT(findMetric("l1").compute(sum, truth, mask, {}), GetParam().l1);
}

INSTANTIATE_TEST_SUITE_P(Peers, PeerScenes,
                         testing::Values(Peer{"s1_ring", "s1_ring_schlick", 0.12}, Peer{"s2_sphere", "s2_sphere", 0.06},
                                         Peer{"s3_bunny", "s3_bunny", 0.06}, Peer{"s4_pool", "s4_pool", 0.75}),
                         [](const auto& tested) { return std::string(tested.param.scene); });

}  // namespace
}  // namespace nephroid
