// SPDX-License-Identifier: BSD-3-Clause
#include "log/odometry_at_scans.hpp"

#include <gtest/gtest.h>

#include <optional>
#include <vector>

namespace masked_mapper {
namespace {

LaserScan Scan(double stamp) {
  LaserScan scan;
  scan.stamp = stamp;
  return scan;
}

OdometryReading Odometry(double stamp) { return {stamp, {stamp, 2.0 * stamp, 0.0}}; }

std::vector<Observation> RunThrough(const std::vector<Observation>& observations) {
  OdometryAtScans at_scans;
  std::vector<Observation> result;
  for (const Observation& observation : observations) {
    at_scans.Add(observation, 0);
    while (auto next = at_scans.Next()) result.push_back(next->first);
  }
  at_scans.Finish();
  while (auto next = at_scans.Next()) result.push_back(next->first);
  EXPECT_EQ(result.size(), observations.size());
  for (std::size_t i = 0; i < result.size(); ++i)
    EXPECT_EQ(Stamp(result[i]), Stamp(observations[i]));
  return result;
}

TEST(OdometryAtScansTest, ReadsBetweenNeighbours) {
  const auto result = RunThrough({Odometry(1.0), Scan(1.25), Scan(1.5), Odometry(2.0), Scan(2.0)});
  EXPECT_NEAR(std::get<LaserScan>(result[1]).T_odom_robot->x, 1.25, 1e-12);
  EXPECT_NEAR(std::get<LaserScan>(result[2]).T_odom_robot->y, 3.0, 1e-12);
  EXPECT_NEAR(std::get<LaserScan>(result[4]).T_odom_robot->x, 2.0, 1e-12);
}

TEST(OdometryAtScansTest, GoesOnBrieflyBehindTheLastReadingAndStandsBeforeTheFirst) {
  const auto result =
      RunThrough({Scan(0.0), Scan(0.8), Odometry(1.0), Odometry(1.1), Scan(1.4), Scan(2.0)});
  EXPECT_FALSE(std::get<LaserScan>(result[0]).T_odom_robot);
  EXPECT_EQ(std::get<LaserScan>(result[1]).T_odom_robot->x, 1.0);
  EXPECT_NEAR(std::get<LaserScan>(result[4]).T_odom_robot->x, 1.4, 1e-12);
  EXPECT_FALSE(std::get<LaserScan>(result[5]).T_odom_robot);
}

// On an arc, by the way of the half second before; readings at rest go on resting.
TEST(OdometryAtScansTest, GoesOnAsItWent) {
  const Pose2 step{0.05, 0.0, 0.04};
  const auto behind_the_last = [&](bool is_moving, double behind_s) {
    OdometryAtScans at_scans;
    Pose2 pose;
    for (int i = 0; i <= 20; ++i) {
      at_scans.Add(OdometryReading{0.1 * i, pose}, 0);
      if (i < 20 && is_moving) pose = pose * step;
    }
    at_scans.Add(Scan(2.0 + behind_s), 0);
    at_scans.Finish();
    std::optional<Pose2> found;
    while (const auto next = at_scans.Next()) {
      if (const auto* scan = std::get_if<LaserScan>(&next->first)) found = scan->T_odom_robot;
    }
    return Between(pose, found.value());
  };
  Pose2 expected;
  for (const double behind_s : {0.1, 0.2, 0.3, 0.4, 0.5}) {
    expected = expected * step;
    const Pose2 moved = behind_the_last(true, behind_s);
    EXPECT_LT(Distance(moved, expected), 0.01) << "m, " << behind_s << " s behind";
    EXPECT_NEAR(moved.theta, expected.theta, 1e-9) << "rad";
    EXPECT_LT(Distance(behind_the_last(false, behind_s), Pose2{}), 1e-12) << "m";
  }
}

TEST(OdometryAtScansTest, ALongGapSaysNothing) {
  const auto result = RunThrough({Odometry(1.0), Scan(5.0), Odometry(9.0)});
  EXPECT_FALSE(std::get<LaserScan>(result[1]).T_odom_robot);
}

TEST(OdometryAtScansTest, OdometryThatTheScanHasIsKept) {
  LaserScan scan = Scan(1.5);
  scan.T_odom_robot = Pose2{7.0, 0.0, 0.0};
  const auto result = RunThrough({Odometry(1.0), scan, Odometry(2.0)});
  EXPECT_EQ(std::get<LaserScan>(result[1]).T_odom_robot->x, 7.0);
}

TEST(OdometryAtScansTest, WithoutScansNoReadingIsKeptForEver) {
  OdometryAtScans at_scans;
  for (int i = 0; i < 5000; ++i) {
    at_scans.Add(Odometry(0.01 * i), 0);
    while (at_scans.Next()) {
    }
  }
  EXPECT_LE(at_scans.readings_kept(), 110U);
  at_scans.Add(Scan(50.0), 0);
  at_scans.Finish();
  EXPECT_TRUE(std::get<LaserScan>(at_scans.Next()->first).T_odom_robot) << "held briefly";
}

TEST(OdometryAtScansTest, WithoutOdometryNothingIsHeldBackForEver) {
  OdometryAtScans at_scans;
  int out = 0;
  for (int i = 0; i < 5000; ++i) {
    at_scans.Add(Scan(0.001 * i), 0);
    while (at_scans.Next()) ++out;
  }
  EXPECT_GT(out, 3900);
}

}  // namespace
}  // namespace masked_mapper
