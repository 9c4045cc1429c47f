// SPDX-License-Identifier: BSD-3-Clause
#include "masked_mapper/geometry/uncertain_pose2.hpp"

#include <Eigen/Cholesky>
#include <cmath>
#include <limits>

namespace masked_mapper {
namespace {

/// A square that rounding made negative counts as zero; NaN stays NaN, so that no limit is ever
/// passed by a distance that is not a number.
double RootOfSquare(double square) { return square < 0.0 ? 0.0 : std::sqrt(square); }

}  // namespace

double MahalanobisDistance(const Eigen::Vector2d& displacement, const Eigen::Matrix2d& covariance,
                           double range_m) {
  const Eigen::Matrix2d spread = covariance + range_m * range_m * Eigen::Matrix2d::Identity();
  const Eigen::LDLT<Eigen::Matrix2d> factor(spread);
  return RootOfSquare(displacement.dot(factor.solve(displacement)));
}

double MahalanobisFromIdentity(const UncertainPose2& loop) {
  const Eigen::Vector3d error(loop.mean.x, loop.mean.y, WrapAngle(loop.mean.theta));
  if (error.isZero(0.0)) return 0.0;
  const Eigen::LLT<Eigen::Matrix3d> factor(loop.covariance);
  if (factor.info() != Eigen::Success) return std::numeric_limits<double>::infinity();
  return RootOfSquare(error.dot(factor.solve(error)));
}

}  // namespace masked_mapper
