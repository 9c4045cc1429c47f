// SPDX-License-Identifier: BSD-3-Clause
#include "masked_mapper/doubt/doubt.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "doubt/screened_map.hpp"

namespace masked_mapper {
namespace {

/// The poses from a share of the drive on, moved by `T_moved` about where it begins.
BuildingMap WithTheRestMoved(const BuildingMap& right, double share, const Pose2& T_moved) {
  BuildingMap map = right;
  const auto first = static_cast<std::size_t>(share * static_cast<double>(map.trajectory.size()));
  const Pose2 T_world_first = map.trajectory[first].T_world_robot;
  const Pose2 T_to_from = T_world_first * T_moved * Inverse(T_world_first);
  for (std::size_t i = first; i < map.trajectory.size(); ++i) {
    map.trajectory[i].T_world_robot = T_to_from * map.trajectory[i].T_world_robot;
  }
  return map;
}

TEST(Doubt, OfARightMapThereIsNone) {
  for (const Doubt& doubt : FindDoubts(RightMap())) ADD_FAILURE() << doubt.text;
}

TEST(Doubt, ASecondVisitThatHangsBesideTheFirstIsListedAtItsPlace) {
  for (const Pose2& T_moved :
       {Pose2{0.0, 0.8, 0.0}, Pose2{0.0, 0.0, DegToRad(8.0)}, Pose2{0.5, -0.6, DegToRad(-5.0)}}) {
    const BuildingMap wrong = WithTheRestMoved(RightMap(), 0.6, T_moved);
    const std::vector<Doubt> doubts = FindDoubts(wrong);
    const auto walls = std::find_if(doubts.begin(), doubts.end(), [](const Doubt& doubt) {
      return doubt.kind == DoubtKind::kWalls && !doubt.edit.empty();
    });
    ASSERT_NE(walls, doubts.end())
        << T_moved.x << " m, " << T_moved.y << " m, " << RadToDeg(T_moved.theta) << " deg";
    EXPECT_LT(walls->t_a, walls->t_b);
    EXPECT_GE(walls->size_m, 4.0);
    EXPECT_NE(walls->edit.find("- add_closure: {from: "), std::string::npos);
    double nearest = 1e9;
    for (const TrajectoryPose& pose : wrong.trajectory) {
      if (pose.stamp < walls->t_a || pose.stamp > walls->t_b) continue;
      nearest = std::min(
          nearest, std::hypot(pose.T_world_robot.x - walls->x, pose.T_world_robot.y - walls->y));
    }
    EXPECT_LT(nearest, 0.5) << "m from the way driven in its span";
  }
}

// Two floors of one plan taken for one agree in all but the wall that hides the stairs of one.
TEST(Doubt, AWayThroughAWallIsListedHoweverMuchElseAgrees) {
  const MapWithScreens screened;
  const BuildingMap& map = screened.map;
  const Pose2& T_world_screen = screened.T_world_screen;
  const std::vector<Doubt> doubts = FindDoubts(map);
  const auto way = std::find_if(doubts.begin(), doubts.end(), [](const Doubt& doubt) {
    return doubt.text.find("leads through a wall") != std::string::npos;
  });
  ASSERT_NE(way, doubts.end()) << screened.crossed << " of " << map.kept_scans.size();
  EXPECT_EQ(way->kind, DoubtKind::kWalls);
  EXPECT_LT(std::hypot(way->x - T_world_screen.x, way->y - T_world_screen.y), 1.0);
}

TEST(Doubt, AFloorThatMayBeAnOlderOneIsListedWhereItWasReached) {
  BuildingMap map = RightMap();
  const TrajectoryPose& reached = map.trajectory[map.trajectory.size() / 2];
  map.transits = {{reached.stamp - 20.0, reached.stamp, 3.5, 3.5, {"lidar"}, "it looks like two"},
                  {reached.stamp - 90.0, reached.stamp - 70.0, 0.2, 0.1, {"pressure"}, ""}};
  const std::vector<Doubt> doubts = FindDoubts(map);
  ASSERT_EQ(doubts.size(), 1U);
  EXPECT_EQ(doubts[0].kind, DoubtKind::kFloor);
  EXPECT_EQ(doubts[0].x, reached.T_world_robot.x);
  EXPECT_EQ(doubts[0].t_b, reached.stamp);
  EXPECT_NE(doubts[0].text.find("it looks like two"), std::string::npos);
}

TEST(Doubt, ARideThatClimbedWhatDoesNotLieBetweenItsFloorsIsListed) {
  BuildingMap map = RightMap();
  const TrajectoryPose& reached = map.trajectory[map.trajectory.size() / 2];
  map.transits = {{reached.stamp - 20.0, reached.stamp, 3.5, 0.1, {"pressure"}, ""}};
  const std::vector<Doubt> doubts = FindDoubts(map);
  ASSERT_EQ(doubts.size(), 1U);
  EXPECT_EQ(doubts[0].kind, DoubtKind::kFloor);
  EXPECT_NE(doubts[0].text.find("climbed 3.5 m"), std::string::npos) << doubts[0].text;
  map.transits[0].sigma_m = 3.5;
  EXPECT_TRUE(FindDoubts(map).empty()) << "nobody measured it";
}

TEST(Doubt, AClosureByHandThatContradictsTheRestIsListed) {
  BuildingMap map = RightMap();
  Closure wrong;
  wrong.older = 3;
  wrong.newer = static_cast<NodeId>(map.graph.nodes().size() - 1);
  wrong.T_older_newer.mean = Between(map.graph.node(wrong.older).T_world_robot,
                                     map.graph.node(wrong.newer).T_world_robot) *
                             Pose2{1.5, 0.0, 0.0};
  wrong.T_older_newer.covariance.diagonal() << 1e-4, 1e-4, 1e-5;
  wrong.state = ClosureState::kValidated;
  wrong.reason = ClosureReason::kAddedByHand;
  map.closures.push_back(wrong);
  AddClosureEdge(map.closures, static_cast<ClosureId>(map.closures.size() - 1), map.graph);
  const std::vector<Doubt> doubts = FindDoubts(map);
  ASSERT_EQ(doubts.size(), 1U);
  EXPECT_EQ(doubts[0].kind, DoubtKind::kClosure);
  EXPECT_NEAR(doubts[0].size_m, 1.5, 1e-6);
  EXPECT_NE(doubts[0].text.find("added by hand"), std::string::npos);
  EXPECT_NE(doubts[0].edit.find("- forbid_closure: "), std::string::npos);
}

TEST(Doubt, OfNothingThereIsNone) { EXPECT_TRUE(FindDoubts({}).empty()); }

}  // namespace
}  // namespace masked_mapper
