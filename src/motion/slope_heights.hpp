// SPDX-License-Identifier: BSD-3-Clause
// Heights of a robot that drives on stairs and ramps: its pitch, as gravity shows it, times the way
// that its wheels go. A cab, in which they rest, does not show.
#pragma once

#include <Eigen/Core>
#include <vector>

#include "pressure_heights.hpp"
#include "wheel_track.hpp"

namespace masked_mapper {

/// A spell's mean acceleration.
struct TiltSample {
  double stamp = 0.0;                                               ///< s
  Eigen::Vector3d acceleration_in_robot = Eigen::Vector3d::Zero();  ///< m/s^2, gravity included
};

/// `up_in_robot`: unit, as gravity tells it over the drive; the robot's x axis is where it drives.
/// Empty without wheels.
PressureHeights SlopeHeights(const std::vector<TiltSample>& samples,
                             const Eigen::Vector3d& up_in_robot, const WheelTrack& track);

}  // namespace masked_mapper
