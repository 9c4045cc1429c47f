// SPDX-License-Identifier: BSD-3-Clause
#include "masked_mapper/geometry/uncertain_pose2.hpp"

#include <gtest/gtest.h>

#include <Eigen/LU>
#include <cmath>
#include <limits>

#include "geometry/random_pose.hpp"

namespace masked_mapper {
namespace {

TEST(Mahalanobis, MatchesTheExplicitInverse) {
  std::mt19937 random(5);
  for (int i = 0; i < 100; ++i) {
    const Eigen::Vector2d displacement = RandomPose(random).Translation();
    const Eigen::Matrix2d covariance = RandomCovariance(random, 1.5).topLeftCorner<2, 2>();
    const Eigen::Matrix2d spread = covariance + 4.0 * Eigen::Matrix2d::Identity();
    EXPECT_NEAR(MahalanobisDistance(displacement, covariance, 2.0),
                std::sqrt(displacement.dot(spread.inverse() * displacement)), 1e-10);
  }
}

TEST(Mahalanobis, WithoutUncertaintyTheRangeAloneCounts) {
  EXPECT_DOUBLE_EQ(MahalanobisDistance({6.0, 8.0}, Eigen::Matrix2d::Zero(), 2.0), 5.0);
}

TEST(Mahalanobis, FromIdentityMatchesTheExplicitInverse) {
  std::mt19937 random(6);
  for (int i = 0; i < 100; ++i) {
    const UncertainPose2 loop{RandomPose(random), RandomCovariance(random, 0.5)};
    const Eigen::Vector3d error = loop.mean.AsVector();
    EXPECT_NEAR(MahalanobisFromIdentity(loop),
                std::sqrt(error.dot(loop.covariance.inverse() * error)), 1e-6);
  }
}

TEST(Mahalanobis, FromIdentityOfCertainLoops) {
  EXPECT_EQ(MahalanobisFromIdentity(UncertainPose2{}), 0.0);
  EXPECT_TRUE(std::isinf(MahalanobisFromIdentity({{0.1, 0.0, 0.0}, Eigen::Matrix3d::Zero()})));
}

TEST(Mahalanobis, WhatIsNotANumberIsNotNear) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  EXPECT_FALSE(MahalanobisDistance({nan, 0.0}, Eigen::Matrix2d::Identity(), 2.0) < 5.0);
  EXPECT_FALSE(MahalanobisDistance({1.0, 0.0}, Eigen::Matrix2d::Constant(nan), 2.0) < 5.0);
  EXPECT_FALSE(MahalanobisFromIdentity({{nan, 0.0, 0.0}, Eigen::Matrix3d::Identity()}) < 2.0);
  EXPECT_FALSE(MahalanobisFromIdentity({{0.1, 0.0, 0.0}, Eigen::Matrix3d::Constant(nan)}) < 2.0);
}

}  // namespace
}  // namespace masked_mapper
