// SPDX-License-Identifier: BSD-3-Clause
// Random poses and covariances for tests, from a generator that the test seeds.
#pragma once

#include <Eigen/Cholesky>
#include <Eigen/Core>
#include <random>

#include "masked_mapper/geometry/uncertain_pose2.hpp"

namespace masked_mapper {

inline Pose2 RandomPose(std::mt19937& random, double reach_m = 10.0) {
  std::uniform_real_distribution<double> position(-reach_m, reach_m);
  std::uniform_real_distribution<double> angle(-kPi, kPi);
  const double x = position(random);
  const double y = position(random);
  return {x, y, angle(random)};
}

/// Positive definite, with correlations; standard deviations of about `sigma`.
inline Eigen::Matrix3d RandomCovariance(std::mt19937& random, double sigma) {
  std::normal_distribution<double> normal(0.0, sigma);
  Eigen::Matrix3d root;
  for (int i = 0; i < 9; ++i) root(i / 3, i % 3) = normal(random);
  return root * root.transpose() + 0.01 * sigma * sigma * Eigen::Matrix3d::Identity();
}

/// A draw from the distribution that an uncertain pose stands for.
inline Pose2 Draw(std::mt19937& random, const UncertainPose2& pose) {
  std::normal_distribution<double> normal(0.0, 1.0);
  const double a = normal(random);
  const double b = normal(random);
  const Eigen::Vector3d unit(a, b, normal(random));
  const Eigen::Vector3d sample = pose.mean.AsVector() + pose.covariance.llt().matrixL() * unit;
  return {sample.x(), sample.y(), sample.z()};
}

}  // namespace masked_mapper
