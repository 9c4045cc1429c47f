// SPDX-License-Identifier: BSD-3-Clause
// The isovist: the scan as the polygon of the space that it sees (Section III-D, 3).
//
// How scans that are not a full circle of hits are treated (the paper leaves it open; ours):
//   no return      the beam sees free space as far as the scanner reaches, but at most
//   `max_range_m`;
//                  hits beyond that end there too: a few beams down a long hall or through a window
//                  would rule all moments otherwise;
//   invalid beam   is not there: the polygon goes straight from its neighbour to its neighbour;
//   below 360 deg  the polygon closes at the laser, which becomes a corner;
//   360 deg        the last beam is joined to the first.
#pragma once

#include <Eigen/Core>
#include <vector>

#include "masked_mapper/masks/mask_options.hpp"
#include "masked_mapper/sensor/laser_scan.hpp"

namespace masked_mapper {

/// Corners in the robot frame, in beam order. Empty when not one beam is valid.
std::vector<Eigen::Vector2d> Isovist(const LaserScan& scan, const IsovistOptions& options);

}  // namespace masked_mapper
