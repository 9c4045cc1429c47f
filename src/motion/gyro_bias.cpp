// SPDX-License-Identifier: BSD-3-Clause
#include "gyro_bias.hpp"

#include <algorithm>
#include <cmath>

namespace masked_mapper {

void GyroBias::Observe(const OdometryReading& reading) {
  const std::optional<OdometryReading> before = last_;
  last_ = reading;
  if (!before) return;
  const double elapsed = reading.stamp - before->stamp;
  // A pause in the log is no rest.
  if (!(elapsed > 0.0 && elapsed < 5.0)) return;
  const Pose2 step = Between(before->T_odom_robot, reading.T_odom_robot);
  if (std::hypot(step.x, step.y) > options_.rest_m ||
      std::abs(step.theta) > DegToRad(options_.most_deg_per_s) * elapsed) {
    return;
  }
  seconds_ = std::min(seconds_ + elapsed, options_.remembered_seconds);
  const double share = elapsed / std::max(elapsed, seconds_ + options_.first_seconds);
  rate_ += share * (step.theta / elapsed - rate_);
}

}  // namespace masked_mapper
