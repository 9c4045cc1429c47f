// SPDX-License-Identifier: BSD-3-Clause
#include "masked_mapper/geometry/pose2.hpp"

#include <gtest/gtest.h>

#include <random>

#include "geometry/random_pose.hpp"

namespace masked_mapper {
namespace {

TEST(RigidAlignment, FindsTheMotion) {
  std::mt19937 random(1);
  for (int i = 0; i < 50; ++i) {
    const Pose2 T_a_b = RandomPose(random);
    std::vector<std::pair<Eigen::Vector2d, Eigen::Vector2d>> pairs;
    for (int k = 0; k < 5; ++k) {
      const Eigen::Vector2d in_b = RandomPose(random).Translation();
      pairs.emplace_back(T_a_b * in_b, in_b);
    }
    const Pose2 left = Between(T_a_b, AlignRigidly(pairs));
    EXPECT_LT(left.AsVector().norm(), 1e-9);
  }
}

TEST(RigidAlignment, OfPointsThatDoNotSpreadAShift) {
  EXPECT_EQ(AlignRigidly({}).AsVector(), Pose2().AsVector());
  EXPECT_EQ(AlignRigidly({{{3.0, 4.0}, {1.0, 1.0}}}).AsVector(), Eigen::Vector3d(2.0, 3.0, 0.0));
}

}  // namespace
}  // namespace masked_mapper
