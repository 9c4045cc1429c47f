// SPDX-License-Identifier: BSD-3-Clause
// The points of a scan with the way in which the surface faces at each: made once of a scan, which
// may then be held against local maps and added to them any number of times.
#pragma once

#include <cstddef>
#include <vector>

#include "masked_mapper/sensor/laser_scan.hpp"

namespace masked_mapper {

/// All in the robot's frame, m, in the order of the beams.
struct FacedPoints {
  FacedPoints() = default;
  /// A surface is the line through the neighbours of a point, and faces the robot: beams on another
  /// surface are none. Where there are none the point faces the robot. Not `explicit`, since points
  /// are all that it takes.
  FacedPoints(const ScanPoints& points_in_robot);  // NOLINT(google-explicit-constructor)

  std::size_t size() const { return x.size(); }
  bool empty() const { return x.empty(); }

  std::vector<float> x, y;
  std::vector<float> normal_x, normal_y;  ///< of any length
};

/// The heading, rad, midway between those in which most of the surfaces face, as in a building of
/// right angles.
double FrontOf(const FacedPoints& points, double theta);

}  // namespace masked_mapper
