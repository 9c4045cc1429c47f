// SPDX-License-Identifier: BSD-3-Clause
// The walls of a floor as points in space.
#pragma once

#include <pcl/point_cloud.h>
#include <pcl/point_types.h>

#include <cstdint>

#include "masked_mapper/rendering/occupancy_grid.hpp"

namespace masked_mapper {

/// One point per occupied cell, in the order of cells, in world: x and y where the cell's hits lie
/// on average, z the elevation of the floor, m. Each carries `label`.
pcl::PointCloud<pcl::PointXYZL> WallCloud(const OccupancyGrid& grid, double elevation,
                                          std::uint32_t label);

}  // namespace masked_mapper
