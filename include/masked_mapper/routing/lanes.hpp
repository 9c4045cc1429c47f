// SPDX-License-Identifier: BSD-3-Clause
// How a building hangs together for who goes about it: the elevators and stairs that were driven,
// and a sparse graph of ways for fleet managers and route servers: along what was driven, straight
// where nothing stands in between, with the stops of elevators and stairs and all named places.
#pragma once

#include <Eigen/Core>
#include <array>
#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "masked_mapper/map/building_map.hpp"
#include "masked_mapper/rendering/occupancy_grid.hpp"

namespace masked_mapper {

enum class CrossingKind { kElevator, kStairs };
constexpr std::array<const char*, 2> NamesOf(CrossingKind /*any*/) {
  return {"elevator", "stairs"};
}

/// Where the robot stood when it left a floor, or came to one: in the cab, or where stairs begin.
struct Stop {
  FloorId floor = 0;
  Pose2 T_world_robot;
  /// Where it had come from, or went then: on the floor, out of the door.
  Eigen::Vector2d outside_in_world = Eigen::Vector2d::Zero();
};

struct Crossing {
  CrossingKind kind = CrossingKind::kElevator;
  std::vector<Stop> stops;           ///< of different floors, in order of elevations; stairs: two
  std::vector<Eigen::Vector2d> way;  ///< of stairs: in world, from the first stop to the second
};

/// In order of first use. Rides whose cabs stood at one place of the plan, on whatever floors, are
/// rides of one cab, and any two of its floors are one ride apart.
std::vector<Crossing> CrossingsOf(const BuildingMap& map);

/// For whom there has to be room.
struct ClearanceOptions {
  double radius_m = 0.3;  ///< of the robot that is to go
  /// Of the robot that mapped. Where it drove, one no larger passes, whatever the grid says: what
  /// stood there at another time was a door or somebody.
  double driven_radius_m = 0.3;
};

struct LaneVertex {
  FloorId floor = 0;
  Eigen::Vector2d at_in_world = Eigen::Vector2d::Zero();
  std::string name;                     ///< of a place; else empty
  std::optional<std::size_t> crossing;  ///< it is a stop of: place in LaneGraph::crossings
};

/// Straight, both ways, on one floor.
struct Lane {
  std::size_t from = 0;  ///< place in LaneGraph::vertices
  std::size_t to = 0;
};

struct LaneGraph {
  std::vector<LaneVertex> vertices;  ///< floor by floor
  std::vector<Lane> lanes;
  std::vector<Crossing> crossings;
};

/// `grids` by FloorId. A place to which no way leads is a vertex without lanes.
LaneGraph LanesOf(const BuildingMap& map, const std::vector<OccupancyGrid>& grids,
                  const ClearanceOptions& clearance);

}  // namespace masked_mapper
