// Estimators against each other: means over the blocks of a picture, by many scramblings.
#pragma once

#include <gtest/gtest.h>

#include <cmath>
#include <string>
#include <vector>

#include "support/tiny_scenes.h"

namespace nephroid::test {

constexpr int kScramblings = 16;
/// Two-sided significance of all cells of a z-test together; fixed seeds, so a failure is a change of the code.
constexpr double kSignificance = 0.01;

/// The floor beside the ball, where most of what the ball sends down arrives.
inline Camera lookAtCaustic() {
  return makeCamera("caustic", vec3(3.5F, 4.0F, 3.0F), vec3(0.8F, 0, 0.7F), radians(22));
}

inline Material makeLamp(vec3 radiance) {
  Material lamp;
  lamp.name = "lamp";
  lamp.base_color = vec4(0, 0, 0, 1);
  lamp.emission = radiance;
  return lamp;
}

/// A large lamp, so that both directions of transport converge: overhead for what transmits, at the side for what
/// only reflects, so that the light is sent down to the floor that is looked at.
inline SceneData makeLampScene(Material material) {
  const bool overhead = material.transmits();
  SceneData scene = test::makeBallScene(std::move(material), 128);
  if (!overhead) {
    addObject(scene, makeRectangle("lamp", dvec3(4.5, 1.5, 1.0), dvec3(0, 0, 2.5), dvec3(0, 1.5, 0)),
              makeLamp(vec3(5.0F, 4.0F, 3.0F)));
    return scene;
  }
  addObject(scene, makeRectangle("lamp", dvec3(0, 4, 0), dvec3(2.5, 0, 0), dvec3(0, 0, 2.5)),
            makeLamp(vec3(5.0F, 4.0F, 3.0F)));
  return scene;
}

/// The picture is cut into this many blocks each way; a block must be wide enough for its mean to be nearly normal.
constexpr int kBlocks = 4;

/// Means over the blocks of a layer for each scrambling: [block][scrambling].
inline std::vector<std::vector<double>> blockMeans(const SceneData& scene, RenderSettings settings,
                                                   const std::string& layer) {
  std::vector<std::vector<double>> means(kBlocks * kBlocks);
  for (int s = 0; s < kScramblings; ++s) {
    settings.seed = static_cast<std::uint64_t>(1000 + s);
    const RenderResult result = renderReference(scene, lookAtCaustic(), settings);
    const Image& image = *result.image.find(layer);
    const int block = image.width / kBlocks;
    for (int b = 0; b < kBlocks * kBlocks; ++b) {
      double sum = 0.0;
      for (int y = 0; y < block; ++y)
        for (int x = 0; x < block; ++x)
          sum += luminance(image.rgb((b % kBlocks) * block + x, (b / kBlocks) * block + y));
      means[static_cast<std::size_t>(b)].push_back(sum / (block * block));
    }
  }
  return means;
}

struct Moments {
  double mean = 0, variance_of_mean = 0;
};
inline Moments momentsOf(const std::vector<double>& values) {
  Moments m;
  const auto n = static_cast<double>(values.size());
  for (const double v : values) m.mean += v / n;
  for (const double v : values) m.variance_of_mean += (v - m.mean) * (v - m.mean) / (n * (n - 1.0));
  return m;
}

/// z-test, block by block and of the whole. Blocks that hold under a tenth of the average are left to the whole: a
/// handful of paths from the eye finds them, and the mean of a handful is not normal.
inline void expectAgreement(const std::vector<std::vector<double>>& a, const std::vector<std::vector<double>>& b) {
  // 16 blocks and the whole, each at 1 − (1 − 0.01)^(1/17) = 5.9e-4, two-sided; Student's t of 30 degrees is 3.8 there.
  constexpr double kBound = 3.8;
  static_assert(kSignificance == 0.01);
  double total_a = 0, total_b = 0, total_variance = 0;
  for (std::size_t i = 0; i < a.size(); ++i) {
    const Moments ma = momentsOf(a[i]), mb = momentsOf(b[i]);
    total_a += ma.mean, total_b += mb.mean, total_variance += ma.variance_of_mean + mb.variance_of_mean;
  }
  for (std::size_t i = 0; i < a.size(); ++i) {
    const Moments ma = momentsOf(a[i]), mb = momentsOf(b[i]);
    if (ma.mean < 0.1 * total_a / static_cast<double>(a.size())) continue;
    const double error = std::sqrt(ma.variance_of_mean + mb.variance_of_mean);
    EXPECT_LT(std::abs(ma.mean - mb.mean), kBound * error) << "block " << i << ": " << ma.mean << " and " << mb.mean;
  }
  EXPECT_GT(total_a, 0.0);
  EXPECT_LT(std::abs(total_a - total_b), kBound * std::sqrt(total_variance)) << total_a << " and " << total_b;
  // The test must have power: a twentieth of the whole would show.
  EXPECT_LT(std::sqrt(total_variance) / total_a, 0.05 / kBound);
}

/// Of an estimator that blurs: each block within a share of the mean over all, and the whole more nearly.
inline void expectNear(const std::vector<std::vector<double>>& a, const std::vector<std::vector<double>>& b,
                       double of_block, double of_whole) {
  double total_a = 0, total_b = 0;
  for (std::size_t i = 0; i < a.size(); ++i) total_a += momentsOf(a[i]).mean, total_b += momentsOf(b[i]).mean;
  for (std::size_t i = 0; i < a.size(); ++i)
    EXPECT_NEAR(momentsOf(a[i]).mean, momentsOf(b[i]).mean, of_block * total_b / static_cast<double>(b.size())) << i;
  EXPECT_NEAR(total_a, total_b, of_whole * total_b);
}

/// Settings of the reference for a small picture by one estimator.
inline RenderSettings settingsOf(const std::string& estimator, int size, std::uint64_t samples, std::uint64_t photons,
                                 std::vector<std::string> layers) {
  RenderSettings settings = makeSettings(size, samples, photons, std::move(layers));
  settings.params.set("estimator", estimator);
  return settings;
}

}  // namespace nephroid::test
