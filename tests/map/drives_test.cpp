// SPDX-License-Identifier: BSD-3-Clause
#include "masked_mapper/map/drives.hpp"

#include <gtest/gtest.h>

namespace masked_mapper {
namespace {

/// Three drives of two nodes and three scans each.
BuildingMap ThreeDrives() {
  BuildingMap map;
  map.graph.AddFloor({"0"});
  map.graph.AddFloor({"up"});
  for (int drive = 0; drive < 3; ++drive) {
    map.drives.emplace_back();
    map.drives.back().log = "log " + std::to_string(drive);
    map.drives.back().first_pose = map.trajectory.size();
    map.drives.back().first_node = static_cast<NodeId>(map.graph.nodes().size());
    for (int i = 0; i < 2; ++i) map.graph.AddNode({});
    map.graph.AddEdge({2 * drive, 2 * drive + 1, {}, EdgeKind::kOdometry});
    map.trajectory.resize(map.trajectory.size() + 3);
  }
  return map;
}

TEST(Drives, NodesAndPosesBelongToOne) {
  const BuildingMap map = ThreeDrives();
  EXPECT_EQ(DriveOfNode(map, 0), 0U);
  EXPECT_EQ(DriveOfNode(map, 1), 0U);
  EXPECT_EQ(DriveOfNode(map, 2), 1U);
  EXPECT_EQ(DriveOfNode(map, 5), 2U);
  EXPECT_EQ(DriveOfPose(map, 2), 0U);
  EXPECT_EQ(DriveOfPose(map, 8), 2U);
  EXPECT_EQ(NodesOfDrive(map, 1).begin, 2U);
  EXPECT_EQ(NodesOfDrive(map, 2).end, 6U);
  EXPECT_EQ(PosesOfDrive(map, 1).begin, 3U);
  EXPECT_EQ(PosesOfDrive(map, 1).end, 6U);
}

TEST(Drives, AMapMadeByHandIsOneDrive) {
  BuildingMap map = ThreeDrives();
  map.drives.clear();
  EXPECT_EQ(DriveOfNode(map, 5), 0U);
  EXPECT_EQ(NodesOfDrive(map, 0).end, 6U);
  EXPECT_EQ(PosesOfDrive(map, 0).end, 9U);
  EXPECT_EQ(PiecesOfDrives(map), std::vector<std::size_t>{0});
  EXPECT_TRUE(FactsOfDrives(map).empty());
}

TEST(Drives, ClosuresMakePieces) {
  BuildingMap map = ThreeDrives();
  EXPECT_EQ(PiecesOfDrives(map), (std::vector<std::size_t>{0, 1, 2}));
  map.graph.AddEdge({4, 2, {}, EdgeKind::kClosure});
  EXPECT_EQ(PiecesOfDrives(map), (std::vector<std::size_t>{0, 1, 1}));
  const std::vector<DriveFacts> facts = FactsOfDrives(map);
  EXPECT_TRUE(facts[0].joined);
  EXPECT_FALSE(facts[2].joined);
  EXPECT_EQ(facts[2].piece, 1U);
  EXPECT_EQ(facts[2].closures_to_others, 1U);
  EXPECT_EQ(facts[0].closures_to_others, 0U);
  EXPECT_EQ(facts[2].scans, 3U);
  EXPECT_EQ(facts[2].nodes, 2U);
  EXPECT_EQ(facts[2].floors, std::vector<std::string>{"0"});
  map.graph.AddEdge({5, 1, {}, EdgeKind::kClosure});
  EXPECT_EQ(PiecesOfDrives(map), (std::vector<std::size_t>{0, 0, 0}));
}

}  // namespace
}  // namespace masked_mapper
