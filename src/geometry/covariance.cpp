// SPDX-License-Identifier: BSD-3-Clause
#include "masked_mapper/geometry/uncertain_pose2.hpp"

#include <Eigen/Eigenvalues>

namespace masked_mapper {

bool IsCovariance(const Eigen::Matrix3d& matrix) {
  constexpr double kLargest = 1e12;   // (1000 km)^2: beyond, squares and products lose all digits
  constexpr double kRounding = 1e-9;  // of the largest eigenvalue, or of a unit
  if (!matrix.allFinite() || matrix.cwiseAbs().maxCoeff() > kLargest) return false;
  const double slack = kRounding * (1.0 + matrix.cwiseAbs().maxCoeff());
  if ((matrix - matrix.transpose()).cwiseAbs().maxCoeff() > slack) return false;
  const Eigen::Matrix3d symmetric = 0.5 * (matrix + matrix.transpose());
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> eigen(symmetric, Eigen::EigenvaluesOnly);
  return eigen.info() == Eigen::Success &&
         eigen.eigenvalues()(0) >= -kRounding * (1.0 + eigen.eigenvalues()(2));
}

}  // namespace masked_mapper
