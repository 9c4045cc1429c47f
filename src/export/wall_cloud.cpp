// SPDX-License-Identifier: BSD-3-Clause
#include "wall_cloud.hpp"

namespace masked_mapper {

pcl::PointCloud<pcl::PointXYZL> WallCloud(const OccupancyGrid& grid, double elevation,
                                          std::uint32_t label) {
  pcl::PointCloud<pcl::PointXYZL> cloud;
  cloud.reserve(grid.walls.size());
  for (const WallPoint& wall : grid.walls) {
    cloud.push_back({wall.x, wall.y, static_cast<float>(elevation), label});
  }
  return cloud;
}

}  // namespace masked_mapper
