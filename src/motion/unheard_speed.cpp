// SPDX-License-Identifier: BSD-3-Clause
#include "unheard_speed.hpp"

#include <Eigen/Eigenvalues>
#include <Eigen/Geometry>
#include <Eigen/LU>
#include <algorithm>
#include <cmath>

namespace masked_mapper {
namespace {

constexpr double kExact = 1e-12;        // m^2, of a step that is taken for exact
constexpr double kMostStretched = 2.0;  // a longer step says nothing of the speed before it

/// Symmetric, and without a negative eigenvalue.
Eigen::Matrix2d PositivePart(const Eigen::Matrix2d& matrix) {
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix2d> axes(0.5 * (matrix + matrix.transpose()));
  return axes.eigenvectors() * axes.eigenvalues().cwiseMax(0.0).asDiagonal() *
         axes.eigenvectors().transpose();
}

}  // namespace

void UnheardSpeed::Keep(const UncertainPose2& T_last_now, double elapsed,
                        const Eigen::Matrix2d& step) {
  T_last_now_ = T_last_now.mean;
  elapsed_ = elapsed;
  step_ = step;
}

void UnheardSpeed::Hear(const UncertainPose2& T_last_now, double elapsed) {
  Keep(T_last_now, elapsed, T_last_now.covariance.topLeftCorner<2, 2>());
  way_step_.setZero();
}

Eigen::Matrix3d UnheardSpeed::Observe(const UncertainPose2& T_last_now, const Guess& guess,
                                      const Eigen::Matrix2d& seen, double elapsed) {
  // By how much speed changes from step to step, and is off in the long run, says how long an error
  // of it lasts.
  const double lasts = std::sqrt(
      std::max(0.0, 1.0 - guess.variance / std::max(kExact, guess.most_sigma * guess.most_sigma)));
  const double ratio = elapsed_ > 0.0 ? std::min(kMostStretched, elapsed / elapsed_) : 0.0;
  const Eigen::Matrix2d R_last_before = Eigen::Rotation2Dd(-T_last_now_.theta).toRotationMatrix();
  const Eigen::Matrix2d goes_on = lasts * ratio * R_last_before;
  const Eigen::Matrix2d expected = goes_on * step_ * goes_on.transpose() +
                                   std::max(kExact, guess.variance) * Eigen::Matrix2d::Identity();
  const Eigen::Matrix2d step = (expected.inverse() + PositivePart(seen)).inverse();
  // Of an error that goes on, as much is left as the scan left of it.
  const Eigen::Matrix2d left = step * expected.inverse();
  const Eigen::Matrix2d way_step =
      R_last_before * way_step_ * goes_on.transpose() * left.transpose();
  way_step_ = way_step + step;
  Keep(T_last_now, elapsed, step);

  Eigen::Matrix3d covariance = T_last_now.covariance;
  covariance.topLeftCorner<2, 2>() = PositivePart(step + way_step + way_step.transpose());
  return covariance;
}

}  // namespace masked_mapper
