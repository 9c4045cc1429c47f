// SPDX-License-Identifier: BSD-3-Clause
// Whatever a robot's log can tell at one stamp. Readers hand these out one at a time, in order.
#pragma once

#include <Eigen/Core>
#include <string>
#include <variant>

#include "masked_mapper/geometry/pose2.hpp"
#include "masked_mapper/sensor/laser_scan.hpp"

namespace masked_mapper {

struct OdometryReading {
  double stamp = 0.0;  ///< s
  Pose2 T_odom_robot;  ///< where the wheels say the robot is, in a frame that drifts
};

struct PressureReading {
  double stamp = 0.0;        ///< s
  double pressure_pa = 0.0;  ///< Pa
};

struct AccelerationReading {
  double stamp = 0.0;                                               ///< s
  Eigen::Vector3d acceleration_in_robot = Eigen::Vector3d::Zero();  ///< m/s^2, gravity included
};

/// From here on the robot is on this floor; `-` means in transit between floors.
struct FloorLabel {
  double stamp = 0.0;  ///< s
  std::string label;
};

using Observation =
    std::variant<OdometryReading, LaserScan, PressureReading, AccelerationReading, FloorLabel>;

inline double Stamp(const Observation& observation) {
  return std::visit([](const auto& reading) { return reading.stamp; }, observation);
}

struct TimeSpan {
  double start = 0.0;  ///< s; minus infinity: from before the log
  double end = 0.0;    ///< s; plus infinity: past the end of the log

  double Duration() const { return end - start; }
  bool Contains(double stamp) const { return start <= stamp && stamp <= end; }
};

}  // namespace masked_mapper
