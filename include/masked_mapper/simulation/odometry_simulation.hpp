// SPDX-License-Identifier: BSD-3-Clause
// What wheels and a gyro make of the robot's motion.
#pragma once

#include <cstdint>

#include "masked_mapper/geometry/pose2.hpp"
#include "masked_mapper/simulation/random_generator.hpp"

namespace masked_mapper {

struct OdometryNoise {
  double scale_error = 0.02;            ///< of the distance; its sign is drawn
  double distance_sigma = 0.01;         ///< m per square root of a metre
  double slip_forward = 0.03;           ///< m lost per radian turned while driving
  double slip_sideways = 0.02;          ///< m drifted outwards per radian turned while driving
  double turn_sigma_deg = 0.3;          ///< deg per square root of a radian turned
  double gyro_bias_deg_s = 0.003;       ///< deg/s, constant; its sign is drawn
  double gyro_wander_deg_s = 0.0008;    ///< deg/s, deviation of the part that wanders
  double gyro_wander_seconds = 1800.0;  ///< over which it forgets

  static OdometryNoise None();
};

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
