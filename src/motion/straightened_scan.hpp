// SPDX-License-Identifier: BSD-3-Clause
// A sweep takes a while, and a robot that moves meanwhile bends it: beams as they would have been,
// had all been measured at the stamp.
#pragma once

#include <functional>

#include "masked_mapper/sensor/laser_scan.hpp"

namespace masked_mapper {

/// Pose of the robot some seconds after the stamp of a scan, in its own frame at the stamp.
using MotionInSweep = std::function<Pose2(double)>;

/// The motion of a robot that goes on as it went over `T_begin_end` in `seconds`.
MotionInSweep SteadyMotion(const Pose2& T_begin_end, double seconds);

/// The same directions, seen from where the laser was at the stamp. What no beam met is invalid
/// there, and a direction that two beams met has the nearer of them. `beam_time` is 0 afterwards; a
/// scan where it already was is given back as it is.
LaserScan Straightened(LaserScan scan, const MotionInSweep& T_stamp_then);

}  // namespace masked_mapper
