#include "trace/interior.h"

#include <gtest/gtest.h>

namespace nephroid {
namespace {

Material makeMedium(int priority = 0) {
  Material m;
  m.priority = priority;
  return m;
}

TEST(InteriorList, IsEmptyInTheOpen) {
  const InteriorList list{};
  EXPECT_EQ(list.medium(), nullptr);
  EXPECT_FALSE(list.contains(0));
}

TEST(InteriorList, LastEnteredRulesAmongEquals) {
  const Material water = makeMedium(), glass = makeMedium();
  InteriorList list;
  list.enter(0, water);
  list.enter(1, glass);
  EXPECT_EQ(list.medium(), &glass);
  list.leave(1);
  EXPECT_EQ(list.medium(), &water);
}

TEST(InteriorList, HigherPriorityRulesHoweverLateEntered) {
  const Material glass = makeMedium(1), water = makeMedium(0);
  InteriorList list;
  list.enter(0, glass);
  list.enter(1, water);
  EXPECT_EQ(list.medium(), &glass);
  EXPECT_TRUE(list.rules(0));
}

TEST(InteriorList, SaysWhenItIsFull) {
  const Material m = makeMedium();
  InteriorList list;
  for (std::uint32_t i = 0; i < InteriorList::kCapacity; ++i) EXPECT_TRUE(list.enter(i, m));
  EXPECT_FALSE(list.enter(99, m));
}

TEST(Interface, OfLowerPrioritySolidInsideHigherIsNoEvent) {
  const Material glass = makeMedium(1), water = makeMedium(0);
  InteriorList list;
  list.enter(0, glass);
  const Interface into_water = findInterface(list, 1, water, true);
  EXPECT_FALSE(into_water.is_event);
  list.enter(1, water);
  // Out of the glass, the water that overlapped it comes to rule.
  const Interface out_of_glass = findInterface(list, 0, glass, false);
  EXPECT_TRUE(out_of_glass.is_event);
  EXPECT_EQ(out_of_glass.from, &glass);
  EXPECT_EQ(out_of_glass.to, &water);
}

TEST(Interface, OpenSurfaceMetFromInsideLeavesItsMedium) {
  const Material water = makeMedium();
  const InteriorList list{};
  const Interface out = findInterface(list, 0, water, false);
  EXPECT_TRUE(out.is_event);
  EXPECT_EQ(out.from, &water);
  EXPECT_EQ(out.to, nullptr);
}

TEST(Interface, ReflectionInsideAnOpenSurfaceIsRemembered) {
  const Material water = makeMedium();
  InteriorList list;
  reflectInside(list, 0, water, false);
  EXPECT_TRUE(list.contains(0));
  reflectInside(list, 0, water, false);
  EXPECT_EQ(list.count(), 1);
}

}  // namespace
}  // namespace nephroid
