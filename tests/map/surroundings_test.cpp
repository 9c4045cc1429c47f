// SPDX-License-Identifier: BSD-3-Clause
#include "masked_mapper/map/surroundings.hpp"

#include <gtest/gtest.h>

namespace masked_mapper {
namespace {

/// A scan every half metre along x, each of one point a metre ahead; two drives, two floors.
BuildingMap Line() {
  BuildingMap map;
  map.graph.AddFloor({"0"});
  map.graph.AddFloor({"1"});
  for (int i = 0; i < 20; ++i) {
    TrajectoryPose pose;
    pose.stamp = i;
    pose.T_world_robot = {0.5 * i, 2.0, 0.0};
    pose.floor = i < 3 ? 1 : 0;
    map.trajectory.push_back(pose);
    KeptScan kept;
    kept.trajectory_index = static_cast<std::size_t>(i);
    kept.scan.stamp = i;
    kept.scan.max_range = 30.0F;
    kept.scan.ranges = {1.0F};
    map.kept_scans.push_back(kept);
  }
  Node node;
  node.stamp = 5.0;
  node.T_world_robot = map.trajectory[5].T_world_robot;
  map.graph.AddNode(node);
  node.stamp = 15.0;
  map.graph.AddNode(node);
  map.drives.resize(2);
  map.drives[1].first_pose = 15;
  map.drives[1].first_node = 1;
  return map;
}

TEST(Surroundings, GoesAsFarAsAskedInTheNodesFrame) {
  const ScanPoints::Ptr points =
      PointsAround(Line(), 0, {1.0, 0.5, LaidOutBy::kOptimisation}, 30.0);
  ASSERT_EQ(points->size(), 5U);
  float least = 9.0F;
  float most = -9.0F;
  for (const pcl::PointXY& point : *points) {
    EXPECT_FLOAT_EQ(point.y, 0.0F);
    least = std::min(least, point.x);
    most = std::max(most, point.x);
  }
  EXPECT_FLOAT_EQ(least, 0.0F) << "two scans back, one metre ahead";
  EXPECT_FLOAT_EQ(most, 2.0F);
}

TEST(Surroundings, EndsWithTheFloorAndTheDrive) {
  EXPECT_EQ(PointsAround(Line(), 0, {100.0, 0.5, LaidOutBy::kOptimisation}, 30.0)->size(), 12U)
      << "scans 3 to 14";
  EXPECT_TRUE(PointsAround(Line(), 0, {100.0, 0.5, LaidOutBy::kOptimisation}, 0.5)->empty())
      << "all points are farther";
}

}  // namespace
}  // namespace masked_mapper
