#include "trace/masked_grid.h"

#include <gtest/gtest.h>

#include <random>

namespace nephroid {
namespace {

TEST(MaskedGrid, SamplesMarkedCellsOnlyAndEvenly) {
  MaskedGrid grid(8, 8);
  grid.mark(1, 2);
  grid.mark(5, 2);
  grid.mark(7, 7);
  grid.finish();
  EXPECT_EQ(grid.markedCount(), 3U);
  EXPECT_DOUBLE_EQ(grid.markedFraction(), 3.0 / 64.0);
  int counts[3] = {};
  for (int j = 0; j < 60; ++j) {
    for (int i = 0; i < 60; ++i) {
      const vec2 p =
          grid.sample(vec2((static_cast<float>(i) + 0.5F) / 60.0F, (static_cast<float>(j) + 0.5F) / 60.0F)) * 8.0F;
      const int x = static_cast<int>(p.x), y = static_cast<int>(p.y);
      ASSERT_TRUE(grid.isMarked(x, y)) << x << ' ' << y;
      ++counts[y == 7 ? 2 : x == 1 ? 0 : 1];
    }
  }
  for (const int count : counts) EXPECT_EQ(count, 1200);
}

TEST(MaskedGrid, UpperEndOfTheSquareStaysInside) {
  MaskedGrid grid(4, 4);
  grid.mark(3, 3);
  grid.finish();
  const vec2 p = grid.sample(vec2(kOneMinusEpsilon));
  EXPECT_LE(p.x, 1.0F);
  EXPECT_LE(p.y, 1.0F);
}

TEST(MaskedGrid, InvertUndoesSample) {
  MaskedGrid grid(16, 16);
  for (int y = 2; y < 15; ++y)
    for (int x = 0; x < 16; ++x)
      if ((x * 7 + y * 5) % 3 != 0 && y != 9) grid.mark(x, y);
  grid.finish();
  for (int j = 0; j < 50; ++j)
    for (int i = 0; i < 50; ++i) {
      const vec2 u((static_cast<float>(i) + 0.4F) / 50.0F, (static_cast<float>(j) + 0.3F) / 50.0F);
      const vec2 back = grid.invert(grid.sample(u));
      ASSERT_NEAR(back.x, u.x, 1e-5F) << i << ' ' << j;
      ASSERT_NEAR(back.y, u.y, 1e-5F) << i << ' ' << j;
    }
}

TEST(SquareFromCap, UndoesCapFromSquare) {
  for (const float h : {2.0F, 1.0F, 1e-3F, 1e-7F})
    for (int j = 0; j < 40; ++j)
      for (int i = 0; i < 40; ++i) {
        const vec2 u((static_cast<float>(i) + 0.4F) / 40.0F, (static_cast<float>(j) + 0.3F) / 40.0F);
        const vec2 back = squareFromCap(capFromSquare(u, h), h);
        ASSERT_NEAR(back.x, u.x, 2e-4F) << h << ' ' << i << ' ' << j;
        ASSERT_NEAR(back.y, u.y, 2e-4F) << h << ' ' << i << ' ' << j;
      }
}

TEST(CapFromSquare, IsUnitAndFillsTheCapEvenly) {
  // The mean of z over a cap of height h is 1 − h/2 (Archimedes).
  for (const float h : {2.0F, 1.0F, 1e-3F, 1e-7F}) {
    double sum = 0.0;
    constexpr int kN = 200;
    for (int j = 0; j < kN; ++j) {
      for (int i = 0; i < kN; ++i) {
        const vec3 d = capFromSquare(vec2((static_cast<float>(i) + 0.5F) / kN, (static_cast<float>(j) + 0.5F) / kN), h);
        ASSERT_NEAR(length(d), 1.0F, 1e-5F);
        sum += (1.0 - d.z) / h;
      }
    }
    // For the smallest cap 1 − z has lost its digits; the length across has not.
    if (h > 1e-5F) {
      EXPECT_NEAR(sum / (kN * kN), 0.5, 2e-3) << h;
    }
  }
}

TEST(MarkCaps, CoversEveryDirectionOfTheCap) {
  std::mt19937 random(7);
  std::uniform_real_distribution<float> uniform(-1.0F, 1.0F);
  for (const float h : {2.0F, 0.3F}) {
    for (int trial = 0; trial < 20; ++trial) {
      vec3 axis = normalize(vec3(uniform(random), uniform(random), uniform(random)));
      if (h < 1.0F) axis = normalize(vec3(0.3F * axis.x, 0.3F * axis.y, 1.0F));
      const float angle = 0.02F + 0.2F * std::abs(uniform(random));
      MaskedGrid grid(64, 64);
      markCaps(grid, h, {{axis, std::cos(angle), std::sin(angle)}});
      // Every cell whose centre lies in the cap must be marked.
      for (int y = 0; y < 64; ++y)
        for (int x = 0; x < 64; ++x) {
          const vec3 d =
              capFromSquare(vec2((static_cast<float>(x) + 0.5F) / 64, (static_cast<float>(y) + 0.5F) / 64), h);
          if (dot(d, axis) > std::cos(angle)) {
            ASSERT_TRUE(grid.isMarked(x, y)) << x << ' ' << y;
          }
        }
      grid.finish();
      const double cap = (1.0 - std::cos(angle)) / h;
      // About the antipode the square's whole border is one point, and cells are long: there the bound is loose.
      if (h == 2.0F && axis.z > -0.7F) {
        EXPECT_LT(grid.markedFraction(), 4.0 * cap + 0.02);
      }
    }
  }
}

TEST(CapMerger, CoversWhatItMerges) {
  std::mt19937 random(11);
  std::uniform_real_distribution<float> uniform(-0.2F, 0.2F);
  CapMerger merger(0.02F);
  std::vector<DirectionCap> caps;
  for (int i = 0; i < 5000; ++i) {
    const float angle = 0.02F + 0.1F * std::abs(uniform(random));
    caps.push_back({normalize(vec3(uniform(random), uniform(random), 1)), std::cos(angle), std::sin(angle)});
    merger.add(caps.back());
  }
  EXPECT_LT(merger.caps().size(), 1500U);
  for (const DirectionCap& cap : caps) {
    // Points of its border.
    const Frame frame = Frame::fromZ(cap.axis);
    for (int k = 0; k < 8; ++k) {
      const float phi = static_cast<float>(k) * kPi / 4.0F;
      const vec3 d = frame.toWorld(vec3(cap.sin_angle * std::cos(phi), cap.sin_angle * std::sin(phi), cap.cos_angle));
      EXPECT_TRUE(std::any_of(merger.caps().begin(), merger.caps().end(),
                              [&](const DirectionCap& m) { return dot(m.axis, d) >= m.cos_angle - 1e-6F; }));
    }
  }
  for (const DirectionCap& merged : merger.caps()) EXPECT_GT(merged.cos_angle, std::cos(0.04F + 0.02F * 1.8F));
}

}  // namespace
}  // namespace nephroid
