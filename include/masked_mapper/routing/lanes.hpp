// SPDX-License-Identifier: BSD-3-Clause
// A sparse graph of ways for fleet managers and route servers: along what was driven, straight
// where nothing stands in between, with the stops of elevators and stairs and all named places.
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "masked_mapper/map/building_map.hpp"
#include "masked_mapper/rendering/occupancy_grid.hpp"
#include "masked_mapper/routing/crossings.hpp"

namespace masked_mapper {

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
