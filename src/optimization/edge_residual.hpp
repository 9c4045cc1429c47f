// SPDX-License-Identifier: BSD-3-Clause
// The whitened residual of one edge of a pose graph, with its analytic Jacobians.
//
//   e = (R_from^T (t_to - t_from) - t_measured, wrap(theta_to - theta_from - theta_measured)),
//   r = W e with W^T W = Sigma^-1,
//
// e is in frame `from`, as is the covariance Sigma of the measured T_from_to. The angle of a pose
// is a plain number: only differences enter, wrapped, so no manifold is needed.
#pragma once

#include <Eigen/Core>

#include "masked_mapper/geometry/uncertain_pose2.hpp"

namespace masked_mapper {

class EdgeResidual {
 public:
  /// A covariance that is not finite or has a negative eigenvalue is the caller's bug. One that is
  /// singular, or smaller than any sensor is sure, gets a floor of 0.01 mm and 0.00001 rad (ours):
  /// such an edge acts as rigid.
  explicit EdgeResidual(const UncertainPose2& T_from_to);

  /// Poses are (x, y, theta) in one common frame. Jacobians are row-major 3 x 3, either may be
  /// null.
  void Evaluate(const double* from, const double* to, double* residual, double* d_residual_d_from,
                double* d_residual_d_to) const;

  /// Squared norm of the residual.
  double Chi2(const Pose2& T_w_from, const Pose2& T_w_to) const;

 private:
  Pose2 measured_;
  Eigen::Matrix<double, 3, 3, Eigen::RowMajor> sqrt_information_;  // W, lower triangular
};

}  // namespace masked_mapper
