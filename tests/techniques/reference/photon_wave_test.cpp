#include "techniques/reference/photon_wave.h"

#include <gtest/gtest.h>

#include <numeric>

#include <cmath>
#include <memory>

#include "support/tiny_scenes.h"
#include "techniques/reference/photon_batch.h"

namespace nephroid {
namespace {

/// Tells photons apart by the flux they carry.
void put(PhotonWave& wave, std::uint32_t index, std::uint32_t key) {
  wave.put(index, {{vec3(0), vec3(0, -1, 0), vec3(static_cast<float>(index + 1))}, Sampler(0, 0, index)}, key);
}

std::vector<int> fluxesOf(const PhotonWave& wave) {
  std::vector<int> fluxes;
  for (std::uint32_t i = 0; i < wave.size(); ++i) fluxes.push_back(static_cast<int>(wave[i].emitted.flux.x));
  return fluxes;
}

TEST(PhotonWave, HoldsWhatWasPutByKeyAndThenByIndex) {
  PhotonWave wave;
  wave.reset(1000, 6);
  for (const auto& [index, key] : {std::pair{5U, 7U}, {0U, 7U}, {3U, 2U}, {1U, 1U << 20}}) put(wave, index, key);
  wave.close();
  EXPECT_EQ(wave.count(), 6U);
  EXPECT_EQ(wave.first(), 1000U);
  EXPECT_EQ(fluxesOf(wave), (std::vector<int>{4, 1, 6, 2}));
}

TEST(PhotonWave, KeepsTheOrderOfIndicesIfNotSorted) {
  PhotonWave wave;
  wave.reset(0, 4);
  for (const auto& [index, key] : {std::pair{2U, 1U}, {0U, 9U}, {3U, 0U}}) put(wave, index, key);
  wave.close(false);
  EXPECT_EQ(fluxesOf(wave), (std::vector<int>{1, 3, 4}));
}

TEST(PhotonWave, HoldsNothingOfWhatItHeldBefore) {
  PhotonWave wave;
  wave.reset(0, 3);
  for (std::uint32_t i = 0; i < 3; ++i) put(wave, i, i);
  wave.close();
  wave.reset(3, 2);
  EXPECT_EQ(wave.size(), 0U);
  put(wave, 1, 0);
  wave.close();
  EXPECT_EQ(fluxesOf(wave), (std::vector<int>{2}));
}

/// A glass ball under a sun, and its tracer.
class PhotonBatchTest : public testing::Test {
 protected:
  PhotonBatchTest() : scene_(test::makeBallScene(test::makeGlass(1.5F), 32)) {
    scene_.lights.push_back(test::makeSun(vec3(0.2F, -1, 0), vec3(3)));
    scene_.lights.push_back(test::makePoint(vec3(1, 4, 0), vec3(9)));
    camera_ = makeCamera("above", vec3(3, 3, 3), vec3(0), radians(50));
    world_ = std::make_unique<ReferenceWorld>(scene_, camera_, kSize, kSize, ReferenceOptions{});
    tracer_ = std::make_unique<LightTracer>(*world_, PhotonPaths{.caustic = true});
  }
  static constexpr int kSize = 16;
  static constexpr std::size_t kPixels = kSize * kSize;

  SceneData scene_;
  Camera camera_;
  std::unique_ptr<ReferenceWorld> world_;
  std::unique_ptr<LightTracer> tracer_;
};

TEST_F(PhotonBatchTest, GivesEveryEmittedWattToTheLedgersOnce) {
  PhotonBatch batch(*tracer_, 20000, kSize, kSize);
  ASSERT_TRUE(batch.trace(0, [] { return false; }));
  Ledger sum;
  for (const PhotonBatch::Chunk& chunk : batch.chunks()) sum.add(chunk.tally.ledger);
  const std::vector<std::uint32_t> shares = tracer_->sharePhotons(20000);
  EXPECT_EQ(sum.emitted_count, shares[0] + shares[1]);
  EXPECT_GT(sum.emitted.x, 0.0);
  EXPECT_LT(std::abs(sum.residual()), 1e-12);
}

TEST_F(PhotonBatchTest, VisitsEverySplatInTheOrderOfItsPhoton) {
  PhotonBatch batch(*tracer_, 20000, kSize, kSize);
  ASSERT_TRUE(batch.trace(0, [] { return false; }));
  std::vector<std::vector<float>> by_pixel(kPixels), expected(kPixels);
  batch.visitSplats([&](const Splat& splat, std::uint32_t pixel, std::span<const float> weights) {
    EXPECT_EQ(pixel, splat.pixel);
    ASSERT_EQ(weights.size(), 1U);
    by_pixel[pixel].push_back(splat.radiance.x * weights[0]);
  });
  std::size_t count = 0;
  for (const PhotonBatch::Chunk& chunk : batch.chunks()) {
    for (const Splat& splat : chunk.tally.splats)
      expected[splat.pixel].push_back(splat.radiance.x * batch.scaleOf(chunk));
    count += chunk.tally.splats.size();
  }
  EXPECT_GT(count, 1000U);
  EXPECT_EQ(by_pixel, expected);
}

TEST_F(PhotonBatchTest, SpreadsEveryFootprintOverAllBandsThatItMeets) {
  const ReceiverView view(*world_);
  tracer_->spreadOver(&view);
  PhotonBatch batch(*tracer_, 20000, kSize, kSize);
  batch.spreadOver(&view, {1.0F, 1.0F});
  ASSERT_TRUE(batch.trace(0, [] { return false; }));
  std::vector<double> by_pixel(kPixels);
  batch.visitSplats([&](const Splat& splat, std::uint32_t pixel, std::span<const float> weights) {
    for (const float weight : weights) by_pixel[pixel++] += splat.irradiance.x * weight;
  });
  double expected = 0.0;
  std::size_t spread = 0;
  for (const PhotonBatch::Chunk& chunk : batch.chunks()) {
    for (const Splat& splat : chunk.tally.splats) expected += splat.irradiance.x * batch.scaleOf(chunk);
    for (const FootprintSplat& f : chunk.tally.footprints) expected += f.splat.irradiance.x * batch.scaleOf(chunk);
    spread += chunk.tally.footprints.size();
  }
  EXPECT_GT(spread, 1000U);
  EXPECT_NEAR(std::accumulate(by_pixel.begin(), by_pixel.end(), 0.0), expected, 1e-5 * expected);
}

TEST_F(PhotonBatchTest, SaysThatItWasStopped) {
  PhotonBatch batch(*tracer_, 20000, kSize, kSize);
  EXPECT_FALSE(batch.trace(0, [] { return true; }));
}

TEST_F(PhotonBatchTest, DrawsOtherPhotonsBeyondTwoToTheThirtyTwo) {
  const auto firstDirection = [&](std::uint64_t first) {
    PhotonWave wave;
    PhotonTally tally;
    wave.reset(first, 64);
    tracer_->emit(1, 0, 64, wave, tally);
    wave.close(false);
    return wave[0].emitted.dir;
  };
  EXPECT_EQ(firstDirection(0), firstDirection(0));
  EXPECT_NE(firstDirection(0), firstDirection(std::uint64_t{1} << 32));
}

}  // namespace
}  // namespace nephroid
