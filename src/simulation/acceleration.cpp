// SPDX-License-Identifier: BSD-3-Clause
#include "acceleration.hpp"

#include <algorithm>
#include <cmath>

namespace masked_mapper {

AccelerationNoise AccelerationNoise::None() {
  AccelerationNoise noise;
  noise.sigma = noise.vibration = noise.bias = 0.0;
  return noise;
}

AccelerationSimulation::AccelerationSimulation(const AccelerationNoise& noise, std::uint64_t seed)
    : noise_(noise), random_(seed, "acceleration") {
  for (int axis = 0; axis < 3; ++axis) bias_[axis] = noise.bias * random_.Normal();
}

Eigen::Vector3d AccelerationSimulation::Measure(const RobotState& state) {
  constexpr double kGravity = 9.80665;  // m/s^2
  // Wheels measure the way along the slope, so rise over way is the sine of the pitch.
  const double sine = std::clamp(state.slope, -0.95, 0.95);
  const double up = kGravity + state.vertical_acceleration;
  Eigen::Vector3d measured(state.speed_change + up * sine, state.speed * state.turn_rate,
                           up * std::sqrt(1.0 - sine * sine));
  measured += bias_;
  const double sigma = noise_.sigma + noise_.vibration * std::abs(state.speed);
  for (int axis = 0; axis < 3; ++axis) measured[axis] += sigma * random_.Normal();
  return measured;
}

}  // namespace masked_mapper
