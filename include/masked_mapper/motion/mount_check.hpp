// SPDX-License-Identifier: BSD-3-Clause
// Whether the scanner sits on the robot as the log says. Scans alone and wheels alone both tell how
// the robot moved, and each errs in its own way; but a mirrored scanner turns the other way in
// every turn, and one that looks elsewhere than it is said to moves askew on every straight.
#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

#include "masked_mapper/geometry/pose2.hpp"
#include "masked_mapper/motion/wheel_check.hpp"

namespace masked_mapper {

/// What is wrong with a mount; at most one of the three, in this order.
struct MountFault {
  bool upside_down = false;
  double yaw = 0.0;                                  ///< rad, truly minus as the log says
  Eigen::Vector2d offset = Eigen::Vector2d::Zero();  ///< m, the same, in the robot frame

  bool IsNone() const { return !upside_down && yaw == 0.0 && offset.isZero(); }
};

/// No fault when too little was seen to tell.
MountFault FindMountFault(const std::vector<StretchPair>& stretches);

/// One line that names the options to set; empty when nothing is wrong. `T_robot_laser` is as the
/// log has it.
std::string WarningOf(const MountFault& fault, const Pose2& T_robot_laser);

}  // namespace masked_mapper
