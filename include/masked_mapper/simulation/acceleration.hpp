// SPDX-License-Identifier: BSD-3-Clause
// An accelerometer on a robot: gravity, the elevator's two pulses, driving, vibration. On stairs
// the robot is pitched, and gravity with it.
#pragma once

#include <Eigen/Core>
#include <cstdint>

#include "masked_mapper/simulation/random_generator.hpp"
#include "masked_mapper/simulation/robot_drive.hpp"

namespace masked_mapper {

struct AccelerationOptions {
  double rate = 0.0;  ///< Hz; 0: no accelerometer
};

struct AccelerationNoise {
  double sigma = 0.03;      ///< m/s^2, at rest
  double vibration = 0.25;  ///< m/s^2 more per m/s of driving
  double bias = 0.04;       ///< m/s^2, deviation of each axis' constant error

  static AccelerationNoise None();
};

class AccelerationSimulation {
 public:
  AccelerationSimulation(const AccelerationNoise& noise, std::uint64_t seed);

  /// m/s^2 in the robot frame, gravity included.
  Eigen::Vector3d Measure(const RobotState& state);

 private:
  AccelerationNoise noise_;
  RandomGenerator random_;
  Eigen::Vector3d bias_ = Eigen::Vector3d::Zero();
};

}  // namespace masked_mapper
