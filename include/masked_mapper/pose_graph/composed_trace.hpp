// SPDX-License-Identifier: BSD-3-Clause
// The trace of a composed covariance (Eq. 2 of Eq. 5-6) in closed form. A search over covariances
// asks for it at every edge that it looks at, and composes only along those that it takes.
#pragma once

#include <Eigen/Core>
#include <cmath>

#include "masked_mapper/geometry/uncertain_pose2.hpp"

namespace masked_mapper {

class ComposedTrace {
 public:
  explicit ComposedTrace(const UncertainPose2& T_a_b)
      : trace_(T_a_b.covariance.trace()),
        x_theta_(T_a_b.covariance(0, 2)),
        y_theta_(T_a_b.covariance(1, 2)),
        theta_theta_(T_a_b.covariance(2, 2)),
        cos_(std::cos(T_a_b.mean.theta)),
        sin_(std::sin(T_a_b.mean.theta)) {}

  /// Trace of the covariance of T_a_b * T_b_c.
  double With(const UncertainPose2& T_b_c) const {
    return After(T_b_c.mean.x, T_b_c.mean.y, T_b_c.covariance.trace());
  }

  /// Trace of the covariance of T_a_b * Inverse(T_c_b).
  double WithInverse(const UncertainPose2& T_c_b) const {
    const Pose2 T_b_c = Inverse(T_c_b.mean);
    const Eigen::Matrix3d& covariance = T_c_b.covariance;
    // Seen from the other end, the translation turns about its length for every radian.
    const double lever_x = -T_c_b.mean.y;
    const double lever_y = T_c_b.mean.x;
    const double trace = covariance.trace() +
                         (lever_x * lever_x + lever_y * lever_y) * covariance(2, 2) -
                         2.0 * (lever_x * covariance(0, 2) + lever_y * covariance(1, 2));
    return After(T_b_c.x, T_b_c.y, trace);
  }

 private:
  // J2 of Eq. 6 is a rotation and keeps the trace of the step; J1 of Eq. 5 adds to that of T_a_b
  // what its heading does over the length of the step.
  double After(double x, double y, double step_trace) const {
    const double lever_x = -sin_ * x - cos_ * y;
    const double lever_y = cos_ * x - sin_ * y;
    return trace_ + step_trace + (lever_x * lever_x + lever_y * lever_y) * theta_theta_ +
           2.0 * (lever_x * x_theta_ + lever_y * y_theta_);
  }

  double trace_;
  double x_theta_;
  double y_theta_;
  double theta_theta_;
  double cos_;
  double sin_;
};

}  // namespace masked_mapper
