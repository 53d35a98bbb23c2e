// What tiles remember of light samples.
#include "techniques/reference/penumbra_finder.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <functional>
#include <vector>

#include "techniques/reference/checkpoint.h"

namespace nephroid {
namespace {

constexpr int kSide = PictureTiles::kSide;
const PictureTiles kTiles(2 * kSide, kSide);

TEST(PenumbraFinder, LooksEverywhereUntilSomethingIsKnown) {
  PenumbraFinder finder(kTiles);
  EXPECT_TRUE(finder.mayBeAt(1, 0, 0));
  finder.note(0, 0, 4, 4);
  EXPECT_FALSE(finder.mayBeAt(1, 0, 0));
  EXPECT_TRUE(finder.mayBeAt(kSide + 1, 0, 0)) << "of the other tile nothing is known";
}

TEST(PenumbraFinder, LooksAtAQuarterOfATileOnce) {
  PenumbraFinder finder(kTiles);
  finder.note(0, 0, 4, 4);
  int first = 0, later = 0;
  kTiles.visitPixels(0, [&](int x, int y) {
    first += finder.mayBeAt(x, y, 0) ? 1 : 0;
    later += finder.mayBeAt(x, y, 1) ? 1 : 0;
  });
  EXPECT_EQ(first, kSide * kSide / 4);
  EXPECT_EQ(later, 0);
}

TEST(PenumbraFinder, RemembersThatSamplesDisagreed) {
  // Within a path, and from one to the other; whatever comes after.
  for (const std::uint32_t seen : {3U, 0U}) {
    PenumbraFinder finder(kTiles);
    finder.note(0, 0, 4, 4);
    finder.note(2, 0, seen, 4);
    for (int i = 0; i < 100; ++i) finder.note(1, 1, 1, 1);
    EXPECT_TRUE(finder.mayBeAt(5, 5, 9)) << seen;
  }
}

TEST(PenumbraFinder, IsKeptByCheckpoints) {
  PenumbraFinder before(kTiles), after(kTiles);
  before.note(0, 0, 4, 4);
  before.note(kSide, 0, 2, 4);
  StateWriter writer;
  before.visitState(writer);
  StateReader reader(writer.bytes());
  after.visitState(reader);
  EXPECT_TRUE(reader.isDone());
  EXPECT_FALSE(after.mayBeAt(1, 1, 1));
  EXPECT_TRUE(after.mayBeAt(kSide + 1, 1, 1));
}

TEST(PictureTiles, VisitAQuarterOfTheirPixelsFirst) {
  std::vector<bool> first;
  std::vector<int> visits(kTiles.pixels(), 0);
  kTiles.visitPixels(1, [&](int x, int y) {
    first.push_back(PictureTiles::comesFirst(x, y));
    ++visits[kTiles.pixelOf(x, y)];
  });
  EXPECT_TRUE(std::is_sorted(first.begin(), first.end(), std::greater<>()));
  EXPECT_EQ(std::count(first.begin(), first.end(), true), kSide * kSide / 4);
  EXPECT_EQ(std::count(visits.begin(), visits.end(), 1), kSide * kSide);
}

}  // namespace
}  // namespace nephroid
