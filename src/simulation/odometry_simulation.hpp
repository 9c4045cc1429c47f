// SPDX-License-Identifier: BSD-3-Clause
// What wheels and a gyro make of the robot's motion.
#pragma once

#include <cstdint>

#include "masked_mapper/geometry/pose2.hpp"
#include "masked_mapper/simulation/simulation.hpp"
#include "random_generator.hpp"

namespace masked_mapper {

class OdometrySimulation {
 public:
  OdometrySimulation(const OdometryNoise& noise, std::uint64_t seed);

  /// The odometry after the robot moved by T_before_now in `seconds`; starts at the origin.
  Pose2 Advance(const Pose2& T_before_now, double seconds);
  const Pose2& T_odom_robot() const { return T_odom_robot_; }

 private:
  OdometryNoise noise_;
  RandomGenerator random_;
  double scale_ = 1.0;
  double bias_ = 0.0;    ///< rad/s
  double wander_ = 0.0;  ///< rad/s
  Pose2 T_odom_robot_;
};

}  // namespace masked_mapper
