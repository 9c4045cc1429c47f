// SPDX-License-Identifier: BSD-3-Clause
// The shortest way through a finished map, floors included: straight where the grids leave room
// for the robot, from floor to floor by the elevators and stairs that were driven.
#pragma once

#include <Eigen/Core>
#include <optional>
#include <string>
#include <vector>

#include "masked_mapper/map/building_map.hpp"
#include "masked_mapper/rendering/occupancy_grid.hpp"
#include "masked_mapper/routing/lanes.hpp"

namespace masked_mapper {

struct Place {
  FloorId floor = 0;
  Eigen::Vector2d at_in_world = Eigen::Vector2d::Zero();
};

/// `floor,x,y` (label, metres in world), `t=STAMP` (s, of the map's trajectory: where the robot was
/// then, within half a second), or the name of a place. Throws InputError, one line.
Place PlaceOf(const std::string& text, const BuildingMap& map);

struct RouteOptions {
  ClearanceOptions clearance;
  double ride_cost_m = 20.0;  ///< metres of way that one ride of an elevator is worth avoiding
  bool use_stairs = true;
};

/// Of a floor; its ends included.
struct RouteLeg {
  FloorId floor = 0;
  double length_m = 0.0;
  std::vector<Eigen::Vector2d> points_in_world;
};

struct RouteTransit {
  CrossingKind kind = CrossingKind::kElevator;
  FloorId from = 0;
  FloorId to = 0;
  double length_m = 0.0;  ///< along stairs; none in a cab
};

struct Route {
  bool is_found = false;
  double length_m = 0.0;               ///< in the plane: legs and stairs
  double cost_m = 0.0;                 ///< with rides
  std::vector<RouteLeg> legs;          ///< one on each floor, in order; at least one when found
  std::vector<RouteTransit> transits;  ///< between a leg and the next
  /// Where the centre of a robot that touches the place asked for ends up, when it cannot stand
  /// there itself; no further off than its radius.
  Place from;
  Place to;
  std::string reason;            ///< why not, one line
  std::optional<Place> nearest;  ///< where one gets to from `from` that is nearest to `to`
};

/// `grids` by FloorId, with what was erased and kept out in them. No way is an answer.
Route FindRoute(const BuildingMap& map, const std::vector<OccupancyGrid>& grids, const Place& from,
                const Place& to, const RouteOptions& options);

}  // namespace masked_mapper
