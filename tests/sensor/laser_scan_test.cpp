// SPDX-License-Identifier: BSD-3-Clause
#include "masked_mapper/sensor/laser_scan.hpp"

#include <gtest/gtest.h>
#include <limits>

namespace masked_mapper {
namespace {

LaserScan Fan(std::size_t beams, double span_deg) {
  LaserScan scan;
  scan.angle_step = DegToRad(span_deg) / static_cast<double>(beams);
  scan.max_range = 30.0F;
  scan.ranges.assign(beams, 2.0F);
  return scan;
}

TEST(LaserScan, FullCircleIsOneStepShortOfATurn) {
  EXPECT_TRUE(Fan(360, 360.0).IsFullCircle());
  EXPECT_TRUE(Fan(361, 361.0).IsFullCircle());  // the last beam on the first
  EXPECT_FALSE(Fan(359, 359.0).IsFullCircle());
  EXPECT_FALSE(Fan(180, 180.0).IsFullCircle());
  LaserScan mirrored = Fan(360, 360.0);
  mirrored.angle_step = -mirrored.angle_step;
  EXPECT_TRUE(mirrored.IsFullCircle());
  EXPECT_FALSE(LaserScan{}.IsFullCircle());
}

TEST(LaserScan, OnlyRangesBelowTheLimitAreHits) {
  LaserScan scan = Fan(5, 180.0);
  scan.ranges = {1.0F, kNoReturn, kInvalidRange, 30.0F, 29.9F};
  EXPECT_TRUE(scan.IsHit(0));
  EXPECT_FALSE(scan.IsHit(1));
  EXPECT_FALSE(scan.IsHit(2));
  EXPECT_FALSE(scan.IsHit(3));
  EXPECT_TRUE(scan.IsHit(4));
}

TEST(LaserScan, PointsGoThroughTheMounting) {
  LaserScan scan;
  scan.T_robot_laser = {0.5, 0.1, kPi / 2.0};
  scan.first_angle = -kPi / 2.0;
  scan.angle_step = kPi / 2.0;
  scan.max_range = 30.0F;
  scan.ranges = {1.0F, kNoReturn, 3.0F};
  const auto points = PointsInRobot(scan);
  ASSERT_EQ(points->size(), 2U);  // in beam order, misses left out
  EXPECT_NEAR(points->at(0).x, 1.5F, 1e-6F);
  EXPECT_NEAR(points->at(0).y, 0.1F, 1e-6F);
  EXPECT_NEAR(points->at(1).x, -2.5F, 1e-6F);
  EXPECT_NEAR(points->at(1).y, 0.1F, 1e-6F);
}

TEST(LaserScan, PointsOfAnEmptyScanAreNoneNotNull) {
  const auto points = PointsInRobot(LaserScan{});
  ASSERT_NE(points, nullptr);
  EXPECT_TRUE(points->empty());
}

TEST(ThinPoints, LeavesOnePointPerCell) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  const auto thinned = ThinPoints(
      *AsScanPoints({{0.01, 0.01}, {5, 5}, {0.03, 0.05}, {nan, 1}, {-0.01, 0.01}, {40, 0}}), 0.1,
      30.0);
  ASSERT_EQ(thinned.size(), 3U);
  EXPECT_NEAR(thinned[0].x(), 0.02, 1e-6);
  EXPECT_NEAR(thinned[0].y(), 0.03, 1e-6);
  EXPECT_NEAR(thinned[1].x(), 5.0, 1e-6);
  EXPECT_NEAR(thinned[2].x(), -0.01, 1e-6);
  EXPECT_EQ(ThinPoints(*AsScanPoints({{0.01, 0.01}, {0.01, 0.01}}), 0.0, 30.0).size(), 2U);
}

}  // namespace
}  // namespace masked_mapper
