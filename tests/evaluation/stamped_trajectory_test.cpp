// SPDX-License-Identifier: BSD-3-Clause
#include "evaluation/stamped_trajectory.hpp"

#include <gtest/gtest.h>

#include "evaluation/written_file.hpp"
#include "masked_mapper/text/input_error.hpp"

namespace masked_mapper {
namespace {

TEST(StampedTrajectory, BothFormsAreReadAndPosesInterpolated) {
  const std::string plain = Write("plain.txt", "# t x y theta\n1 0 0 0\n2 2 4 1\n");
  const auto trajectory = ReadTrajectory(plain);
  ASSERT_EQ(trajectory.size(), 2U);
  const auto middle = PoseAt(trajectory, 1.5);
  ASSERT_TRUE(middle);
  EXPECT_NEAR(middle->T_world_robot.x, 1.0, 1e-12);
  EXPECT_NEAR(middle->T_world_robot.y, 2.0, 1e-12);
  EXPECT_NEAR(middle->T_world_robot.theta, 0.5, 1e-12);
  EXPECT_TRUE(PoseAt(trajectory, 2.4));
  EXPECT_FALSE(PoseAt(trajectory, 2.6)) << "half a second of slack, no more";
  const auto tum =
      ReadTrajectory(Write("a.tum", "3 1 2 5 0 0 0.7071067811865476 0.7071067811865476\n"));
  ASSERT_EQ(tum.size(), 1U);
  EXPECT_NEAR(tum[0].T_world_robot.theta, kPi / 2, 1e-9);
  EXPECT_EQ(tum[0].z, 5.0);
  EXPECT_THROW(ReadTrajectory(Write("bad.tum", "1 2\n")), InputError);
}

}  // namespace
}  // namespace masked_mapper
