#include "core/support_tree.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

namespace nephroid {
namespace {

double supportByHand(const std::vector<vec3>& points, const dvec3& d) {
  double most = -std::numeric_limits<double>::infinity();
  for (const vec3& p : points) most = std::max(most, dot(dvec3(p), d));
  return most;
}

class SupportTreeTest : public ::testing::Test {
 protected:
  vec3 randomVector() { return {uniform_(random_), uniform_(random_), uniform_(random_)}; }
  std::vector<vec3> randomPoints(std::size_t count) {
    std::vector<vec3> points(count);
    for (vec3& p : points) p = randomVector() * vec3(1, 20, 0.1F) + vec3(3, -7, 100);
    return points;
  }

 private:
  std::mt19937 random_{11};
  std::uniform_real_distribution<float> uniform_{-1.0F, 1.0F};
};

TEST_F(SupportTreeTest, FindsTheFarthestOfAllPoints) {
  for (const std::size_t count : {1, 2, 8, 9, 100, 5000}) {
    const std::vector<vec3> points = randomPoints(count);
    const SupportTree tree(points);
    for (int i = 0; i < 200; ++i) {
      const dvec3 d(randomVector());
      EXPECT_EQ(dot(dvec3(*tree.farthest(d)), d), supportByHand(points, d)) << count;
    }
  }
}

TEST_F(SupportTreeTest, TakesPointsThatAreAllOne) {
  const SupportTree tree(std::vector<vec3>(1000, vec3(1, 2, 3)));
  EXPECT_EQ(*tree.farthest(dvec3(1, 0, -1)), vec3(1, 2, 3));
  EXPECT_EQ(tree.bounds().extent(), vec3(0));
}

TEST_F(SupportTreeTest, FindsNothingBeyondTheFarthest) {
  const std::vector<vec3> points = randomPoints(300);
  const SupportTree tree(points);
  const dvec3 d(1, 0, 0);
  const double reach = supportByHand(points, d);
  EXPECT_EQ(tree.farthest(d, reach), nullptr);
  ASSERT_NE(tree.farthest(d, std::nextafter(reach, 0.0)), nullptr);
}

TEST_F(SupportTreeTest, WithoutPointsReachesNowhere) {
  const SupportTree tree({});
  EXPECT_TRUE(tree.empty());
  EXPECT_TRUE(tree.bounds().empty());
  EXPECT_EQ(tree.farthest(dvec3(1, 0, 0)), nullptr);
}

TEST(SupportOfBox, IsThatOfItsCorners) {
  const Bounds box{{-1, 2, 3}, {4, 5, 6}};
  EXPECT_EQ(supportOf(box, dvec3(1, -1, 0)), 2.0);
  EXPECT_EQ(supportOf(box, dvec3(-2, 0, 1)), 8.0);
  EXPECT_EQ(supportOf(Bounds(), dvec3(1, 0, 0)), -std::numeric_limits<double>::infinity());
}

}  // namespace
}  // namespace nephroid
