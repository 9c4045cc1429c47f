// SPDX-License-Identifier: BSD-3-Clause
// Two floors, each a room of 4 x 2 m with a wall between its halves that leaves a gap at the top,
// tied by a cab at the right, and a third floor that nobody was driven to.
#pragma once

#include "masked_mapper/map/building_map.hpp"
#include "masked_mapper/rendering/occupancy_grid.hpp"
#include "routing/drawn_grid.hpp"

namespace masked_mapper {

inline void Drive(BuildingMap& map, FloorId floor, double x, double y, bool in_transit = false) {
  TrajectoryPose pose;
  pose.stamp = pose.log_stamp = static_cast<double>(map.trajectory.size());
  pose.floor = floor;
  pose.in_transit = in_transit;
  pose.T_odom_robot = pose.T_world_robot = {x, y, 0.0};
  map.trajectory.push_back(pose);
}

inline BuildingMap TwoFloors() {
  BuildingMap map;
  map.graph.AddFloor({"0", 0.0, 0.1, true, false});
  map.graph.AddFloor({"-1", -3.0, 0.1, true, false});
  map.graph.AddFloor({"roof", 9.0, 0.1, true, true});
  map.graph.AddNode({});
  map.drives.push_back({});
  Drive(map, 0, 0.55, 1.65);
  Drive(map, 0, 3.55, 1.65);
  Drive(map, 0, 3.55, 0.55);
  Drive(map, 0, 3.55, 0.55, true);
  Drive(map, -1 + 1, 3.65, 0.55, true);
  Drive(map, 1, 3.65, 0.55);
  Drive(map, 1, 3.55, 1.65);
  Drive(map, 1, 0.55, 1.65);
  return map;
}

inline std::vector<OccupancyGrid> GridsOfTwoFloors() {
  std::vector<std::string> lines(22, "#" + std::string(40, '.') + "#");
  lines.front() = lines.back() = std::string(42, '#');
  for (std::size_t row = 8; row < 21; ++row) lines[row][20] = '#';
  return {DrawnGrid(lines), DrawnGrid(lines), OccupancyGrid{}};
}

}  // namespace masked_mapper
