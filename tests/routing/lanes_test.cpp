// SPDX-License-Identifier: BSD-3-Clause
#include "masked_mapper/routing/lanes.hpp"

#include <gtest/gtest.h>

#include <set>

#include "routing/free_space.hpp"
#include "routing/two_floors.hpp"

namespace masked_mapper {
namespace {

/// Vertices that lanes lead to from one, itself included.
std::set<std::size_t> Reached(const LaneGraph& graph, std::size_t from) {
  std::set<std::size_t> reached = {from};
  for (bool grows = true; grows;) {
    grows = false;
    for (const Lane& lane : graph.lanes) {
      if (reached.count(lane.from) != reached.count(lane.to)) {
        reached.insert(lane.from);
        reached.insert(lane.to);
        grows = true;
      }
    }
  }
  return reached;
}

TEST(Lanes, FollowWhatWasDrivenToStopsAndPlaces) {
  BuildingMap map = TwoFloors();
  map.places.push_back({"corner", 0, {0.55, 0.55}});  // beside what was driven
  const auto grids = GridsOfTwoFloors();
  const ClearanceOptions clearance{0.2, 0.2};
  const LaneGraph graph = LanesOf(map, grids, clearance);
  ASSERT_EQ(graph.crossings.size(), 1U);
  std::size_t corner = graph.vertices.size();
  std::vector<std::size_t> stops;
  for (std::size_t i = 0; i < graph.vertices.size(); ++i) {
    if (graph.vertices[i].name == "corner") corner = i;
    if (graph.vertices[i].crossing) stops.push_back(i);
  }
  ASSERT_LT(corner, graph.vertices.size());
  ASSERT_EQ(stops.size(), 2U);
  EXPECT_EQ(graph.vertices[stops[0]].floor, 0);
  EXPECT_TRUE(Reached(graph, corner).count(stops[0]));
  EXPECT_GT(Reached(graph, stops[1]).size(), 1U);
  for (const Lane& lane : graph.lanes) {
    const LaneVertex& from = graph.vertices[lane.from];
    const LaneVertex& to = graph.vertices[lane.to];
    ASSERT_EQ(from.floor, to.floor);
    const FreeSpace space =
        FreeSpaceOf(map, grids[static_cast<std::size_t>(from.floor)], from.floor, clearance);
    EXPECT_TRUE(space.Sees(space.CellAt(from.at_in_world), space.CellAt(to.at_in_world)));
  }
  EXPECT_LT(graph.vertices.size(), 14U);
}

TEST(Lanes, ACorridorDrivenUpAndDownIsOneLane) {
  BuildingMap map;
  map.graph.AddFloor({"0", 0.0, 0.1, true, false});
  map.graph.AddNode({});
  map.drives.push_back({});
  for (int i = 0; i <= 100; ++i) Drive(map, 0, 1.0 + 0.1 * i, 1.0);
  for (int i = 100; i >= 0; --i) Drive(map, 0, 1.0 + 0.1 * i, 1.3);
  const OccupancyGrid grid = DrawnGrid(std::vector<std::string>(24, std::string(130, '.')));
  const LaneGraph graph = LanesOf(map, {grid}, {0.2, 0.2});
  EXPECT_LE(graph.lanes.size(), 3U);
  EXPECT_GE(graph.lanes.size(), 1U);
}

TEST(Lanes, WithoutADriveThereAreNone) {
  EXPECT_TRUE(LanesOf(BuildingMap{}, {}, {}).vertices.empty());
  BuildingMap map = TwoFloors();
  map.places.push_back({"island", 2, {0.0, 0.0}});
  const LaneGraph graph = LanesOf(map, GridsOfTwoFloors(), {});
  EXPECT_EQ(graph.vertices.back().name, "island");
}

}  // namespace
}  // namespace masked_mapper
