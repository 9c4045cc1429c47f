// SPDX-License-Identifier: BSD-3-Clause
// A transform with its covariance, composed as in Section III-C, Eq. 3-6. The covariance is that of
// the parameters (x, y, theta) of T_a_b, so its translation part is expressed in frame a.
#pragma once

#include <Eigen/Core>
#include <cmath>

#include "masked_mapper/geometry/pose2.hpp"

namespace masked_mapper {

struct UncertainPose2 {
  Pose2 mean;
  Eigen::Matrix3d covariance = Eigen::Matrix3d::Zero();  ///< of (x, y, theta); m^2, m rad, rad^2
};

/// d(T_a_b * T_b_c) / d(T_a_b): J1 of Eq. 5.
Eigen::Matrix3d ComposeJacobianLeft(const Pose2& T_a_b, const Pose2& T_b_c);

/// d(T_a_b * T_b_c) / d(T_b_c): J2 of Eq. 6.
Eigen::Matrix3d ComposeJacobianRight(const Pose2& T_a_b, const Pose2& T_b_c);

/// T_a_c with Sigma_ac = J1 Sigma_ab J1^T + J2 Sigma_bc J2^T; the two are taken as independent.
UncertainPose2 operator*(const UncertainPose2& T_a_b, const UncertainPose2& T_b_c);

/// T_b_a of T_a_b, covariance to first order.
UncertainPose2 Inverse(const UncertainPose2& T_a_b);

/// Whether the matrix can be a covariance of (x, y, theta): finite, symmetric and without a
/// negative eigenvalue, but for rounding, and with no variance above 1e12. To be asked of what
/// comes from a file or a hand.
bool IsCovariance(const Eigen::Matrix3d& matrix);

/// sqrt(z^T (Sigma + range_m^2 I)^-1 z), Eq. 7: how far two nodes may be apart and still see the
/// same place. `displacement` and `covariance` are in one frame; metres. `range_m` is R of the
/// paper. A covariance that is not positive semi-definite is the caller's bug.
double MahalanobisDistance(const Eigen::Vector2d& displacement, const Eigen::Matrix2d& covariance,
                           double range_m);

/// Distance of a loop's total transform from the identity under its own covariance (Section III-E).
/// Infinite when the covariance is singular and the transform is not the identity.
double MahalanobisFromIdentity(const UncertainPose2& loop);

/// The trace of a composed covariance (Eq. 2 of Eq. 5-6) in closed form. A search over covariances
/// asks for it at every edge that it looks at, and composes only along those that it takes.
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
