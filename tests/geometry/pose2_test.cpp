// SPDX-License-Identifier: BSD-3-Clause
#include "masked_mapper/geometry/pose2.hpp"

#include <gtest/gtest.h>

#include <Eigen/Geometry>

#include "geometry/random_pose.hpp"

namespace masked_mapper {
namespace {

Eigen::Isometry2d AsIsometry(const Pose2& pose) {
  return Eigen::Translation2d(pose.Translation()) * Eigen::Rotation2Dd(pose.theta);
}

void ExpectSame(const Pose2& found, const Eigen::Isometry2d& expected) {
  EXPECT_LT((AsIsometry(found).matrix() - expected.matrix()).norm(), 1e-12);
}

TEST(Pose2, AgreesWithEigen) {
  std::mt19937 random(1);
  for (int i = 0; i < 100; ++i) {
    const Pose2 T_a_b = RandomPose(random);
    const Pose2 T_b_c = RandomPose(random);
    ExpectSame(T_a_b * T_b_c, AsIsometry(T_a_b) * AsIsometry(T_b_c));
    ExpectSame(Inverse(T_a_b), AsIsometry(T_a_b).inverse());
    ExpectSame(Between(T_a_b, T_b_c), AsIsometry(T_a_b).inverse() * AsIsometry(T_b_c));
    const Eigen::Vector2d point = T_b_c.Translation();
    EXPECT_LT((T_a_b * point - AsIsometry(T_a_b) * point).norm(), 1e-12);
  }
}

TEST(Pose2, AnglesStayWrapped) {
  const Pose2 turned = Pose2{0.0, 0.0, 3.0} * Pose2{0.0, 0.0, 3.0};
  EXPECT_NEAR(turned.theta, 6.0 - 2.0 * kPi, 1e-15);
}

TEST(Pose2, InterpolationTakesTheShorterArc) {
  const Pose2 T_w_a{0.0, 0.0, 3.0};
  const Pose2 T_w_b{2.0, 4.0, -3.0};
  const Pose2 half = Interpolate(T_w_a, T_w_b, 0.5);
  EXPECT_NEAR(half.x, 1.0, 1e-12);
  EXPECT_NEAR(half.y, 2.0, 1e-12);
  EXPECT_NEAR(std::abs(half.theta), kPi, 1e-12);
  EXPECT_NEAR(Interpolate(T_w_a, T_w_b, 0.0).theta, 3.0, 1e-12);
  EXPECT_NEAR(Interpolate(T_w_a, T_w_b, 1.0).theta, -3.0, 1e-12);
}

TEST(Pose2, DistanceIsStraight) {
  EXPECT_DOUBLE_EQ(Distance({1.0, 1.0, 2.0}, {4.0, 5.0, -1.0}), 5.0);
}

}  // namespace
}  // namespace masked_mapper
