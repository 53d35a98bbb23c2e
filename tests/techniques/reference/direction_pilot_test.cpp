// When a render learns directions, and that the picture stays the same.
#include "techniques/reference/direction_pilot.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>

#include "core/parallel.h"
#include "scene/load.h"

namespace nephroid {
namespace {

TEST(TimeToError, IsTheSquareOfSummedRoots) {
  const std::array<double, 3> variances{4, 0, 1}, costs{1, 5, 9};
  EXPECT_DOUBLE_EQ(timeToError(variances, costs), (2.0 + 3.0) * (2.0 + 3.0));
}

constexpr int kWidth = 48, kHeight = 36;

/// What of `beauty` photons do not make, as a render leaves it to paths.
class Paths {
 public:
  explicit Paths(const std::string& scene, std::uint32_t seed = 0)
      : data_(loadScene(scene)),
        world_(data_, data_.cameras.front(), kWidth, kHeight, ReferenceOptions{.seed = seed}),
        needs_({"beauty"}),
        tracer_(world_, needs_) {
    tracer_.leaveToPhotons({.caustic = true, .indirect = true, .specular_caustic = true, .specular_indirect = true});
  }

  DirectionGuide learn() { return learnDirections(world_, data_.cameras.front(), kWidth, kHeight, needs_, tracer_); }
  /// `indirect`, in all.
  double brightness(const DirectionGuide& guide, std::uint32_t passes) {
    tracer_.guideBy(&guide);
    Film film(kWidth, kHeight, needs_);
    parallelFor(kHeight, [&](std::size_t y) {
      PathCounters counters;
      for (std::uint32_t pass = 0; pass < passes; ++pass)
        for (int x = 0; x < kWidth; ++x) tracer_.tracePath(x, static_cast<int>(y), pass, film, counters);
    });
    double sum = 0.0;
    for (std::size_t pixel = 0; pixel < kWidth * kHeight; ++pixel) sum += film.indirect_from_eye.at(pixel).y;
    return sum / passes;
  }

 private:
  SceneData data_;
  ReferenceWorld world_;
  LayerNeeds needs_;
  PathTracer tracer_;
};

/// Mean of several scramblings, and its standard error.
struct Spread {
  double mean = 0.0, error = 0.0;
};
Spread spreadOf(const DirectionGuide& guide, std::uint32_t first_seed, std::uint32_t passes) {
  constexpr std::uint32_t kSeeds = 8;
  double sum = 0.0, squares = 0.0;
  for (std::uint32_t seed = 0; seed < kSeeds; ++seed) {
    const double value = Paths("builtin:prism", first_seed + seed).brightness(guide, passes);
    sum += value, squares += value * value;
  }
  const double mean = sum / kSeeds;
  return {mean, std::sqrt(std::max(squares / kSeeds - mean * mean, 0.0) / (kSeeds - 1))};
}

TEST(DirectionPilot, GuidesThroughThePrismIntoThePlatesShadow) {
  // All that lights the plate's shadow but the spectrum is the floor as the prism shows it.
  const DirectionGuide guide = Paths("builtin:prism").learn();
  ASSERT_FALSE(guide.empty());
  const Spread plain = spreadOf({}, 10, 64), guided = spreadOf(guide, 30, 64);
  EXPECT_NEAR(guided.mean, plain.mean, 3.5 * std::hypot(plain.error, guided.error));
  EXPECT_LT(plain.error, 0.05 * plain.mean);
  EXPECT_LT(guided.error, plain.error);
}

TEST(DirectionPilot, LeavesScenesAloneWhereItDoesNotPay) {
  EXPECT_TRUE(Paths("builtin:coffee").learn().empty());
  // Under water there is nothing that the BSDF finds seldom, and photons bring what is.
  EXPECT_TRUE(Paths("builtin:seabed").learn().empty());
}

}  // namespace
}  // namespace nephroid
