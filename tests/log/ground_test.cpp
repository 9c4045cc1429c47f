// SPDX-License-Identifier: BSD-3-Clause
#include "log/ground.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "masked_mapper/geometry/pose2.hpp"
#include "sensor/room_cloud.hpp"

namespace masked_mapper {
namespace {

const Eigen::Vector3d kNoLever = Eigen::Vector3d::Zero();

double Degrees(const Eigen::Vector3d& a, const Eigen::Vector3d& b) {
  return RadToDeg(std::acos(std::min(1.0, a.normalized().dot(b.normalized()))));
}

TEST(GroundTest, FindsFloorCeilingAndTilt) {
  for (const double tilt_deg : {0.0, 2.0, 6.0, 9.0}) {
    RoomCloud room;
    room.T_world_lidar = Tilted(tilt_deg, -0.5 * tilt_deg, 0.6);
    room.rings = 32;
    room.highest_deg = 45.0;
    const Ground ground = GroundFinder().Find(room.Seen(), kNoLever, {});
    ASSERT_TRUE(ground.is_seen) << tilt_deg;
    const Eigen::Vector3d up = room.T_world_lidar.linear().transpose() * Eigen::Vector3d::UnitZ();
    EXPECT_LT(Degrees(up, ground.up_in_robot), 0.3) << tilt_deg;
    EXPECT_NEAR(ground.floor_m, -0.6, 0.02) << tilt_deg;
    ASSERT_TRUE(ground.ceiling_m) << tilt_deg;
    EXPECT_NEAR(*ground.ceiling_m, 2.7 - 0.6, 0.1) << tilt_deg;
  }
}

TEST(GroundTest, ATiltIsFollowedFromCloudToCloud) {
  GroundFinder finder;
  for (int i = 0; i <= 20; ++i) {
    RoomCloud room;
    room.T_world_lidar = Tilted(0.4 * i, 0.0, 0.6);
    const Ground ground = finder.Find(room.Seen(), kNoLever, {});
    const Eigen::Vector3d up = room.T_world_lidar.linear().transpose() * Eigen::Vector3d::UnitZ();
    ASSERT_LT(Degrees(up, ground.up_in_robot), 0.3) << i;
  }
}

TEST(GroundTest, OnARampGravityIsUp) {
  RoomCloud room;  // as a robot sees it that stands parallel to the floor
  const Eigen::Vector3d gravity_up =
      Tilted(5.0, 0.0, 0.0).linear().transpose() * Eigen::Vector3d::UnitZ();
  const Ground ground = GroundFinder().Find(room.Seen(), kNoLever, gravity_up);
  EXPECT_LT(Degrees(ground.up_in_robot, gravity_up), 1e-3);
  // What an accelerometer is off by is not a ramp.
  const Eigen::Vector3d nearly = Tilted(1.5, 0.0, 0.0).linear() * Eigen::Vector3d::UnitZ();
  const Ground level = GroundFinder().Find(room.Seen(), kNoLever, nearly);
  EXPECT_LT(Degrees(level.up_in_robot, Eigen::Vector3d::UnitZ()), 0.3);
}

TEST(GroundTest, WithoutAFloorNothingIsClaimed) {
  EXPECT_FALSE(GroundFinder().Find({}, kNoLever, {}).is_seen);
  CloudPoints walls;
  RoomCloud room;
  for (const CloudPoint& point : room.Seen()) {
    if (point.position.z() > -0.4F && point.position.z() < 1.5F) walls.push_back(point);
  }
  const Ground ground = GroundFinder().Find(walls, kNoLever, {});
  EXPECT_FALSE(ground.is_seen);
  EXPECT_LT(ground.floor_m, -0.2);  // a lidar stands above its floor
  CloudPoints same(1000);
  EXPECT_FALSE(GroundFinder().Find(same, kNoLever, {}).is_seen);
}

TEST(GroundTest, LevellingKeepsTheHeading) {
  Ground ground;
  ground.up_in_robot = Eigen::Vector3d(0.1, -0.05, 1.0).normalized();
  ground.floor_m = -0.5;
  const Eigen::Isometry3d T = ground.T_level_robot();
  EXPECT_NEAR(T.linear().determinant(), 1.0, 1e-12);
  EXPECT_NEAR((T.linear() * ground.up_in_robot - Eigen::Vector3d::UnitZ()).norm(), 0.0, 1e-12);
  EXPECT_NEAR((T.linear() * Eigen::Vector3d::UnitX()).y(), 0.0, 1e-12);
  EXPECT_NEAR((T * Eigen::Vector3d::Zero()).z(), 0.5, 1e-12);
}

}  // namespace
}  // namespace masked_mapper
