// SPDX-License-Identifier: BSD-3-Clause
#include "log/turn_of.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "masked_mapper/geometry/pose2.hpp"

namespace masked_mapper {
namespace {

/// Of one, beside others of which it must know nothing.
float TurnOf(float y, float x) {
  const Floats turns = TurnsOf(Floats{1.0F, y, 0.0F, -3.0F}, Floats{2.0F, x, 0.0F, 0.5F});
  return turns[1];
}

TEST(TurnOfTest, IsTheArcTangentInTurns) {
  double worst = 0.0;
  for (const double range : {1e-3, 1.0, 7.5, 9e3}) {
    for (int i = -50000; i <= 50000; ++i) {
      const double angle = kPi * i / 50000.0;
      const auto x = static_cast<float>(range * std::cos(angle));
      const auto y = static_cast<float>(range * std::sin(angle));
      const double turn = std::atan2(static_cast<double>(y), static_cast<double>(x)) / (2.0 * kPi);
      worst = std::max(worst, std::abs(TurnOf(y, x) - (turn + 0.5)));
    }
  }
  EXPECT_LT(worst, 1e-7);
}

TEST(TurnOfTest, QuartersAreExact) {
  EXPECT_EQ(TurnOf(0.0F, 2.0F), 0.5F);
  EXPECT_EQ(TurnOf(2.0F, 0.0F), 0.75F);
  EXPECT_EQ(TurnOf(-2.0F, 0.0F), 0.25F);
  EXPECT_EQ(TurnOf(0.0F, -2.0F), 1.0F);
  EXPECT_NEAR(TurnOf(-1e-9F, -2.0F), 0.0F, 1e-7);
  EXPECT_TRUE(std::isnan(TurnOf(0.0F, 0.0F)));
}

}  // namespace
}  // namespace masked_mapper
