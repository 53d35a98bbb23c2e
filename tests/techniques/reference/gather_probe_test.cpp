// Whose noise it is that paths gather: the analysis of variance on made-up sums.
#include "techniques/reference/gather_probe.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "techniques/reference/checkpoint.h"

namespace nephroid {
namespace {

constexpr int kSide = 96;
const PictureTiles kTiles(kSide, kSide);

/// Rounds of paths on a film: every pass has noise of its own, and what its batch of photons has in common.
class Rounds {
 public:
  Rounds(double of_paths, double of_photons)
      : film_(kSide, kSide, LayerNeeds({"beauty"})),
        probe_(film_, "beauty"),
        of_paths_(of_paths),
        of_photons_(of_photons) {}

  void gatherBatch(int rounds) {
    std::vector<double> common(kTiles.count());
    for (double& value : common) value = std::sqrt(of_photons_) * normal_(random_);
    for (int round = 0; round < rounds; ++round) {
      for (std::size_t tile = 0; tile < kTiles.count(); ++tile) {
        // As where passes go where errors are: not the same everywhere.
        const std::uint64_t passes = (tile + static_cast<std::size_t>(round)) % 3;
        kTiles.visitPixels(tile, [&](int x, int y) {
          for (std::uint64_t pass = 0; pass < passes; ++pass)
            film_.specular.add(kTiles.pixelOf(x, y),
                               vec3(static_cast<float>(5.0 + common[tile] + std::sqrt(of_paths_) * normal_(random_))));
        });
        passes_[tile] += passes;
      }
      probe_.takeRound(passes_);
    }
    probe_.closeBatch();
    for (std::size_t tile = 0; tile < kTiles.count(); ++tile)
      squares_[tile] += std::pow(static_cast<double>(passes_[tile] - closed_[tile]), 2.0);
    closed_ = passes_;
  }
  /// What the variances that went in make it.
  double expectedShare() const {
    double paths = 0.0, photons = 0.0;
    for (std::size_t tile = 0; tile < kTiles.count(); ++tile) {
      const auto n = static_cast<double>(passes_[tile]);
      paths += of_paths_ / n, photons += of_photons_ * squares_[tile] / (n * n);
    }
    return photons / (photons + paths);
  }
  GatherProbe& probe() { return probe_; }

 private:
  Film film_;
  GatherProbe probe_;
  double of_paths_, of_photons_;
  std::mt19937 random_{17};
  std::normal_distribution<double> normal_;
  std::vector<std::uint64_t> passes_ = std::vector<std::uint64_t>(kTiles.count(), 0), closed_ = passes_;
  std::vector<double> squares_ = std::vector<double>(kTiles.count(), 0.0);
};

TEST(GatherProbe, TellsPhotonsFromPaths) {
  for (const double of_photons : {0.0, 0.02, 0.1, 1.0}) {
    Rounds rounds(0.4, of_photons);
    for (const int count : {4, 4, 4, 4, 5, 6, 8, 12, 4, 4, 9, 6}) rounds.gatherBatch(count);
    EXPECT_NEAR(rounds.probe().photonsShare(), rounds.expectedShare(), 0.08) << of_photons;
  }
}

TEST(GatherProbe, KnowsNothingOfBatchesThatNoPathGathered) {
  Rounds some(0.4, 0.1), all(0.4, 0.1);
  for (const int count : {4, 4, 0, 0, 6, 0, 4}) some.gatherBatch(count);
  for (const int count : {4, 4, 6, 4}) all.gatherBatch(count);
  // Not the same random numbers: those that nobody gathered took some.
  EXPECT_NEAR(some.probe().photonsShare(), all.probe().photonsShare(), 0.15);
  EXPECT_NEAR(some.probe().photonsShare(), some.expectedShare(), 0.1);
}

TEST(GatherProbe, BeforeTwoBatchesIsUnknown) {
  Rounds rounds(0.4, 0.1);
  EXPECT_EQ(rounds.probe().photonsShare(), 1.0);
  rounds.gatherBatch(4);
  EXPECT_EQ(rounds.probe().photonsShare(), 1.0);
}

TEST(GatherProbe, GoesOnFromItsState) {
  Rounds rounds(0.4, 0.1), others(0.4, 0.1);
  rounds.gatherBatch(4);
  rounds.gatherBatch(6);
  StateWriter writer;
  rounds.probe().visitState(writer);
  StateReader reader(writer.bytes());
  others.probe().visitState(reader);
  EXPECT_TRUE(reader.isDone());
  EXPECT_EQ(others.probe().photonsShare(), rounds.probe().photonsShare());
}

}  // namespace
}  // namespace nephroid
