// SPDX-License-Identifier: BSD-3-Clause
#include "masked_mapper/geometry/uncertain_pose2.hpp"

#include <gtest/gtest.h>

#include <random>

namespace masked_mapper {
namespace {

TEST(ComposedTrace, IsTheTraceOfTheComposition) {
  std::mt19937 random(1);
  std::normal_distribution<double> normal;
  const auto any = [&] {
    Eigen::Matrix3d root;
    for (int i = 0; i < 9; ++i) root(i / 3, i % 3) = normal(random);
    return UncertainPose2{{3.0 * normal(random), 3.0 * normal(random), WrapAngle(normal(random))},
                          root * root.transpose()};
  };
  for (int trial = 0; trial < 200; ++trial) {
    const UncertainPose2 first = any();
    const UncertainPose2 second = any();
    const double forward = (first * second).covariance.trace();
    const double backward = (first * Inverse(second)).covariance.trace();
    EXPECT_NEAR(ComposedTrace(first).With(second), forward, 1e-10 * forward);
    EXPECT_NEAR(ComposedTrace(first).WithInverse(second), backward, 1e-10 * backward);
  }
}

}  // namespace
}  // namespace masked_mapper
