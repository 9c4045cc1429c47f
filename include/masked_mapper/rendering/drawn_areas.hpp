// SPDX-License-Identifier: BSD-3-Clause
// What people know better than the scans, drawn into a grid. Corners in world, metres.
#pragma once

#include <Eigen/Core>
#include <vector>

#include "masked_mapper/rendering/occupancy_grid.hpp"

namespace masked_mapper {

/// Walls inside become free, and their wall points go.
void EraseWalls(const std::vector<Eigen::Vector2d>& corners, OccupancyGrid& grid);

/// What was free inside becomes unknown; walls stay, since a robot may localise by them.
void ForgetFree(const std::vector<Eigen::Vector2d>& corners, OccupancyGrid& grid);

}  // namespace masked_mapper
