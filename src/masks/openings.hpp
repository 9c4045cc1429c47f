// SPDX-License-Identifier: BSD-3-Clause
// Openings in a scan: the directions that the robot could go (Section III-D, 4a-c).
//
// How scans that are not a full circle of hits are treated (the paper leaves it open; ours):
//   no return      is beyond `min_range_m`, whatever the reach of the scanner: it lengthens a run,
//   but
//                  it is no scan point, so an end-point is never refined to it;
//   invalid beam   is not there: a run goes on across it when the gap is at most `max_gap_deg`;
//   below 360 deg  a run ends where the view ends;
//   360 deg        a run goes on across the seam; when every beam is beyond `min_range_m` there is
//   no
//                  place to go through, thus no opening.
#pragma once

#include <Eigen/Core>
#include <vector>

#include "masked_mapper/masks/mask_options.hpp"
#include "masked_mapper/sensor/laser_scan.hpp"

namespace masked_mapper {

/// The narrowest place on the way into a run of far ranges.
struct Opening {
  Eigen::Vector2d right_in_robot =
      Eigen::Vector2d::Zero();  ///< m, clockwise end as seen from the laser
  Eigen::Vector2d left_in_robot = Eigen::Vector2d::Zero();  ///< m, counter-clockwise end
  double direction =
      0.0;             ///< rad in the robot frame, half-way between the ends as seen from the laser
  double width = 0.0;  ///< m
  double angle = 0.0;  ///< rad, between the two ends as seen from the laser
};

/// Openings counter-clockwise by the first beam of their runs.
std::vector<Opening> FindOpenings(const LaserScan& scan, const OpeningOptions& options);

}  // namespace masked_mapper
