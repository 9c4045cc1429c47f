// SPDX-License-Identifier: BSD-3-Clause
// What tells a cab from a nook: its door. A wall was seen where the robot then drove, or, from one
// place, a wall and later none.
#pragma once

#include <cstddef>
#include <deque>
#include <optional>

#include "floor_lidar.hpp"

namespace masked_mapper {

/// Beams on either side of the direction to a point in the laser frame: [first, end).
struct BeamSpan {
  std::size_t first = 0;
  std::size_t end = 0;
};
std::optional<BeamSpan> BeamsTowards(const LaserScan& scan, const Eigen::Vector2d& point_in_laser,
                                     double half_angle);

/// Whether the robot saw a wall where it then drove straight in.
bool CameThroughWall(const std::deque<PlacedScan>& way_in, const Eigen::Vector2d& cab_in_odom,
                     double door_distance_m);

/// Whether the robot saw a wall from the cab where it then drove straight out. Round a corner a
/// wall is no door.
bool LeftThroughWall(const std::deque<PlacedScan>& walls, const std::deque<PlacedScan>& way_out,
                     const Eigen::Vector2d& cab_in_odom, double door_distance_m);

/// Whether from one place the robot saw walls all round, and before or after that no wall over the
/// width of a door.
bool SawDoorMove(const std::deque<PlacedScan>& walls, const std::deque<PlacedScan>& way);

}  // namespace masked_mapper
