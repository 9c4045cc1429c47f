// SPDX-License-Identifier: BSD-3-Clause
#include "export/cloud_poses.hpp"

#include <gtest/gtest.h>

namespace masked_mapper {
namespace {

BuildingMap Drive() {
  BuildingMap map;
  for (const double elevation : {0.0, 3.5}) {
    Floor floor;
    floor.label = elevation > 0.0 ? "1" : "0";
    floor.elevation = elevation;
    map.graph.AddFloor(floor);
  }
  const auto add = [&](double stamp, const Pose2& pose, FloorId floor, bool in_transit) {
    TrajectoryPose added;
    added.stamp = added.log_stamp = stamp;
    added.floor = floor;
    added.in_transit = in_transit;
    added.T_world_robot = pose;
    map.trajectory.push_back(added);
  };
  add(1.0, {0.0, 0.0, 0.0}, 0, false);
  add(1.1, {0.1, 0.0, 0.0}, 0, false);  // too near
  add(1.2, {0.1, 0.0, 0.3}, 0, false);  // but turned
  add(1.3, {0.3, 0.0, 0.3}, 0, false);
  add(1.4, {1.0, 0.0, 0.3}, 0, true);  // in the cab
  add(1.5, {0.3, 0.0, 0.3}, 1, false);
  return map;
}

TEST(CloudPosesTest, TakesWhatWasSeenFromElsewhere) {
  const BuildingMap map = Drive();
  CloudPoses poses(map, {}, std::nullopt);
  EXPECT_NE(poses.Take(1.0), nullptr);
  EXPECT_EQ(poses.Take(1.1), nullptr);
  EXPECT_NE(poses.Take(1.2), nullptr);
  EXPECT_NE(poses.Take(1.3), nullptr);
  EXPECT_EQ(poses.Take(1.4), nullptr);
  EXPECT_EQ(poses.Take(1.45), nullptr);
  const TrajectoryPose* const above = poses.Take(1.5);
  ASSERT_NE(above, nullptr);
  EXPECT_EQ(poses.counts().taken, 4U);
  EXPECT_EQ(poses.counts().unknown, 1U);
  const Eigen::Vector3d p = poses.T_world_level(*above) * Eigen::Vector3d(0.0, 0.0, 1.0);
  EXPECT_NEAR(p.x(), 0.3, 1e-12);
  EXPECT_NEAR(p.z(), 4.5, 1e-12);
}

TEST(CloudPosesTest, OfOneFloorOnly) {
  const BuildingMap map = Drive();
  CloudPoses poses(map, {}, 1);
  EXPECT_EQ(poses.Take(1.0), nullptr);
  EXPECT_NE(poses.Take(1.5), nullptr);
}

}  // namespace
}  // namespace masked_mapper
