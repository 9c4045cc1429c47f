// SPDX-License-Identifier: BSD-3-Clause
#include "masked_mapper/geometry/mahalanobis.hpp"

#include <Eigen/Cholesky>
#include <cmath>
#include <limits>

namespace masked_mapper {

double MahalanobisDistance(const Eigen::Vector2d& displacement, const Eigen::Matrix2d& covariance,
                           double range_m) {
  const Eigen::Matrix2d spread = covariance + range_m * range_m * Eigen::Matrix2d::Identity();
  const Eigen::LDLT<Eigen::Matrix2d> factor(spread);
  return std::sqrt(std::max(0.0, displacement.dot(factor.solve(displacement))));
}

double MahalanobisFromIdentity(const UncertainPose2& loop) {
  const Eigen::Vector3d error(loop.mean.x, loop.mean.y, WrapAngle(loop.mean.theta));
  if (error.isZero(0.0)) return 0.0;
  const Eigen::LLT<Eigen::Matrix3d> factor(loop.covariance);
  if (factor.info() != Eigen::Success) return std::numeric_limits<double>::infinity();
  return std::sqrt(std::max(0.0, error.dot(factor.solve(error))));
}

}  // namespace masked_mapper
