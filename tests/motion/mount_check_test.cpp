// SPDX-License-Identifier: BSD-3-Clause
#include "masked_mapper/motion/wheel_check.hpp"

#include <gtest/gtest.h>

#include <algorithm>

#include "scan_matching/box_scene.hpp"

namespace masked_mapper {
namespace {

/// Drives round and round in a furnished room, or to and fro. The scanner truly sits at
/// `T_robot_laser`; the log says `said`. Wheels are 3 % long and turn 5 % too far.
std::vector<StretchPair> Drive(const Pose2& T_robot_laser, const Pose2& said, bool upside_down,
                               bool only_straight = false) {
  const BoxScene room = FurnishedRoom();
  WheelCheck check{MotionOptions{}};
  std::mt19937 random(1);
  Pose2 T_world_robot{2.5, 1.2, 0.0};
  Pose2 T_odom_robot{40.0, -7.0, 1.0};
  for (int i = 0; i < 1200; ++i) {
    Pose2 step{0.05, 0.0, 0.0};
    if (only_straight) {
      step.x = i / 40 % 2 == 0 ? 0.05 : -0.05;
    } else if (i % 20 >= 10) {
      step = {0.0, 0.0, DegToRad(4.0)};
    }
    T_world_robot = T_world_robot * step;
    T_odom_robot = T_odom_robot * Pose2{1.03 * step.x, 0.0, 1.05 * step.theta};
    LaserScan scan = room.Scan(T_world_robot * T_robot_laser, 271, 270.0, &random, 0.01);
    if (upside_down) std::reverse(scan.ranges.begin(), scan.ranges.end());
    scan.stamp = 0.2 * i;
    scan.T_robot_laser = said;
    scan.T_odom_robot = T_odom_robot;
    check.Observe(scan);
  }
  return check.Find({}).stretches;
}

MountFault Found(const Pose2& T_robot_laser, const Pose2& said, bool upside_down,
                 bool only_straight = false) {
  return FindMountFault(Drive(T_robot_laser, said, upside_down, only_straight));
}

TEST(MountCheck, ARightMountIsRight) {
  for (const Pose2& mount : {Pose2{}, Pose2{0.2, 0.1, 0.0}, Pose2{-0.3, 0.0, kPi}}) {
    const MountFault fault = Found(mount, mount, false);
    EXPECT_TRUE(fault.IsNone());
    EXPECT_EQ(WarningOf(fault, mount), "");
  }
}

TEST(MountCheck, AnUpsideDownScannerTurnsTheOtherWay) {
  const MountFault fault = Found({}, {}, true);
  EXPECT_TRUE(fault.upside_down);
  EXPECT_NE(WarningOf(fault, {}).find("log.upside_down"), std::string::npos);
}

TEST(MountCheck, FindsWhereTheScannerLooks) {
  for (const double yaw_deg : {-90.0, -12.0, 12.0, 90.0, 170.0}) {
    const Pose2 said{0.1, 0.0, 0.0};
    const MountFault fault = Found({0.1, 0.0, DegToRad(yaw_deg)}, said, false);
    EXPECT_NEAR(RadToDeg(fault.yaw), yaw_deg, 3.0);
    EXPECT_NE(WarningOf(fault, said).find("log.laser_theta_deg"), std::string::npos);
  }
}

TEST(MountCheck, FindsWhereTheScannerSits) {
  const MountFault fault = Found({0.5, -0.3, 0.0}, {0.1, 0.0, 0.0}, false);
  EXPECT_FALSE(fault.upside_down);
  EXPECT_EQ(fault.yaw, 0.0);
  EXPECT_NEAR(fault.offset.x(), 0.4, 0.05);
  EXPECT_NEAR(fault.offset.y(), -0.3, 0.05);
}

TEST(MountCheck, WithoutTurnsNothingIsSaidOfThem) {
  EXPECT_TRUE(Found({0.5, 0.5, 0.0}, {}, true, true).offset.isZero());
  EXPECT_FALSE(Found({}, {}, true, true).upside_down);
  EXPECT_TRUE(FindMountFault({}).IsNone());
}

}  // namespace
}  // namespace masked_mapper
