// SPDX-License-Identifier: BSD-3-Clause
#include "masked_mapper/map/trajectory.hpp"

#include <gtest/gtest.h>

namespace masked_mapper {
namespace {

// A straight motion path of 11 scans, a metre apart, with nodes at 0, 4 and 8.
struct StraightDrive {
  PoseGraph graph;
  std::vector<TrajectoryPose> trajectory;

  StraightDrive() {
    graph.AddFloor({});
    for (int i = 0; i <= 10; ++i) {
      const Pose2 pose{static_cast<double>(i), 0.0, 0.0};
      if (i % 4 == 0) {
        Node node;
        node.T_odom_robot = pose;
        node.T_world_robot = pose;
        const NodeId id = graph.AddNode(node);
        if (id > 0) graph.AddEdge({id - 1, id, {}, EdgeKind::kOdometry});
      }
      TrajectoryPose scan;
      scan.T_odom_robot = pose;
      scan.node_before = static_cast<NodeId>(graph.nodes().size() - 1);
      trajectory.push_back(scan);
    }
  }
};

TEST(BendTrajectory, WithoutCorrectionsThePathStays) {
  StraightDrive drive;
  BendTrajectory(drive.graph, drive.trajectory);
  for (const TrajectoryPose& pose : drive.trajectory) {
    EXPECT_NEAR(Distance(pose.T_world_robot, pose.T_odom_robot), 0.0, 1e-12);
  }
}

TEST(BendTrajectory, MeetsTheNodesAndSpreadsTheCorrectionBetween) {
  StraightDrive drive;
  drive.graph.SetPose(1, {4.0, 0.4, 0.0});
  drive.graph.SetPose(2, {8.0, 0.0, 0.1});
  BendTrajectory(drive.graph, drive.trajectory);
  EXPECT_NEAR(drive.trajectory[0].T_world_robot.y, 0.0, 1e-12);
  EXPECT_NEAR(drive.trajectory[2].T_world_robot.y, 0.2, 1e-12) << "half way to 0.4";
  EXPECT_NEAR(drive.trajectory[4].T_world_robot.y, 0.4, 1e-12);
  EXPECT_NEAR(drive.trajectory[8].T_world_robot.theta, 0.1, 1e-12);
  // Behind the last node the motion path goes on from it, turned by its correction.
  EXPECT_NEAR(drive.trajectory[10].T_world_robot.x, 8.0 + 2.0 * std::cos(0.1), 1e-12);
  EXPECT_NEAR(drive.trajectory[10].T_world_robot.y, 2.0 * std::sin(0.1), 1e-12);
}

TEST(BendTrajectory, StandingStillBetweenTwoNodesDividesByNothing) {
  PoseGraph graph;
  graph.AddFloor({});
  graph.AddNode({});
  graph.AddNode({});
  std::vector<TrajectoryPose> trajectory(3);
  BendTrajectory(graph, trajectory);
  EXPECT_EQ(trajectory[1].T_world_robot.x, 0.0);
  std::vector<TrajectoryPose> none;
  BendTrajectory(graph, none);
}

}  // namespace
}  // namespace masked_mapper
