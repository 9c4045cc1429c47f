// SPDX-License-Identifier: BSD-3-Clause
#include "joining/piece_search.hpp"

#include <gtest/gtest.h>

#include "mapping/ring_logs.hpp"
#include "masked_mapper/map/drives.hpp"

namespace masked_mapper {
namespace {

/// Both drives in one map, the second on a floor of its own, as they came.
BuildingMap SideBySide(BuildingMap first, const BuildingMap& second) {
  const auto nodes = static_cast<NodeId>(first.graph.nodes().size());
  const std::size_t poses = first.trajectory.size();
  const auto floor = first.graph.AddFloor(second.graph.floors().front());
  const double offset = 1e4;
  for (Node node : second.graph.nodes()) {
    node.stamp += offset;
    node.floor = floor;
    first.graph.AddNode(node);
  }
  for (TrajectoryPose pose : second.trajectory) {
    pose.stamp += offset;
    pose.floor = floor;
    pose.node_before += nodes;
    first.trajectory.push_back(pose);
  }
  for (KeptScan kept : second.kept_scans) {
    kept.scan.stamp += offset;
    kept.trajectory_index += poses;
    first.kept_scans.push_back(kept);
  }
  first.drives.push_back(second.drives.front());
  first.drives.back().first_node = nodes;
  first.drives.back().first_pose = poses;
  return first;
}

TEST(PieceSearch, FindsWhereADriveBegan) {
  const BuildingMap map =
      SideBySide(MapOf(First(), "piece_first.log"), MapOf(Second(), "piece_second.log"));
  const PieceSearchResult found = FindPiece(map, {0}, {1}, {}, {});
  ASSERT_TRUE(found.placement) << found.reason;
  EXPECT_LT(Distance(found.placement->T_older_newer, Second().truth.front()), 0.5) << "m";
  EXPECT_LT(
      std::abs(WrapAngle(found.placement->T_older_newer.theta - Second().truth.front().theta)),
      DegToRad(2.0));
  EXPECT_EQ(found.placement->older_floor_of, (std::map<FloorId, FloorId>{{1, 0}}));
  EXPECT_GE(found.placement->fitting, 4);
  MatcherOptions two_threads;
  two_threads.threads = 2;
  const PieceSearchResult again = FindPiece(map, {0}, {1}, {}, two_threads);
  ASSERT_TRUE(again.placement);
  EXPECT_EQ(again.placement->T_older_newer.AsVector(), found.placement->T_older_newer.AsVector());
}

TEST(PieceSearch, FloorsOfOtherNamesAreNotTried) {
  BuildingMap map =
      SideBySide(MapOf(First(), "piece_first.log"), MapOf(Second(), "piece_second.log"));
  int floor = 0;
  map = WithFloors(map, [&](Floor& changed) {
    changed.label = "floor " + std::to_string(floor++);
    changed.label_given = true;
  });
  EXPECT_FALSE(FindPiece(map, {0}, {1}, {}, {}).placement);
}

TEST(PieceSearch, NothingIsFoundByNothing) {
  BuildingMap map =
      SideBySide(MapOf(First(), "piece_first.log"), MapOf(Second(), "piece_second.log"));
  map.kept_scans.clear();
  const PieceSearchResult found = FindPiece(map, {0}, {1}, {}, {});
  EXPECT_FALSE(found.placement);
  EXPECT_FALSE(found.reason.empty());
}

}  // namespace
}  // namespace masked_mapper
