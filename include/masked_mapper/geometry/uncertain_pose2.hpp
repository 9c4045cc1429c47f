// SPDX-License-Identifier: BSD-3-Clause
// A transform with its covariance, composed as in Section III-C, Eq. 3-6. The covariance is that of
// the parameters (x, y, theta) of T_a_b, so its translation part is expressed in frame a.
#pragma once

#include <Eigen/Core>

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

}  // namespace masked_mapper
