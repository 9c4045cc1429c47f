// SPDX-License-Identifier: BSD-3-Clause
#include "localization/carry_watch.hpp"

#include <gtest/gtest.h>

namespace masked_mapper {
namespace {

LaserScan At(double stamp, std::optional<double> x) {
  LaserScan scan;
  scan.stamp = stamp;
  if (x) scan.T_odom_robot = Pose2{*x, 0.0, 0.0};
  return scan;
}

TEST(CarryWatch, ADriveIsNoCarrying) {
  CarryWatch watch;
  watch.Break();  // before the first log there is nothing to break off
  for (int i = 0; i < 20; ++i) EXPECT_EQ(watch.Observe(At(0.2 * i, 0.3 * i)), "");
}

TEST(CarryWatch, TellsAGapAJumpAndAnotherLog) {
  CarryWatch watch;
  EXPECT_EQ(watch.Observe(At(0.0, 0.0)), "");
  EXPECT_EQ(watch.Observe(At(60.0, 0.0)), "no scan for 60.0 s");
  EXPECT_EQ(watch.Observe(At(60.2, 9.0)), "the odometry jumped");
  EXPECT_EQ(watch.Observe(At(60.4, std::nullopt)), "");
  watch.Break();
  EXPECT_EQ(watch.Observe(At(3.0, 0.0)), "another log began");
  EXPECT_EQ(watch.Observe(At(3.2, 0.1)), "");
}

}  // namespace
}  // namespace masked_mapper
