// SPDX-License-Identifier: BSD-3-Clause
// An accelerometer on a robot: gravity, the elevator's two pulses, driving, vibration. On stairs
// the robot is pitched, and gravity with it.
#pragma once

#include <Eigen/Core>
#include <cstdint>

#include "masked_mapper/simulation/simulation.hpp"
#include "random_generator.hpp"
#include "robot_drive.hpp"

namespace masked_mapper {

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
