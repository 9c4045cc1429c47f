// SPDX-License-Identifier: BSD-3-Clause
// Which way the surfaces face that a scan sees.
#pragma once

#include <Eigen/Core>
#include <vector>

#include "masked_mapper/sensor/laser_scan.hpp"

namespace masked_mapper {

/// Of each point, in the robot frame: across the line through its neighbours in beam order, towards
/// the robot. A point on its own faces the robot.
std::vector<Eigen::Vector2f> NormalsOf(const ScanPoints& points);

/// Between the directions in which most surfaces of a building face (four, square to each other),
/// so that none of them falls on the border of front and back. `theta` turns the robot into the
/// map.
double FrontOf(const std::vector<Eigen::Vector2f>& normals_in_robot, double theta);

}  // namespace masked_mapper
