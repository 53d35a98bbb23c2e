#include "core/optics/dispersion.shared.h"

#include <gtest/gtest.h>

namespace nephroid {
namespace {

TEST(DispersiveIor, HasTheAbbeNumber) {
  // V_d = (n_d − 1)/(n_F − n_C) at 486.1327 and 656.2725 nm, by definition; BK7: n_d = 1.5168, V_d = 64.17.
  const float n_f = dispersiveIor(1.5168F, 20 / 64.17F, 486.1327F),
              n_c = dispersiveIor(1.5168F, 20 / 64.17F, 656.2725F);
  EXPECT_NEAR(0.5168 / (n_f - n_c), 64.17, 0.02);
}

TEST(DispersiveIor, IsTheGivenIndexAtTheDLine) { EXPECT_NEAR(dispersiveIor(1.8F, 1.0F, 587.5618F), 1.8F, 2e-5F); }

TEST(DispersiveIor, WithoutDispersionIsExactlyTheIndex) {
  for (const float nm : {380.0F, 500.0F, 720.0F}) EXPECT_EQ(dispersiveIor(1.5F, 0.0F, nm), 1.5F);
}

TEST(DispersiveIor, OfIndexOneDoesNotDisperse) { EXPECT_EQ(dispersiveIor(1.0F, 2.0F, 400.0F), 1.0F); }

TEST(DispersiveIor, NeverFallsBelowOne) { EXPECT_EQ(dispersiveIor(1.1F, 100.0F, 720.0F), 1.0F); }

TEST(DispersiveIor, BendsBlueMoreThanRed) {
  EXPECT_GT(dispersiveIor(1.5F, 0.3F, 450.0F), dispersiveIor(1.5F, 0.3F, 650.0F));
}

}  // namespace
}  // namespace nephroid
