// SPDX-License-Identifier: BSD-3-Clause
#include "motion/gyro_bias.hpp"

#include <gtest/gtest.h>

namespace masked_mapper {
namespace {

constexpr double kTruth = 5e-5;  // rad/s, 0.003 deg/s

TEST(GyroBias, IsNoneBeforeAnythingWasSeen) {
  GyroBias bias({});
  EXPECT_DOUBLE_EQ(bias.rate(), 0.0);
  bias.Observe({1.0, {}});
  EXPECT_DOUBLE_EQ(bias.rate(), 0.0);
}

TEST(GyroBias, RecoversTheDriftOfARobotAtRest) {
  GyroBias bias({});
  for (int i = 0; i < 1500; ++i) bias.Observe({0.2 * i, {3.0, 4.0, kTruth * 0.2 * i}});
  EXPECT_NEAR(bias.rate(), kTruth, 0.05 * kTruth);
}

TEST(GyroBias, LearnsNothingFromARobotThatDrivesOrTurns) {
  GyroBias bias({});
  for (int i = 0; i < 500; ++i) bias.Observe({0.2 * i, {0.1 * i, 0.0, kTruth * 0.2 * i}});
  for (int i = 500; i < 1000; ++i) bias.Observe({0.2 * i, {50.0, 0.0, 0.01 * i}});
  EXPECT_DOUBLE_EQ(bias.rate(), 0.0);
}

TEST(GyroBias, AWheelHeadingThatStandsStillHasNone) {
  GyroBias bias({});
  for (int i = 0; i < 500; ++i) bias.Observe({0.2 * i, {1.0, 2.0, 0.5}});
  EXPECT_DOUBLE_EQ(bias.rate(), 0.0);
}

TEST(GyroBias, PausesAndStampsThatStepBackAreNoRest) {
  GyroBias bias({});
  bias.Observe({0.0, {}});
  bias.Observe({100.0, {0.0, 0.0, 0.01}});
  bias.Observe({90.0, {0.0, 0.0, 0.0101}});
  EXPECT_DOUBLE_EQ(bias.rate(), 0.0);
}

TEST(GyroBias, FollowsADriftThatChanges) {
  GyroBias bias({});
  double theta = 0.0;
  double stamp = 0.0;
  const auto rest = [&](double seconds, double rate) {
    for (double s = 0.0; s < seconds; s += 0.2) {
      stamp += 0.2;
      theta += 0.2 * rate;
      bias.Observe({stamp, {0.0, 0.0, theta}});
    }
  };
  rest(300.0, kTruth);
  rest(600.0, -kTruth);
  EXPECT_NEAR(bias.rate(), -kTruth, 0.1 * kTruth);
}

}  // namespace
}  // namespace masked_mapper
