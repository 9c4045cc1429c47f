// SPDX-License-Identifier: BSD-3-Clause
#include "evaluation/floors.hpp"

#include <gtest/gtest.h>

namespace masked_mapper {
namespace {

// Ten scans, one a second: five at height 0, five at 4 m.
std::vector<StampedPose> Ride() {
  std::vector<StampedPose> trajectory;
  for (int i = 0; i < 10; ++i) {
    StampedPose pose;
    pose.stamp = i;
    pose.z = i < 5 ? 0.0 : 4.0;
    trajectory.push_back(pose);
  }
  return trajectory;
}

TEST(CompareFloors, TransitIsLeftAsideAndNamesMayDiffer) {
  const auto identity = CompareFloors(Ride(), {{"0", 0.0}, {"1", 4.0}},
                                      {{0.0, "ground"}, {4.0, "-"}, {6.0, "upper"}});
  ASSERT_TRUE(identity);
  EXPECT_EQ(identity->scans, 8U);
  EXPECT_EQ(identity->right, 8U);
  EXPECT_EQ(identity->same_label, 0U);
}

TEST(CompareFloors, AScanOnTheWrongFloorIsWrong) {
  const auto identity = CompareFloors(Ride(), {{"0", 0.0}, {"1", 4.0}}, {{0.0, "0"}, {7.0, "1"}});
  ASSERT_TRUE(identity);
  EXPECT_EQ(identity->scans, 10U);
  EXPECT_EQ(identity->right, 8U) << "seconds 5 and 6 were still on the first floor";
  EXPECT_DOUBLE_EQ(identity->Right(), 0.8);
}

}  // namespace
}  // namespace masked_mapper
