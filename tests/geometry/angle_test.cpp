// SPDX-License-Identifier: BSD-3-Clause
#include "masked_mapper/geometry/pose2.hpp"

#include <gtest/gtest.h>

#include <limits>

namespace masked_mapper {
namespace {

TEST(Angle, WrapKeepsTheDirectionAndTheInterval) {
  for (int turn = -5; turn <= 5; ++turn) {
    for (double angle = -3.1; angle <= 3.1; angle += 0.1) {
      const double wrapped = WrapAngle(angle + 2.0 * kPi * turn);
      EXPECT_NEAR(wrapped, angle, 1e-13);
    }
  }
}

TEST(Angle, WrapIsExactInsideAndPutsTheSeamAtPlusPi) {
  EXPECT_EQ(WrapAngle(0.1), 0.1);
  EXPECT_EQ(WrapAngle(kPi), kPi);
  EXPECT_EQ(WrapAngle(-kPi), kPi);
  EXPECT_GT(WrapAngle(3.0 * kPi), -kPi);
  EXPECT_TRUE(std::isnan(WrapAngle(std::numeric_limits<double>::quiet_NaN())));
}

TEST(Angle, DegreesGoThereAndBack) {
  EXPECT_DOUBLE_EQ(DegToRad(180.0), kPi);
  EXPECT_DOUBLE_EQ(RadToDeg(DegToRad(-33.0)), -33.0);
}

}  // namespace
}  // namespace masked_mapper
