#include "trace/cell_hash.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <vector>

namespace nephroid {
namespace {

TEST(HashOfCell, TellsCellsOfAFloorAboutTheOriginApart) {
  constexpr int kReach = 200;
  std::vector<std::uint32_t> hashes;
  for (int x = -kReach; x < kReach; ++x)
    for (int z = -kReach; z < kReach; ++z) hashes.push_back(hashOfCell(x, 0, z));
  const std::size_t cells = hashes.size();
  std::sort(hashes.begin(), hashes.end());
  hashes.erase(std::unique(hashes.begin(), hashes.end()), hashes.end());
  EXPECT_GT(hashes.size(), cells - cells / 100);
}

}  // namespace
}  // namespace nephroid
