// SPDX-License-Identifier: BSD-3-Clause
#include "isovist.hpp"

#include <algorithm>
#include <cmath>

#include "masked_mapper/sensor/laser_scan.hpp"

namespace masked_mapper {

std::vector<Eigen::Vector2d> Isovist(const LaserScan& scan, const IsovistOptions& options) {
  std::vector<Eigen::Vector2d> corners;
  corners.reserve(scan.size() + 1);
  const Eigen::Vector2d laser_in_robot = scan.T_robot_laser.Translation();
  const double reach = std::min<double>(scan.max_range, options.max_range_m);
  auto direction = BeamSweep::InRobot(scan);
  for (const float range : scan.ranges) {
    if (!std::isnan(range)) {
      corners.emplace_back(laser_in_robot + std::min<double>(range, reach) * direction.Current());
    }
    direction.Advance();
  }
  if (!corners.empty() && !scan.IsFullCircle()) corners.push_back(laser_in_robot);
  return corners;
}

}  // namespace masked_mapper
