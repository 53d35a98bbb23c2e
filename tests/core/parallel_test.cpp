#include "core/parallel.h"

#include <gtest/gtest.h>

#include <atomic>
#include <stdexcept>
#include <vector>

namespace nephroid {
namespace {

TEST(ParallelFor, VisitsEachIndexOnce) {
  std::vector<int> visits(10000, 0);
  runWithThreads(4, [&] { parallelFor(visits.size(), [&](std::size_t i) { ++visits[i]; }); });
  EXPECT_EQ(visits, std::vector<int>(visits.size(), 1));
}

TEST(ParallelFor, OfNothingDoesNothing) {
  parallelFor(0, [](std::size_t) { FAIL(); });
}

TEST(ParallelFor, ThrowsWhatABodyThrows) {
  std::atomic<int> visits{0};
  EXPECT_THROW(parallelFor(100000,
                           [&](std::size_t i) {
                             ++visits;
                             if (i == 7) throw std::runtime_error("seven");
                           }),
               std::runtime_error);
  EXPECT_LE(visits, 100000);
}

TEST(RunWithThreads, LeavesTheCountAsItWasIfTheWorkThrows) {
  const int before = availableThreads();
  EXPECT_THROW(runWithThreads(before + 1, [] { throw std::runtime_error("work"); }), std::runtime_error);
  EXPECT_EQ(availableThreads(), before);
}

TEST(RunWithThreads, SaysHowManyThereAre) {
  runWithThreads(3, [] { EXPECT_EQ(availableThreads(), 3); });
  runWithThreads(1, [] { EXPECT_EQ(availableThreads(), 1); });
}

}  // namespace
}  // namespace nephroid
