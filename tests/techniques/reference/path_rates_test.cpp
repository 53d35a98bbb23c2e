// Rates that tiles learn from their own paths.
#include "techniques/reference/path_rates.h"

#include <gtest/gtest.h>

#include <cmath>

#include "techniques/reference/checkpoint.h"

namespace nephroid {
namespace {

const PictureTiles kTiles(64, 8);  // eight in a row

/// Half of its rays are beyond the first diffuse event, and bring this.
PartTally pathOf(double brought) { return {.squares = {1.0, brought, 0, 0, 0}, .rays = {1.0, 1.0, 0, 0, 0}}; }

/// The left half of the picture finds nothing beyond the first diffuse event, the right half a quarter of its variance.
void notePass(PathRates& rates) {
  for (std::size_t tile = 0; tile < kTiles.count(); ++tile)
    kTiles.visitPixels(tile,
                       [&](int x, int y) { rates.note(tile, kTiles.pixelOf(x, y), pathOf(tile < 4 ? 0.0 : 0.25)); });
}

class PathRatesTest : public testing::Test {
 protected:
  PathRatesTest() {
    first_.probability[1] = 0.7F, first_.lesser_way = 0.6F;
    rates_ = PathRates(kTiles, first_);
  }
  float rateOf(std::size_t tile) const { return rates_.of(tile).probability[1]; }
  void learn(int passes) {
    for (int pass = 0; pass < passes; ++pass) notePass(rates_);
    rates_.choose(variances_, scales_);
  }

  Continuation first_;
  PathRates rates_{kTiles, {}};
  const std::vector<double> variances_ = std::vector<double>(8, 64.0);  ///< 1 of each pixel
  const std::vector<float> scales_ = std::vector<float>(kTiles.pixels(), 1.0F);
};

TEST_F(PathRatesTest, AreThoseOfThePilotUntilTilesKnowBetter) {
  learn(20);  // before it was known what the squares are relative to
  for (std::size_t tile = 0; tile < 8; ++tile) EXPECT_EQ(rateOf(tile), 0.7F);
  learn(15);
  for (std::size_t tile = 0; tile < 8; ++tile) EXPECT_EQ(rateOf(tile), 0.7F);
  rates_.choose({}, scales_);  // variances that are not known
  learn(1);
  for (std::size_t tile = 0; tile < 8; ++tile) EXPECT_NE(rateOf(tile), 0.7F);
}

TEST_F(PathRatesTest, DifferFromPlaceToPlace) {
  learn(0);
  learn(32);
  // Nothing is found, of a tile's neighbours neither: the least. In the middle three tiles count together.
  for (std::size_t tile = 0; tile < 3; ++tile) EXPECT_FLOAT_EQ(rateOf(tile), 0.1F) << tile;
  // √(0.25/0.5) of those who are found, twice that: always.
  for (std::size_t tile = 5; tile < 8; ++tile) EXPECT_FLOAT_EQ(rateOf(tile), 1.0F) << tile;
  // One of three: 2 √(0.25/3/0.5).
  EXPECT_NEAR(rateOf(3), 0.8165F, 1e-4F);
  // No lesser ways were met: they would cost nothing.
  EXPECT_EQ(rates_.of(0).lesser_way, 1.0F);
}

TEST_F(PathRatesTest, TakeOffWhatTheyAddedThemselves) {
  learn(0);
  for (int pass = 0; pass < 16; ++pass)
    for (std::size_t tile = 0; tile < kTiles.count(); ++tile)
      kTiles.visitPixels(tile, [&](int x, int y) {
        PartTally path = pathOf(0.02);
        path.excess = 0.5;
        rates_.note(tile, kTiles.pixelOf(x, y), path);
      });
  rates_.choose(variances_, scales_);
  EXPECT_NEAR(rateOf(0), 2.0F * std::sqrt(0.02F / 0.5F / 0.5F), 1e-4F);
}

TEST_F(PathRatesTest, AreKeptByCheckpoints) {
  learn(0);
  learn(32);
  StateWriter writer;
  rates_.visitState(writer);
  PathRates read(kTiles, {});
  StateReader reader(writer.bytes());
  read.visitState(reader);
  EXPECT_TRUE(reader.isDone());
  learn(8);
  for (int pass = 0; pass < 8; ++pass) notePass(read);
  read.choose(variances_, scales_);
  for (std::size_t tile = 0; tile < 8; ++tile) EXPECT_EQ(read.of(tile).probability, rates_.of(tile).probability);
}

}  // namespace
}  // namespace nephroid
