// Whose noise it is that paths gather: the analysis of variance on made-up sums.
#include "techniques/reference/gather_probe.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "techniques/reference/checkpoint.h"

namespace nephroid {
namespace {

constexpr int kSide = 192;
const PictureTiles kTiles(kSide, kSide);
constexpr double kPixels = kSide * kSide / 8.0;  // that are watched

/// Rounds of paths on a film: every pass has noise of its own, and what its batch of photons has in common.
class Rounds {
 public:
  /// @param evenness  of every two passes, 0 to 1: how much of the second's noise is the first's, turned over
  Rounds(double of_paths, double of_photons, double evenness = 0.0)
      : film_(kSide, kSide, LayerNeeds({"beauty"})),
        probe_(film_, "beauty"),
        of_paths_(of_paths),
        of_photons_(of_photons),
        evenness_(evenness) {}

  void gatherBatch(int rounds) {
    std::vector<double> common(kTiles.count());
    for (double& value : common) value = std::sqrt(of_photons_) * normal_(random_);
    for (int round = 0; round < rounds; ++round) {
      for (std::size_t tile = 0; tile < kTiles.count(); ++tile) {
        // As where passes go where errors are: not the same everywhere.
        const std::uint64_t passes = (tile + static_cast<std::size_t>(round)) % 5 == 0 ? tile % 3 : 1;
        for (std::uint64_t pass = 0; pass < passes; ++pass) addPass(tile, common[tile], passes_[tile] + pass);
        passes_[tile] += passes;
      }
      probe_.takeRound(passes_);
    }
    probe_.closeBatch();
    for (std::size_t tile = 0; tile < kTiles.count(); ++tile)
      squares_[tile] += std::pow(static_cast<double>(passes_[tile] - closed_[tile]), 2.0);
    closed_ = passes_;
  }
  /// Of the noise, what is the photons', as the variances that went in make it.
  double expectedShare() const {
    double paths = 0.0, photons = 0.0;
    for (std::size_t tile = 0; tile < kTiles.count(); ++tile) {
      const auto n = static_cast<double>(passes_[tile]);
      paths += of_paths_ / n, photons += of_photons_ * squares_[tile] / (n * n);
    }
    return photons / (photons + paths);
  }
  double share() const {
    const GatherProbe::Parts parts = probe_.parts().value();
    return parts.photons / (parts.photons + parts.paths);
  }
  GatherProbe& probe() { return probe_; }

 private:
  void addPass(std::size_t tile, double common, std::uint64_t pass) {
    kTiles.visitPixels(tile, [&](int x, int y) {
      const std::size_t pixel = kTiles.pixelOf(x, y);
      const double fresh = std::sqrt(of_paths_) * normal_(random_);
      const double noise =
          pass % 2 == 0 ? fresh : std::sqrt(1.0 - evenness_ * evenness_) * fresh - evenness_ * first_[pixel];
      if (pass % 2 == 0) first_[pixel] = noise;
      film_.specular.add(pixel, vec3(static_cast<float>(5.0 + common + noise)));
    });
  }

  Film film_;
  GatherProbe probe_;
  double of_paths_, of_photons_, evenness_;
  std::mt19937 random_{17};
  std::normal_distribution<double> normal_;
  std::vector<double> first_ = std::vector<double>(kSide * kSide, 0.0);  ///< noise of the first pass of a pair
  std::vector<std::uint64_t> passes_ = std::vector<std::uint64_t>(kTiles.count(), 0), closed_ = passes_;
  std::vector<double> squares_ = std::vector<double>(kTiles.count(), 0.0);
};

TEST(GatherProbe, TellsPhotonsFromPaths) {
  for (const double of_photons : {0.0, 0.02, 0.1, 1.0}) {
    Rounds rounds(0.4, of_photons);
    for (const int count : {4, 1, 2, 1, 1, 2, 1, 4, 4, 5, 6, 8, 12, 4, 9, 6}) rounds.gatherBatch(count);
    EXPECT_NEAR(rounds.share(), rounds.expectedShare(), 0.08) << of_photons;
  }
}

// Within a batch such passes differ by more than their noise: by that alone photons would seem to have no part in it.
TEST(GatherProbe, KnowsPhotonsWherePassesAreSpreadEvenly) {
  Rounds rounds(0.4, 0.1, 0.8);
  for (const int count : {4, 1, 2, 1, 1, 2, 1, 4}) rounds.gatherBatch(count);
  EXPECT_NEAR(rounds.probe().parts()->of_batch * 25.0 / kPixels, 0.1, 0.02);
}

TEST(GatherProbe, KnowsNothingOfBatchesThatNoPathGathered) {
  Rounds some(0.4, 0.1), all(0.4, 0.1);
  for (const int count : {4, 1, 2, 1, 4, 0, 0, 6, 0, 1, 2, 1}) some.gatherBatch(count);
  for (const int count : {4, 1, 2, 1, 4, 6, 1, 2, 1}) all.gatherBatch(count);
  // Not the same random numbers: those that nobody gathered took some.
  EXPECT_NEAR(some.share(), all.share(), 0.15);
  EXPECT_NEAR(some.share(), some.expectedShare(), 0.1);
}

TEST(GatherProbe, BeforePairsOfBothKindsIsUnknown) {
  Rounds rounds(0.4, 0.1);
  EXPECT_FALSE(rounds.probe().parts());
  rounds.gatherBatch(4);
  EXPECT_FALSE(rounds.probe().parts());
  rounds.gatherBatch(8);
  rounds.gatherBatch(1);
  rounds.gatherBatch(2);
  rounds.gatherBatch(1);
  EXPECT_TRUE(rounds.probe().parts());
}

TEST(GatherProbe, GoesOnFromItsState) {
  Rounds rounds(0.4, 0.1), others(0.4, 0.1);
  for (const int count : {4, 1, 2, 1, 6}) rounds.gatherBatch(count);
  StateWriter writer;
  rounds.probe().visitState(writer);
  StateReader reader(writer.bytes());
  others.probe().visitState(reader);
  EXPECT_TRUE(reader.isDone());
  EXPECT_EQ(others.probe().parts()->photons, rounds.probe().parts()->photons);
  EXPECT_EQ(others.probe().parts()->paths, rounds.probe().parts()->paths);
}

}  // namespace
}  // namespace nephroid
