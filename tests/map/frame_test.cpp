// SPDX-License-Identifier: BSD-3-Clause
#include "masked_mapper/map/trajectory.hpp"

#include <gtest/gtest.h>

namespace masked_mapper {
namespace {

TEST(Frame, EverythingMovesTogether) {
  BuildingMap map;
  map.graph.AddFloor({});
  Node node;
  node.T_odom_robot = {1.0, 0.0, 0.0};
  node.T_world_robot = {1.0, 0.5, 0.1};
  map.graph.AddNode(node);
  TrajectoryPose pose;
  pose.T_odom_robot = {2.0, 0.0, 0.0};
  pose.T_world_robot = {2.0, 0.5, 0.1};
  map.trajectory.push_back(pose);
  map.places.push_back({"dock", 0, {1.0, 2.0}});
  map.areas.push_back({AreaKind::kErased, 0, {{0, 0}, {1, 0}, {0, 1}}});
  const Pose2 T{10.0, 20.0, M_PI / 2};
  MoveMap(T, map);
  EXPECT_NEAR(map.graph.node(0).T_world_robot.x, 9.5, 1e-12);
  EXPECT_NEAR(map.graph.node(0).T_odom_robot.y, 21.0, 1e-12);
  EXPECT_NEAR(map.trajectory[0].T_world_robot.y, 22.0, 1e-12);
  EXPECT_NEAR(map.trajectory[0].T_odom_robot.x, 10.0, 1e-12);
  EXPECT_NEAR((map.places[0].at_in_world - Eigen::Vector2d(8.0, 21.0)).norm(), 0.0, 1e-12);
  EXPECT_NEAR((map.areas[0].corners_in_world[1] - Eigen::Vector2d(10.0, 21.0)).norm(), 0.0, 1e-12);
}

}  // namespace
}  // namespace masked_mapper
