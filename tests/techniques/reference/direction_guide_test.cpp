// What a guide learned of directions, and how it draws them.
#include "techniques/reference/direction_guide.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <limits>

#include "core/sampling/sampler.h"
#include "core/sampling/warp.h"

namespace nephroid {
namespace {

/// Lessons from around `from`, a square of side `extent` in X and Z, drawn evenly over the sphere; light comes from a
/// ball, and from nowhere else.
std::vector<DirectionLesson> makeLessons(std::uint32_t count, vec3 from, float extent, vec3 centre, float radius) {
  std::vector<DirectionLesson> lessons;
  for (std::uint32_t i = 0; i < count; ++i) {
    Sampler sampler(5, 0, i);
    const vec2 place = sampler.next2D() - 0.5F;
    DirectionLesson lesson{.position = from + extent * vec3(place.x, 0, place.y),
                           .dir = sampleUniformSphere(sampler.next2D()),
                           .pdf = pdfSolidAngleUniformSphere(),
                           .pdf_bsdf = pdfSolidAngleUniformSphere(),
                           .rays = 1.0F};
    const vec3 offset = centre - lesson.position;
    const float along = dot(offset, lesson.dir), miss = dot(offset, offset) - along * along;
    const bool hit = along > 0.0F && miss < radius * radius;
    lesson.value = hit ? 1.0F : 0.0F;
    lesson.distance = hit ? along - std::sqrt(radius * radius - miss) : std::numeric_limits<float>::infinity();
    lessons.push_back(lesson);
  }
  return lessons;
}

/// Integral over the sphere.
template <class Function>
double integrate(const Function& f) {
  constexpr std::uint32_t kPoints = 1 << 18;
  double sum = 0.0;
  for (std::uint32_t i = 0; i < kPoints; ++i) {
    Sampler sampler(9, 0, i);
    sum += f(sampleUniformSphere(sampler.next2D())) / (pdfSolidAngleUniformSphere() * kPoints);
  }
  return sum;
}

bool isTowards(vec3 dir, vec3 from, vec3 centre, float radius) {
  const vec3 offset = centre - from;
  const float along = dot(offset, dir);
  return along > 0.0F && dot(offset, offset) - along * along < radius * radius;
}

const vec3 kBall(0.3F, 0.5F, 0.1F);
constexpr float kRadius = 0.15F;

TEST(DirectionLobe, DensityIntegratesToOne) {
  std::vector<DirectionLesson> lessons = makeLessons(20'000, vec3(0), 0.5F, kBall, kRadius);
  const DirectionLobe lobe(lessons);
  ASSERT_FALSE(lobe.empty());
  for (const vec3 place : {vec3(0), vec3(0.2F, 0, -0.2F), vec3(1.2F, 0, 0.4F)})
    EXPECT_NEAR(integrate([&](vec3 dir) { return lobe.pdf(place, dir); }), 1.0, 0.02) << place.x;
  // From within what it aims at there are all directions.
  EXPECT_NEAR(integrate([&](vec3 dir) { return lobe.pdf(kBall, dir); }), 1.0, 0.02);
}

TEST(DirectionLobe, DrawsByItsDensity) {
  std::vector<DirectionLesson> lessons = makeLessons(20'000, vec3(0), 0.5F, kBall, kRadius);
  const DirectionLobe lobe(lessons);
  constexpr std::uint32_t kDraws = 1 << 14;
  for (const vec3 place : {vec3(0), vec3(0.2F, 0, -0.2F), kBall}) {
    vec3 drawn(0.0F);
    for (std::uint32_t i = 0; i < kDraws; ++i) {
      Sampler sampler(3, 1, i);
      const vec3 dir = lobe.sample(place, sampler.next2D());
      EXPECT_NEAR(length(dir), 1.0F, 1e-4F);
      EXPECT_GT(lobe.pdf(place, dir), 0.0F);
      drawn += dir / static_cast<float>(kDraws);
    }
    for (const int axis : {0, 1, 2})
      EXPECT_NEAR(integrate([&](vec3 dir) { return lobe.pdf(place, dir) * dir[axis]; }), drawn[axis], 0.02) << axis;
  }
}

TEST(DirectionLobe, AimsAtWhatIsNearFromWhereItIsAsked) {
  // Two places of one cell see the ball some 60° apart.
  std::vector<DirectionLesson> lessons = makeLessons(20'000, vec3(0), 1.0F, vec3(0, 0.4F, 0), kRadius);
  const DirectionLobe lobe(lessons);
  constexpr std::uint32_t kDraws = 4096;
  for (const vec3 place : {vec3(-0.4F, 0, 0), vec3(0.4F, 0, 0)}) {
    double hits = 0.0;
    for (std::uint32_t i = 0; i < kDraws; ++i) {
      Sampler sampler(4, 1, i);
      hits += isTowards(lobe.sample(place, sampler.next2D()), place, vec3(0, 0.4F, 0), kRadius) ? 1.0 : 0.0;
    }
    // The ball fills 1 % of the sphere or less.
    EXPECT_GT(hits / kDraws, 0.5) << place.x;
  }
}

TEST(DirectionLobe, DrawsWhatIsDearLessOften) {
  const vec3 left(-1, 1, 0), right(1, 1, 0);
  const auto shareOfRight = [&](float rays_of_right) {
    std::vector<DirectionLesson> lessons = makeLessons(20'000, vec3(0), 0.1F, left, 0.3F);
    std::vector<DirectionLesson> others = makeLessons(20'000, vec3(0), 0.1F, right, 0.3F);
    for (DirectionLesson& lesson : others)
      if (lesson.value > 0.0F) lesson.rays = rays_of_right;
    lessons.insert(lessons.end(), others.begin(), others.end());
    const DirectionLobe lobe(lessons);
    return integrate([&](vec3 dir) { return dir.x > 0.0F ? lobe.pdf(vec3(0), dir) : 0.0F; });
  };
  EXPECT_NEAR(shareOfRight(1.0F), 0.5, 0.03);
  // √(2 / 18) as often: a way costs what comes before it as well. Balls reach a little beyond the points that they
  // hold, the more so the fewer those are.
  EXPECT_NEAR(shareOfRight(17.0F), 0.25, 0.05);
}

TEST(DirectionLobe, KnowsWhatItsLessonsGained) {
  // All light comes from a hundredth of the sphere, and half of the ways went there.
  std::vector<DirectionLesson> lessons;
  for (int i = 0; i < 1000; ++i) {
    const bool there = i % 2 == 0;
    lessons.push_back({.position = vec3(0),
                       .dir = vec3(0, there ? 1 : -1, 0),
                       .distance = 1.0F,
                       .pdf = there ? 5.0F : 0.05F,
                       .pdf_bsdf = 0.1F,
                       .value = there ? 1.0F : 0.0F,
                       .rays = 1.0F});
  }
  // Squares: Σ 1/25 against Σ (1/25)·50; rays: 1000·2 against 500·2·0.02 + 500·2·2.
  EXPECT_NEAR(DirectionLobe(lessons).gain(), 50.0 * (500.0 * 2.02) / 1000.0, 0.1);
}

TEST(DirectionLobe, DoesNotSpendEverythingOnOnePoint) {
  std::vector<DirectionLesson> lessons = makeLessons(1000, vec3(0), 0.5F, vec3(0, 100, 0), 1e-3F);
  const vec3 up(0, 1, 0);
  for (const float distance : {0.2F, 1e4F, std::numeric_limits<float>::infinity()}) {
    lessons[17].value = 1.0F, lessons[17].dir = up, lessons[17].position = vec3(0), lessons[17].distance = distance;
    std::vector<DirectionLesson> copy = lessons;
    const DirectionLobe lobe(copy);
    Sampler sampler(3, 2, 0);
    const vec3 dir = lobe.sample(vec3(0), sampler.next2D());
    EXPECT_GT(dot(dir, up), 0.99F) << distance;
    // A cone of a hundredth: 1 / (π·10⁻⁴) a steradian.
    EXPECT_GT(lobe.pdf(vec3(0), dir), 100.0F) << distance;
    EXPECT_LT(lobe.pdf(vec3(0), dir), 4000.0F) << distance;
  }
}

TEST(DirectionLobe, KnowsNothingOfDarkness) {
  std::vector<DirectionLesson> lessons = makeLessons(1000, vec3(0), 0.5F, vec3(0, 100, 0), 1e-3F);
  EXPECT_TRUE(DirectionLobe(lessons).empty());
}

TEST(DirectionGuide, TellsPlacesApart) {
  const vec3 left(-10, 0, 0), right(10, 0, 0), up(0, 0, 0);
  std::vector<DirectionLesson> lessons = makeLessons(40'000, left, 1.0F, left + vec3(0, 1, 0), 0.4F);
  const std::vector<DirectionLesson> others = makeLessons(40'000, right, 1.0F, right + vec3(0, -1, 0), 0.4F);
  lessons.insert(lessons.end(), others.begin(), others.end());
  const DirectionGuide guide(lessons);
  const auto upwards = [&](vec3 place) {
    const DirectionLobe* lobe = guide.at(place);
    return lobe ? integrate([&](vec3 dir) { return dir.y > 0.0F ? lobe->pdf(place, dir) : 0.0F; }) : 0.5;
  };
  EXPECT_GT(upwards(left), 0.98);
  EXPECT_LT(upwards(right), 0.02);
}

TEST(DirectionGuide, ForgetsWhatGainedNothing) {
  DirectionGuide guide(makeLessons(2000, vec3(0), 0.5F, kBall, kRadius));
  EXPECT_NE(guide.at(vec3(0)), nullptr);
  guide.keepWhatPays();  // drawn by the BSDF alone: a gain of 1
  EXPECT_EQ(guide.at(vec3(0)), nullptr);
}

TEST(DirectionGuide, KnowsNothingWithoutLessons) {
  EXPECT_TRUE(DirectionGuide().empty());
  EXPECT_EQ(DirectionGuide().at(vec3(0)), nullptr);
  EXPECT_TRUE(DirectionGuide(std::vector<DirectionLesson>()).empty());
}

}  // namespace
}  // namespace nephroid
