#include "trace/morton_order.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <random>

namespace nephroid {
namespace {

TEST(MortonOrder, SortsStably) {
  std::mt19937 random(4);
  std::vector<std::uint32_t> keys;
  for (int i = 0; i < 5000; ++i) keys.push_back(random() % 700U * 1000U);
  std::vector<std::uint32_t> expected(keys.size());
  for (std::uint32_t i = 0; i < expected.size(); ++i) expected[i] = i;
  std::stable_sort(expected.begin(), expected.end(),
                   [&](std::uint32_t a, std::uint32_t b) { return keys[a] < keys[b]; });
  EXPECT_EQ(MortonOrder::sort(keys), expected);
  EXPECT_TRUE(MortonOrder::sort({}).empty());
}

TEST(MortonOrder, ARayHasTheKeyOfItsNearestPoint) {
  Bounds bounds;
  bounds.add(vec3(-1, 0, 2));
  bounds.add(vec3(3, 1, 4));
  const MortonOrder order(bounds);
  const vec3 place(0.4F, 0.5F, 3.6F), dir(1, 0, 0);  // of its line the point with the centre's x
  EXPECT_EQ(order.keyOf(place - 7.0F * dir, dir), order.keyOf(vec3(1.0F, place.y, place.z)));
}

TEST(MortonOrder, PutsNeighboursTogether) {
  Bounds targets;
  targets.add(vec3(-1));
  targets.add(vec3(1));
  const MortonOrder order(targets);
  std::mt19937 random(9);
  std::uniform_real_distribution<float> uniform(-1.0F, 1.0F);
  std::vector<vec3> places;
  std::vector<std::uint32_t> keys;
  for (int i = 0; i < 4096; ++i) {
    places.emplace_back(uniform(random), 0.0F, uniform(random));
    keys.push_back(order.keyOf(places.back() + vec3(0, 5, 0), vec3(0, -1, 0)));
  }
  const std::vector<std::uint32_t> sorted = MortonOrder::sort(keys);
  double shuffled = 0.0, ordered = 0.0;
  for (std::size_t i = 1; i < sorted.size(); ++i) {
    shuffled += length(places[i] - places[i - 1]);
    ordered += length(places[sorted[i]] - places[sorted[i - 1]]);
  }
  // 64² points on 2 m are 3 cm apart; a Morton curve jumps now and then.
  EXPECT_LT(ordered, 0.1 * shuffled);
}

}  // namespace
}  // namespace nephroid
