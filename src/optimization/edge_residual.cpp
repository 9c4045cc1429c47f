// SPDX-License-Identifier: BSD-3-Clause
#include "edge_residual.hpp"

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>
#include <cmath>

#include "masked_mapper/text/check.hpp"

namespace masked_mapper {
namespace {

constexpr double kFloor = 1e-5;  // m and rad, see the header

Eigen::Matrix3d SqrtInformation(const Eigen::Matrix3d& covariance) {
  Check(covariance.allFinite(), "a covariance is finite");
  const Eigen::Matrix3d symmetric = 0.5 * (covariance + covariance.transpose());
  Eigen::LLT<Eigen::Matrix3d> factor(symmetric);
  const bool firm = factor.info() == Eigen::Success &&
                    Eigen::Matrix3d(factor.matrixL()).diagonal().minCoeff() >= kFloor;
  if (!firm) {
    const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> eigen(symmetric);
    // Rounding may take a zero eigenvalue a little below zero; more than that is no covariance.
    Check(eigen.eigenvalues()(0) >= -1e-9 * (1.0 + eigen.eigenvalues()(2)),
          "a covariance is positive semi-definite");
    const Eigen::Vector3d floored = eigen.eigenvalues().cwiseMax(kFloor * kFloor);
    factor.compute(eigen.eigenvectors() * floored.asDiagonal() * eigen.eigenvectors().transpose());
    if (factor.info() != Eigen::Success) {  // the smallest drowned in the rounding of the largest
      return floored.cwiseSqrt().cwiseInverse().asDiagonal() * eigen.eigenvectors().transpose();
    }
  }
  return factor.matrixL().solve(Eigen::Matrix3d::Identity());
}

}  // namespace

EdgeResidual::EdgeResidual(const UncertainPose2& T_from_to)
    : measured_(T_from_to.mean), sqrt_information_(SqrtInformation(T_from_to.covariance)) {}

void EdgeResidual::Evaluate(const double* from, const double* to, double* residual,
                            double* d_residual_d_from, double* d_residual_d_to) const {
  const double c = std::cos(from[2]);
  const double s = std::sin(from[2]);
  const double dx = to[0] - from[0];
  const double dy = to[1] - from[1];
  const double x_in_from = c * dx + s * dy;
  const double y_in_from = -s * dx + c * dy;
  const double error[3] = {x_in_from - measured_.x, y_in_from - measured_.y,
                           WrapAngle(to[2] - from[2] - measured_.theta)};
  for (int row = 0; row < 3; ++row) {
    const double w0 = sqrt_information_(row, 0);
    const double w1 = sqrt_information_(row, 1);
    const double w2 = sqrt_information_(row, 2);
    residual[row] = w0 * error[0] + w1 * error[1] + w2 * error[2];
    const double d_x = w0 * c - w1 * s;
    const double d_y = w0 * s + w1 * c;
    if (d_residual_d_from != nullptr) {
      d_residual_d_from[3 * row] = -d_x;
      d_residual_d_from[3 * row + 1] = -d_y;
      d_residual_d_from[3 * row + 2] = w0 * y_in_from - w1 * x_in_from - w2;
    }
    if (d_residual_d_to != nullptr) {
      d_residual_d_to[3 * row] = d_x;
      d_residual_d_to[3 * row + 1] = d_y;
      d_residual_d_to[3 * row + 2] = w2;
    }
  }
}

double EdgeResidual::Chi2(const Pose2& T_w_from, const Pose2& T_w_to) const {
  const double from[3] = {T_w_from.x, T_w_from.y, T_w_from.theta};
  const double to[3] = {T_w_to.x, T_w_to.y, T_w_to.theta};
  double residual[3];
  Evaluate(from, to, residual, nullptr, nullptr);
  return residual[0] * residual[0] + residual[1] * residual[1] + residual[2] * residual[2];
}

}  // namespace masked_mapper
