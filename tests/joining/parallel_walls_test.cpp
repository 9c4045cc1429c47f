// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "mapping/ring_drive.hpp"
#include "masked_mapper/joining/floor_joining.hpp"

namespace masked_mapper {
namespace {

/// A ring of corridors on each of two storeys, mapped but for the ride between: what it turned is
/// wrong by `ride_deg`, and its edge doubts it by `doubt_deg`. The upper storey is built askew by
/// `askew_deg`.
struct TwoStoreys {
  RingDrive drive{1.0, 0.0};
  BuildingMap map;
  std::size_t reached = 0;  ///< the first node on the upper storey

  TwoStoreys(double ride_deg, double doubt_deg, double askew_deg, int storeys = 2) {
    Pose2 T_world_start;
    for (int storey = 0; storey < storeys; ++storey) {
      const auto floor =
          map.graph.AddFloor({std::to_string(storey), 3.5 * storey, 0.1, true, false});
      if (storey == 1) T_world_start.theta = DegToRad(ride_deg + askew_deg);
      for (std::size_t i = 0; i < drive.scans.size(); ++i) {
        if (i % 10 == 0) AddNode(T_world_start * drive.truth[i], floor, doubt_deg);
        Keep(T_world_start * drive.truth[i], floor, drive.scans[i]);
      }
    }
    map.drives.emplace_back();
  }

  double TurnOfUpper() const {
    return RadToDeg(WrapAngle(map.graph.nodes()[reached].T_world_robot.theta -
                              map.graph.nodes()[0].T_world_robot.theta));
  }

  std::size_t Ties() const {
    return static_cast<std::size_t>(
        std::count_if(map.graph.edges().begin(), map.graph.edges().end(),
                      [](const Edge& edge) { return edge.kind == EdgeKind::kHeading; }));
  }

 private:
  void AddNode(const Pose2& T_world_robot, FloorId floor, double doubt_deg) {
    Node node;
    node.floor = floor;
    node.T_odom_robot = node.T_world_robot = T_world_robot;
    const NodeId id = map.graph.AddNode(node);
    if (id == 0) return;
    const Node& before = map.graph.node(id - 1);
    const bool is_ride = before.floor != floor;
    if (is_ride) reached = static_cast<std::size_t>(id);
    const double sigma_rad = DegToRad(is_ride ? doubt_deg : 0.01);
    Edge edge{id - 1,
              id,
              {Between(before.T_world_robot, T_world_robot), Eigen::Matrix3d::Zero()},
              is_ride ? EdgeKind::kFloorChange : EdgeKind::kOdometry};
    edge.T_from_to.covariance.diagonal() << 1e-4, 1e-4, sigma_rad * sigma_rad;
    map.graph.AddEdge(edge);
  }

  void Keep(const Pose2& T_world_robot, FloorId floor, const LaserScan& scan) {
    TrajectoryPose pose;
    pose.floor = floor;
    pose.node_before = static_cast<NodeId>(map.graph.nodes().size() - 1);
    pose.T_odom_robot = pose.T_world_robot = T_world_robot;
    map.kept_scans.push_back({map.trajectory.size(), scan});
    map.trajectory.push_back(pose);
  }
};

TEST(ParallelWalls, TellHowAStoreyIsTurned) {
  for (const double ride_deg : {-0.15, 0.0, 0.15}) {
    TwoStoreys building(ride_deg, 0.5, 0.0);
    TieParallelWalls({}, 1, building.map);
    EXPECT_GT(building.Ties(), 0U) << ride_deg;
    EXPECT_NEAR(building.TurnOfUpper(), 0.0, 0.03) << "deg, of a ride off by " << ride_deg;
    const TrajectoryPose& last = building.map.trajectory.back();
    EXPECT_LT(Distance(last.T_world_robot, building.drive.truth.back()), 0.02) << "m";
  }
}

TEST(ParallelWalls, AreNoneOfAStoreyThatIsBuiltAskew) {
  for (const double askew_deg : {-1.0, 0.4, 0.7, 20.0, 45.0}) {
    TwoStoreys building(0.05, 0.4, askew_deg);
    TieParallelWalls({}, 1, building.map);
    EXPECT_EQ(building.Ties(), 0U) << askew_deg;
    EXPECT_NEAR(building.TurnOfUpper(), askew_deg + 0.05, 1e-6);
  }
}

TEST(ParallelWalls, SayNothingThatTheWayKnowsBetter) {
  TwoStoreys building(0.05, 0.1, 0.0);
  TieParallelWalls({}, 1, building.map);
  EXPECT_EQ(building.Ties(), 0U);
}

TEST(ParallelWalls, LeaveAMapOfOneFloorAsItIs) {
  TwoStoreys building(0.0, 0.5, 0.0, 1);
  TieParallelWalls({}, 1, building.map);
  EXPECT_EQ(building.Ties(), 0U);
  BuildingMap nothing;
  TieParallelWalls({}, 1, nothing);
  EXPECT_TRUE(nothing.graph.edges().empty());
}

TEST(ParallelWalls, SayTheSameAtAnyNumberOfThreads) {
  TwoStoreys one(0.1, 0.5, 0.0);
  TwoStoreys four(0.1, 0.5, 0.0);
  TieParallelWalls({}, 1, one.map);
  TieParallelWalls({}, 4, four.map);
  EXPECT_EQ(one.TurnOfUpper(), four.TurnOfUpper());
}

}  // namespace
}  // namespace masked_mapper
