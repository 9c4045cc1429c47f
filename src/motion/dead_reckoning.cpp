// SPDX-License-Identifier: BSD-3-Clause
#include "dead_reckoning.hpp"

#include <algorithm>
#include <cmath>

namespace masked_mapper {

UncertainPose2 OdometryStep(const OdometryReading& from, const OdometryReading& to,
                            const DeadReckoningOptions& options) {
  UncertainPose2 T_from_to;
  // Wheels at rest: nothing slips, and a gyro is held by standing still. Asked of the readings
  // themselves, since far from the origin rounding alone makes a step of equal poses.
  if (from.T_odom_robot.AsVector() == to.T_odom_robot.AsVector()) return T_from_to;
  T_from_to.mean = Between(from.T_odom_robot, to.T_odom_robot);
  const double travelled = std::hypot(T_from_to.mean.x, T_from_to.mean.y);
  const double turned = std::abs(T_from_to.mean.theta);
  const double elapsed = std::max(0.0, to.stamp - from.stamp);
  const auto square = [](double sigma) { return sigma * sigma; };
  const double position = square(options.sigma_position_per_sqrt_m) * travelled +
                          square(options.sigma_position_per_step);
  const double heading = square(DegToRad(options.sigma_heading_deg_per_sqrt_m)) * travelled +
                         square(DegToRad(options.sigma_heading_deg_per_sqrt_rad)) * turned +
                         square(DegToRad(options.sigma_heading_deg_per_sqrt_s)) * elapsed;
  T_from_to.covariance.diagonal() << position, position, heading;
  return T_from_to;
}

void DeadReckoning::Observe(const OdometryReading& reading) {
  if (last_) {
    const UncertainPose2 step = OdometryStep(*last_, reading, options_);
    T_odom_robot_ = T_odom_robot_ * step.mean;
    T_node_robot_ = T_node_robot_ * step;
  }
  last_ = reading;
}

void DeadReckoning::StartNode() { T_node_robot_ = UncertainPose2{}; }

}  // namespace masked_mapper
