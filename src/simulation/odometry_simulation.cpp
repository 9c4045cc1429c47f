// SPDX-License-Identifier: BSD-3-Clause
#include "odometry_simulation.hpp"

#include <cmath>

namespace masked_mapper {

OdometryNoise OdometryNoise::None() {
  OdometryNoise noise;
  noise.scale_error = noise.distance_sigma = 0.0;
  noise.slip_forward = noise.slip_sideways = noise.turn_sigma_deg = 0.0;
  noise.gyro_bias_deg_s = noise.gyro_wander_deg_s = 0.0;
  return noise;
}

OdometrySimulation::OdometrySimulation(const OdometryNoise& noise, std::uint64_t seed)
    : noise_(noise), random_(seed, "odometry") {
  scale_ = 1.0 + (random_.Chance(0.5) ? 1.0 : -1.0) * noise.scale_error;
  bias_ = (random_.Chance(0.5) ? 1.0 : -1.0) * DegToRad(noise.gyro_bias_deg_s);
  wander_ = DegToRad(noise.gyro_wander_deg_s) * random_.Normal();
}

Pose2 OdometrySimulation::Advance(const Pose2& T_before_now, double seconds) {
  const double distance = std::hypot(T_before_now.x, T_before_now.y);
  const double turn = std::abs(T_before_now.theta);
  const double driving = distance > 0.0 ? 1.0 : 0.0;
  Pose2 T_measured = T_before_now;
  const double forward =
      scale_ +
      (distance > 0.0 ? noise_.distance_sigma * random_.Normal() / std::sqrt(distance) : 0.0);
  T_measured.x = T_before_now.x * forward -
                 driving * noise_.slip_forward * turn * (T_before_now.x < 0.0 ? -1.0 : 1.0);
  T_measured.y = T_before_now.y * forward - driving * noise_.slip_sideways * T_before_now.theta;
  // A first-order process: after each step the deviation is what it was.
  const double keep =
      noise_.gyro_wander_seconds > 0.0 ? 1.0 / (1.0 + seconds / noise_.gyro_wander_seconds) : 0.0;
  wander_ = keep * wander_ +
            std::sqrt(1.0 - keep * keep) * DegToRad(noise_.gyro_wander_deg_s) * random_.Normal();
  T_measured.theta += (bias_ + wander_) * seconds +
                      DegToRad(noise_.turn_sigma_deg) * std::sqrt(turn) * random_.Normal();
  T_odom_robot_ = T_odom_robot_ * T_measured;
  return T_odom_robot_;
}

}  // namespace masked_mapper
