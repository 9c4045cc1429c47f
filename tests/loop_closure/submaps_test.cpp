// SPDX-License-Identifier: BSD-3-Clause
#include "loop_closure/submaps.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <utility>
#include <vector>

#include "mapping/ring_drive.hpp"

namespace masked_mapper {
namespace {

// The first leg of the ring, every scan kept, placed by a perfect motion path; a node at its
// middle.
BuildingMap FirstLeg(const RingDrive& drive, std::size_t scans) {
  BuildingMap map;
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
  const BuildingMap map = FirstLeg(drive, 100);
  Submaps submaps({}, map);
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
  const BuildingMap map = FirstLeg(drive, 100);
  Submaps submaps({}, map);
  BoxScene other;
  other.AddBox(-4.0, -3.0, 5.0, 6.0);
  UncertainPose2 coarse;
  coarse.covariance.diagonal() << 0.01, 0.01, 0.001;
  EXPECT_FALSE(submaps.Refine(0, *PointsInRobot(other.Scan({}, 181, 270.0)), coarse));
  EXPECT_FALSE(submaps.Refine(0, ScanPoints(), coarse));
}

TEST(Submaps, AnOdometryNodeSeesWhatTheScanKeptNearestSaw) {
  const RingDrive drive(0.25, 0.0);
  BuildingMap map = FirstLeg(drive, 100);
  // Between two kept scans, nearer to the later one.
  Node node;
  node.stamp = 0.5 * (drive.scans[60].stamp + drive.scans[61].stamp);
  node.T_odom_robot = drive.truth[60] * Pose2{0.15, 0.0, DegToRad(5.0)};
  const NodeId id = map.graph.AddNode(node);
  const std::size_t own = 7;
  node.scan = static_cast<KeptScanId>(own);
  node.T_odom_robot = map.trajectory[map.kept_scans[own].trajectory_index].T_odom_robot;
  const NodeId with_scan = map.graph.AddNode(node);
  node.T_odom_robot = map.graph.node(id).T_odom_robot;
  const Submaps submaps({}, map);
  const ScanPoints::ConstPtr own_points = PointsInRobot(map.kept_scans[own].scan);
  const ScanPoints::ConstPtr seen_with_scan = submaps.PointsAt(with_scan);
  ASSERT_EQ(seen_with_scan->size(), own_points->size());
  for (std::size_t i = 0; i < own_points->size(); ++i) {
    EXPECT_EQ((*seen_with_scan)[i].x, (*own_points)[i].x);
    EXPECT_EQ((*seen_with_scan)[i].y, (*own_points)[i].y);
  }
  const ScanPoints::ConstPtr seen = submaps.PointsAt(id);
  const ScanPoints::ConstPtr kept = PointsInRobot(drive.scans[61]);
  ASSERT_TRUE(seen);
  ASSERT_EQ(seen->size(), kept->size());
  for (std::size_t i = 0; i < seen->size(); ++i) {
    const Eigen::Vector2d in_world =
        node.T_odom_robot * Eigen::Vector2d((*seen)[i].x, (*seen)[i].y);
    const Eigen::Vector2d expected = drive.truth[61] * Eigen::Vector2d((*kept)[i].x, (*kept)[i].y);
    EXPECT_LT((in_world - expected).norm(), 1e-4) << "m";
  }
  map.kept_scans.clear();
  EXPECT_FALSE(submaps.PointsAt(id)) << "nothing was kept";
}

TEST(Submaps, TheSurroundingsAreWhatWasSeenFromTheWayToANodeAndOn) {
  const RingDrive drive(0.25, 0.0);
  BuildingMap map = FirstLeg(drive, 100);  // straight, so that way and distance are the same
  SubmapOptions options;
  options.half_length_m = 1.13;
  const Submaps submaps(options, map);
  const Pose2& T_world_node = drive.truth[50];
  std::vector<std::pair<float, float>> expected;
  std::size_t scans = 0;
  for (std::size_t i = 0; i < 100; ++i) {
    if (Distance(drive.truth[i], T_world_node) > options.half_length_m) continue;
    ++scans;
    const ScanPoints::ConstPtr points_in_robot = PointsInRobot(drive.scans[i]);
    for (const pcl::PointXY& point : *points_in_robot) {
      const Eigen::Vector2d in_node =
          Between(T_world_node, drive.truth[i]) * Eigen::Vector2d(point.x, point.y);
      expected.emplace_back(static_cast<float>(in_node.x()), static_cast<float>(in_node.y()));
    }
  }
  ASSERT_GT(scans, 3U);
  ASSERT_LT(scans, 100U);
  std::vector<std::pair<float, float>> seen;
  const ScanPoints::ConstPtr around = submaps.PointsAround(0);
  for (const pcl::PointXY& point : *around) seen.emplace_back(point.x, point.y);
  std::sort(expected.begin(), expected.end());
  std::sort(seen.begin(), seen.end());
  EXPECT_EQ(seen, expected);
  map.kept_scans.clear();
  EXPECT_TRUE(submaps.PointsAround(0)->empty()) << "nothing was kept";
}

}  // namespace
}  // namespace masked_mapper
