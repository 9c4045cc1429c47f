// SPDX-License-Identifier: BSD-3-Clause
#include "masked_mapper/geometry/uncertain_pose2.hpp"

#include <cmath>

namespace masked_mapper {

Eigen::Matrix3d ComposeJacobianLeft(const Pose2& T_a_b, const Pose2& T_b_c) {
  const double c = std::cos(T_a_b.theta);
  const double s = std::sin(T_a_b.theta);
  Eigen::Matrix3d jacobian = Eigen::Matrix3d::Identity();
  jacobian(0, 2) = -s * T_b_c.x - c * T_b_c.y;
  jacobian(1, 2) = c * T_b_c.x - s * T_b_c.y;
  return jacobian;
}

Eigen::Matrix3d ComposeJacobianRight(const Pose2& T_a_b, const Pose2& /*T_b_c*/) {
  const double c = std::cos(T_a_b.theta);
  const double s = std::sin(T_a_b.theta);
  Eigen::Matrix3d jacobian = Eigen::Matrix3d::Identity();
  jacobian(0, 0) = c;
  jacobian(0, 1) = -s;
  jacobian(1, 0) = s;
  jacobian(1, 1) = c;
  return jacobian;
}

UncertainPose2 operator*(const UncertainPose2& T_a_b, const UncertainPose2& T_b_c) {
  const Eigen::Matrix3d j1 = ComposeJacobianLeft(T_a_b.mean, T_b_c.mean);
  const Eigen::Matrix3d j2 = ComposeJacobianRight(T_a_b.mean, T_b_c.mean);
  return {T_a_b.mean * T_b_c.mean,
          j1 * T_a_b.covariance * j1.transpose() + j2 * T_b_c.covariance * j2.transpose()};
}

UncertainPose2 Inverse(const UncertainPose2& T_a_b) {
  const double c = std::cos(T_a_b.mean.theta);
  const double s = std::sin(T_a_b.mean.theta);
  const Pose2 T_b_a = Inverse(T_a_b.mean);
  Eigen::Matrix3d jacobian;
  jacobian << -c, -s, T_b_a.y, s, -c, -T_b_a.x, 0.0, 0.0, -1.0;
  return {T_b_a, jacobian * T_a_b.covariance * jacobian.transpose()};
}

}  // namespace masked_mapper
