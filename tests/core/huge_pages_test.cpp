#include "core/huge_pages.h"

#include <gtest/gtest.h>

#include <cstdint>

namespace nephroid {
namespace {

struct alignas(64) Line {
  int number = 0;
};

TEST(HugePages, LargeTablesStartAtALargePageAndSmallOnesNeedNone) {
  HugePageVector<Line> small(3), large(100'000);
  EXPECT_EQ(reinterpret_cast<std::uintptr_t>(small.data()) % alignof(Line), 0U);
  EXPECT_EQ(reinterpret_cast<std::uintptr_t>(large.data()) % (std::uintptr_t{2} << 20), 0U);
}

TEST(HugePages, TablesGrowAcrossTheSizeOfALargePage) {
  HugePageVector<Line> table;
  for (int i = 0; i < 100'000; ++i) table.push_back({i});
  for (int i = 0; i < 100'000; ++i) ASSERT_EQ(table[i].number, i);
}

}  // namespace
}  // namespace nephroid
