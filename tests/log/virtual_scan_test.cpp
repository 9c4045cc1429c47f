// SPDX-License-Identifier: BSD-3-Clause
#include "log/virtual_scan.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "masked_mapper/geometry/pose2.hpp"
#include "sensor/room_cloud.hpp"

namespace masked_mapper {
namespace {

using Box = Eigen::AlignedBox3d;

LaserScan ScanOf(const RoomCloud& room) {
  CloudPoints points = room.Seen();
  const Ground ground = GroundFinder().Find(points, Eigen::Vector3d::Zero(), {});
  const Eigen::Isometry3d T_level_robot = ground.T_level_robot();
  Move(T_level_robot, &points);
  const Eigen::Vector3d lidar = T_level_robot.translation();
  return CutToScan(points, lidar, BandBetween(ground, lidar.z(), {}), 50.0F);
}

/// Share of the directions in which the scan has the wall of the empty room, and whether none has
/// anything else.
struct Walls {
  double share = 0.0;
  double worst_m = 0.0;
};

Walls HeldAgainst(const LaserScan& scan, const RoomCloud& room) {
  Walls walls;
  for (std::size_t beam = 0; beam < scan.size(); ++beam) {
    if (!scan.IsHit(beam)) continue;
    walls.share += 1.0 / static_cast<double>(scan.size());
    const double x = scan.ranges[beam] * std::cos(scan.Angle(beam));
    const double y = scan.ranges[beam] * std::sin(scan.Angle(beam));
    const double off =
        std::max(std::abs(x) - room.room.max().x(), std::abs(y) - room.room.max().y());
    walls.worst_m = std::max(walls.worst_m, std::abs(off));
  }
  return walls;
}

float RangeAt(const LaserScan& scan, double angle) {
  const double index = std::round((angle - scan.first_angle) / scan.angle_step);
  return scan.ranges[static_cast<std::size_t>(index) % scan.size()];
}

TEST(VirtualScanTest, AnEmptyRoomIsItsWalls) {
  const RoomCloud room;
  const Walls walls = HeldAgainst(ScanOf(room), room);
  EXPECT_GT(walls.share, 0.99);
  EXPECT_LT(walls.worst_m, 0.02);
}

TEST(VirtualScanTest, ATiltedCloudDoesNotPaintTheFloorAsAWall) {
  for (const double tilt_deg : {3.0, 6.0}) {
    RoomCloud room;
    room.room = Box(Eigen::Vector3d(-25.0, -4.0, 0.0), Eigen::Vector3d(25.0, 4.0, 2.7));
    room.T_world_lidar = Tilted(0.0, tilt_deg, 0.6);
    // Also where nobody knows that it is tilted.
    CloudPoints points = room.Seen();
    Move(Eigen::Isometry3d(Eigen::Translation3d(0.0, 0.0, 0.6)), &points);
    const LaserScan unlevelled = CutToScan(points, {0.0, 0.0, 0.6}, {0.3, 1.8}, 50.0F);
    for (std::size_t beam = 0; beam < unlevelled.size(); ++beam) {
      if (!unlevelled.IsHit(beam)) continue;
      const double x = unlevelled.ranges[beam] * std::cos(unlevelled.Angle(beam));
      const double y = unlevelled.ranges[beam] * std::sin(unlevelled.Angle(beam));
      EXPECT_NEAR(std::max(std::abs(y) - 4.0, std::abs(x) - 25.0), 0.0, 0.3)
          << tilt_deg << " " << x << " " << y;
    }
    const Walls walls = HeldAgainst(ScanOf(room), room);
    EXPECT_GT(walls.share, 0.8) << tilt_deg;
    EXPECT_LT(walls.worst_m, 0.1) << tilt_deg;
  }
}

TEST(VirtualScanTest, ATableIsNoWallAndALintelIsNone) {
  RoomCloud room;
  room.boxes = {Box(Eigen::Vector3d(2.0, -0.8, 0.70), Eigen::Vector3d(3.0, 0.8, 0.74)),
                Box(Eigen::Vector3d(-3.2, -0.8, 2.0), Eigen::Vector3d(-3.0, 0.8, 2.7))};
  const LaserScan scan = ScanOf(room);
  EXPECT_NEAR(RangeAt(scan, 0.0), 6.0, 0.05);
  EXPECT_NEAR(RangeAt(scan, kPi), 6.0, 0.05);
}

TEST(VirtualScanTest, ACupboardAndAPillarAreWalls) {
  RoomCloud room;
  room.boxes = {Box(Eigen::Vector3d(3.0, -0.5, 0.0), Eigen::Vector3d(3.5, 0.5, 2.0)),
                Box(Eigen::Vector3d(-2.1, -0.1, 0.0), Eigen::Vector3d(-1.9, 0.1, 2.7))};
  const LaserScan scan = ScanOf(room);
  EXPECT_NEAR(RangeAt(scan, 0.0), 3.0, 0.05);
  EXPECT_NEAR(RangeAt(scan, kPi), 1.9, 0.05);
}

TEST(VirtualScanTest, StepsThatGoUpAreNoWall) {
  RoomCloud room;
  for (int step = 0; step < 8; ++step) {
    const double near = 2.0 + 0.28 * step;
    room.boxes.emplace_back(Eigen::Vector3d(near, -0.8, 0.0),
                            Eigen::Vector3d(near + 0.28, 0.8, 0.17 * (step + 1)));
  }
  room.boxes.emplace_back(Eigen::Vector3d(4.24, -0.8, 0.0), Eigen::Vector3d(6.0, 0.8, 1.36));
  const float range = RangeAt(ScanOf(room), 0.0);
  EXPECT_TRUE(std::isnan(range) || range > 5.5F) << range;
}

TEST(VirtualScanTest, AnyLidarGivesTheSameWalls) {
  RoomCloud upward;  // as a solid-state lidar that looks up
  upward.rings = 40;
  upward.columns = 500;
  upward.lowest_deg = -7.0;
  upward.highest_deg = 52.0;
  upward.room = Box(Eigen::Vector3d(-5.0, -4.0, 0.0), Eigen::Vector3d(5.0, 4.0, 2.7));
  CloudPoints points = upward.Seen();
  Move(Eigen::Isometry3d(Eigen::Translation3d(0.0, 0.0, 0.6)), &points);
  const Walls walls = HeldAgainst(CutToScan(points, {0.0, 0.0, 0.6}, {0.3, 1.8}, 50.0F), upward);
  EXPECT_GT(walls.share, 0.95);
  EXPECT_LT(walls.worst_m, 0.13);  // in a corner, which a beam is as wide as
}

TEST(VirtualScanTest, TheBandIsWhereWallsAre) {
  Ground ground;
  EXPECT_NEAR(BandBetween(ground, 0.6, {}).low_m, 0.3, 1e-9);
  EXPECT_NEAR(BandBetween(ground, 0.6, {}).high_m, 1.8, 1e-9);
  ground.ceiling_m = 1.9;
  EXPECT_NEAR(BandBetween(ground, 0.6, {}).high_m, 1.6, 1e-9);
  EXPECT_NEAR(BandBetween(ground, 0.2, {}).low_m, 0.1, 1e-9);     // a vacuum cleaner's lidar
  EXPECT_NEAR(BandBetween(Ground{}, 2.2, {}).high_m, 2.4, 1e-9);  // one on a mast
  EXPECT_NEAR(BandBetween(ground, 0.6, {1.0, 1.5}).low_m, 1.0, 1e-9);
  EXPECT_NEAR(BandBetween(ground, 0.6, {1.0, 1.5}).high_m, 1.5, 1e-9);
}

TEST(VirtualScanTest, OfNothingComesNothing) {
  const LaserScan scan = CutToScan({}, {0.0, 0.0, 0.6}, {0.3, 1.8}, 50.0F);
  EXPECT_FALSE(scan.ranges.empty());
  for (const float range : scan.ranges) EXPECT_TRUE(std::isnan(range));
}

}  // namespace
}  // namespace masked_mapper
