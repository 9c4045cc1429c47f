// SPDX-License-Identifier: BSD-3-Clause
#include "masked_mapper/geometry/uncertain_pose2.hpp"

#include <gtest/gtest.h>

#include "geometry/random_pose.hpp"

namespace masked_mapper {
namespace {

Pose2 Nudge(Pose2 pose, int parameter, double step) {
  (parameter == 0 ? pose.x : parameter == 1 ? pose.y : pose.theta) += step;
  return pose;
}

/// Central differences of a pose-valued function of one pose.
template <typename Function>
Eigen::Matrix3d NumericJacobian(const Function& function, const Pose2& at) {
  constexpr double kStep = 1e-6;
  Eigen::Matrix3d jacobian;
  for (int parameter = 0; parameter < 3; ++parameter) {
    const Pose2 ahead = function(Nudge(at, parameter, kStep));
    const Pose2 behind = function(Nudge(at, parameter, -kStep));
    const Eigen::Vector3d difference(ahead.x - behind.x, ahead.y - behind.y,
                                     WrapAngle(ahead.theta - behind.theta));
    jacobian.col(parameter) = difference / (2.0 * kStep);
  }
  return jacobian;
}

TEST(UncertainPose2, JacobiansMatchFiniteDifferences) {
  std::mt19937 random(2);
  for (int i = 0; i < 50; ++i) {
    const Pose2 left = RandomPose(random);
    const Pose2 right = RandomPose(random);
    const auto of_left = [&](const Pose2& pose) { return pose * right; };
    const auto of_right = [&](const Pose2& pose) { return left * pose; };
    EXPECT_LT((ComposeJacobianLeft(left, right) - NumericJacobian(of_left, left)).norm(), 1e-7);
    EXPECT_LT((ComposeJacobianRight(left, right) - NumericJacobian(of_right, right)).norm(), 1e-7);

    const auto inverse = [](const Pose2& pose) { return Inverse(pose); };
    const Eigen::Matrix3d jacobian = NumericJacobian(inverse, left);
    const Eigen::Matrix3d covariance = RandomCovariance(random, 0.1);
    const Eigen::Matrix3d expected = jacobian * covariance * jacobian.transpose();
    EXPECT_LT((Inverse(UncertainPose2{left, covariance}).covariance - expected).norm(),
              1e-6 * expected.norm());
  }
}

TEST(UncertainPose2, CompositionMatchesSampling) {
  std::mt19937 random(3);
  const UncertainPose2 first{{3.0, -1.0, 0.7}, RandomCovariance(random, 0.01)};
  const UncertainPose2 second{{5.0, 2.0, -1.2}, RandomCovariance(random, 0.01)};
  const UncertainPose2 product = first * second;
  constexpr int kSamples = 200000;
  Eigen::Matrix3d sum = Eigen::Matrix3d::Zero();
  for (int i = 0; i < kSamples; ++i) {
    const Pose2 sample = Draw(random, first) * Draw(random, second);
    const Eigen::Vector3d error = sample.AsVector() - product.mean.AsVector();
    sum += error * error.transpose();
  }
  EXPECT_LT((sum / kSamples - product.covariance).norm(), 0.02 * product.covariance.norm());
}

TEST(UncertainPose2, InverseOfInverseIsTheSame) {
  std::mt19937 random(4);
  const UncertainPose2 pose{RandomPose(random), RandomCovariance(random, 0.2)};
  const UncertainPose2 back = Inverse(Inverse(pose));
  EXPECT_LT((back.mean.AsVector() - pose.mean.AsVector()).norm(), 1e-12);
  EXPECT_LT((back.covariance - pose.covariance).norm(), 1e-10);
}

}  // namespace
}  // namespace masked_mapper
