// SPDX-License-Identifier: BSD-3-Clause
// What a grid shows of an elevator's cab.
#pragma once

#include <Eigen/Core>
#include <string>

#include "masked_mapper/rendering/occupancy_grid.hpp"
#include "masked_mapper/routing/lanes.hpp"

namespace masked_mapper {

/// In the frame of the cab, x is to the right of who looks out of the door, y out of it.
struct LiftCab {
  Pose2 T_world_cab;     ///< centre
  double width_m = 2.0;  ///< along x
  double depth_m = 2.0;  ///< along y
  double door_width_m = 1.0;
};

/// Of a cab that stands square to the axes of `grid`, from where the robot stood in it and came
/// out. What the grid does not show is taken to be as usual.
LiftCab CabAround(const Stop& stop, const OccupancyGrid& grid);

}  // namespace masked_mapper
