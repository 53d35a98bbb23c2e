#include "techniques/layers.h"

#include <gtest/gtest.h>

#include "nephroid/error.h"

namespace nephroid {
namespace {

TEST(ParseLayerList, OrdersAndRemovesRepetition) {
  EXPECT_EQ(parseLayerList("depth,caustic,beauty,caustic"), (std::vector<std::string>{"beauty", "caustic", "depth"}));
}

TEST(ParseLayerList, UnknownNameIsAUsageErrorWithASuggestion) {
  try {
    parseLayerList("caustics");
    FAIL();
  } catch (const UsageError& error) {
    EXPECT_NE(std::string(error.what()).find("caustic'"), std::string::npos) << error.what();
  }
}

TEST(LayerInfos, FiveLayersPartitionBeauty) {
  int summed = 0;
  for (const LayerInfo& info : layerInfos()) summed += info.summed;
  EXPECT_EQ(summed, 5);
}

}  // namespace
}  // namespace nephroid
