// SPDX-License-Identifier: BSD-3-Clause
#include "log/scan_merger.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "masked_mapper/geometry/pose2.hpp"

namespace masked_mapper {
namespace {

/// A 180 degree scan of a box of 10 x 6 m round the world's origin.
LaserScan BoxScan(const Pose2& T_world_robot, const Pose2& T_robot_laser, double stamp) {
  LaserScan scan;
  scan.stamp = stamp;
  scan.T_robot_laser = T_robot_laser;
  scan.first_angle = -kPi / 2;
  scan.angle_step = kPi / 180.0;
  scan.max_range = 20.0F;
  scan.T_odom_robot = T_world_robot;
  const Pose2 T_world_laser = T_world_robot * T_robot_laser;
  for (int beam = 0; beam <= 180; ++beam) {
    const double angle = T_world_laser.theta + scan.first_angle + beam * scan.angle_step;
    const double c = std::cos(angle), s = std::sin(angle);
    const double to_x = ((c > 0 ? 5.0 : -5.0) - T_world_laser.x) / c;
    const double to_y = ((s > 0 ? 3.0 : -3.0) - T_world_laser.y) / s;
    scan.ranges.push_back(static_cast<float>(std::min(to_x, to_y)));
  }
  return scan;
}

double DistanceToWall(const Eigen::Vector2d& point) {
  return std::abs(std::max(std::abs(point.x()) - 5.0, std::abs(point.y()) - 3.0));
}

TEST(ScanMergerTest, TwoScannersSeeTheWholeRoomFromTheRobot) {
  const Pose2 T_robot_front{0.4, 0.1, 0.1};
  const Pose2 T_robot_rear{-0.4, 0.0, kPi};
  const Pose2 T_world_then{0.9, 0.2, 0.3};
  const Pose2 T_world_now{1.0, 0.25, 0.35};
  ScanMerger merger(2);
  merger.Add(BoxScan(T_world_then, T_robot_rear, 9.95), 1);
  merger.Add(BoxScan(T_world_now, T_robot_front, 10.0), 0);
  EXPECT_FALSE(merger.Next());  // a nearer one may come
  merger.Finish();
  const std::optional<LaserScan> merged = merger.Next();
  ASSERT_TRUE(merged);
  EXPECT_EQ(merged->stamp, 10.0);
  EXPECT_TRUE(merged->IsFullCircle());
  EXPECT_EQ(merged->size(), 360U);
  std::size_t hits = 0;
  for (std::size_t beam = 0; beam < merged->size(); ++beam) {
    if (!merged->IsHit(beam)) continue;
    ++hits;
    const double angle = merged->Angle(beam);
    const Eigen::Vector2d point =
        T_world_now * Eigen::Vector2d(merged->ranges[beam] * std::cos(angle),
                                      merged->ranges[beam] * std::sin(angle));
    // Half a beam aside, a wall met at a slant is as far off as this.
    EXPECT_LT(DistanceToWall(point), 0.5 * merged->angle_step * merged->ranges[beam] + 1e-3) << "m";
  }
  EXPECT_GT(hits, 280U);
}

TEST(ScanMergerTest, JoinsTheNearestInTimeAndNoneTooFar) {
  ScanMerger merger(2);
  const Pose2 still;
  merger.Add(BoxScan(still, {0, 0, kPi}, 0.0), 1);
  merger.Add(BoxScan(still, {0, 0, 0}, 1.0), 0);
  merger.Add(BoxScan(still, {0, 0, kPi}, 1.05), 1);
  merger.Add(BoxScan(still, {0, 0, 0}, 3.0), 0);
  merger.Finish();
  const auto hits = [](const LaserScan& scan) {
    std::size_t count = 0;
    for (std::size_t beam = 0; beam < scan.size(); ++beam) count += scan.IsHit(beam) ? 1 : 0;
    return count;
  };
  EXPECT_GT(hits(*merger.Next()), 300U);
  const std::optional<LaserScan> alone = merger.Next();
  EXPECT_LT(hits(*alone), 200U);
  EXPECT_TRUE(std::isnan(alone->ranges[0]));  // behind, where nobody looked
  EXPECT_FALSE(merger.Next());
}

TEST(ScanMergerTest, NoReturnGivesWayToAHitOnly) {
  LaserScan empty = BoxScan({}, {}, 1.0);
  std::fill(empty.ranges.begin(), empty.ranges.end(), kNoReturn);
  const LaserScan full = BoxScan({}, {}, 1.0);
  const LaserScan merged = MergeScans({&empty, &full});
  const LaserScan only_empty = MergeScans({&empty});
  std::size_t hits = 0;
  std::size_t no_returns = 0;
  for (std::size_t beam = 0; beam < merged.size(); ++beam) {
    hits += merged.IsHit(beam) ? 1 : 0;
    no_returns += only_empty.ranges[beam] == kNoReturn ? 1 : 0;
    EXPECT_FALSE(only_empty.IsHit(beam));
  }
  EXPECT_GE(hits, 170U);
  EXPECT_GE(no_returns, 170U);
}

TEST(ScanMergerTest, ASilentFirstScannerHoldsNothing) {
  ScanMerger merger(2);
  for (int i = 0; i < 100; ++i) merger.Add(BoxScan({}, {}, 0.1 * i), 1);
  merger.Finish();
  EXPECT_FALSE(merger.Next());
}

}  // namespace
}  // namespace masked_mapper
