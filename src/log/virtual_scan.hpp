// SPDX-License-Identifier: BSD-3-Clause
// What a 2D scanner in the place of a 3D lidar should have seen. One principle: a wall is what
// stands upright over a band of heights and stops what flies at it. In each direction that is the
// nearest distance at which returns lie over one another and by which hardly a ray passes inside
// the band: rays pass below a table's top and above it, they pass below a lintel, and a floor,
// level or not, is nowhere upright.
#pragma once

#include <optional>

#include "ground.hpp"
#include "masked_mapper/sensor/laser_scan.hpp"
#include "masked_mapper/sensor/lidar_cloud.hpp"

namespace masked_mapper {

/// Heights above the floor, m.
struct WallBand {
  double low_m = 0.0;
  double high_m = 0.0;
};

/// Where walls are walls: above what lies about, below lintels and the ceiling, and about the
/// lidar. `lidar_height_m` is above the floor. What is given (> 0) stays.
WallBand BandBetween(const Ground& ground, double lidar_height_m, const WallBand& given);

/// Points are levelled, z above the floor (Ground::T_level_robot). The scan's laser stands where
/// the lidar does and looks ahead; directions without a wall are invalid, since a cloud does not
/// tell a ray that met nothing from one that was never sent. Stamps and odometry are left to the
/// caller.
LaserScan CutToScan(const CloudPoints& points_in_level, const Eigen::Vector3d& lidar_in_level,
                    const WallBand& band, float max_range);

}  // namespace masked_mapper
