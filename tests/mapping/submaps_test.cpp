// SPDX-License-Identifier: BSD-3-Clause
#include "masked_mapper/mapping/submaps.hpp"

#include <gtest/gtest.h>

#include "mapping/ring_drive.hpp"

namespace masked_mapper {
namespace {

// The first leg of the ring, every scan kept, placed by a perfect motion path; a node at its
// middle.
MappingResult FirstLeg(const RingDrive& drive, std::size_t scans) {
  MappingResult map;
  map.graph.AddFloor({});
  for (std::size_t i = 0; i < scans; ++i) {
    TrajectoryPose pose;
    pose.stamp = drive.scans[i].stamp;
    pose.T_odom_robot = drive.truth[i];
    map.trajectory.push_back(pose);
    map.kept_scans.push_back({i, drive.scans[i]});
  }
  Node node;
  node.stamp = drive.scans[scans / 2].stamp;
  node.T_odom_robot = drive.truth[scans / 2];
  map.graph.AddNode(node);
  return map;
}

TEST(Submaps, RefineACoarseMatchToCentimetres) {
  const RingDrive drive(0.25, 0.0);
  const MappingResult map = FirstLeg(drive, 100);
  Submaps submaps({}, {}, map);
  const ScanPoints::ConstPtr points = PointsInRobot(drive.scans[53]);
  const Pose2 truth = Between(drive.truth[50], drive.truth[53]);
  UncertainPose2 coarse;
  coarse.mean = truth * Pose2{0.06, -0.08, DegToRad(1.5)};
  coarse.covariance.diagonal() << 0.01, 0.01, 0.001;
  const auto refined = submaps.Refine(0, *points, coarse);
  ASSERT_TRUE(refined);
  EXPECT_LT(Distance(refined->T_node_robot.mean, truth), 0.03) << "m";
  EXPECT_LT(RadToDeg(std::abs(refined->T_node_robot.mean.theta - truth.theta)), 0.3) << "deg";
  EXPECT_GT(refined->inlier_share, 0.6);
}

TEST(Submaps, AScanOfAnotherPlaceIsNotForcedIn) {
  const RingDrive drive(0.25, 0.0);
  const MappingResult map = FirstLeg(drive, 100);
  Submaps submaps({}, {}, map);
  BoxScene other;
  other.AddBox(-4.0, -3.0, 5.0, 6.0);
  UncertainPose2 coarse;
  coarse.covariance.diagonal() << 0.01, 0.01, 0.001;
  EXPECT_FALSE(submaps.Refine(0, *PointsInRobot(other.Scan({}, 181, 270.0)), coarse));
  EXPECT_FALSE(submaps.Refine(0, ScanPoints(), coarse));
}

}  // namespace
}  // namespace masked_mapper
