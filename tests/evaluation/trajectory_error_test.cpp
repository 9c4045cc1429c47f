// SPDX-License-Identifier: BSD-3-Clause
#include "evaluation/trajectory_error.hpp"

#include <gtest/gtest.h>

namespace masked_mapper {
namespace {

TEST(TrajectoryError, AlignmentRecoversAKnownMotion) {
  const Pose2 T_truth_map{3.0, -2.0, DegToRad(70.0)};
  Truth truth;
  std::vector<StampedPose> map;
  for (int i = 0; i < 40; ++i) {
    const Pose2 pose{0.5 * i, 0.02 * i * i, 0.05 * i};
    map.push_back({0.1 * i, pose, 0.0});
    truth.poses.push_back({0.1 * i, T_truth_map * pose, 0.0});
  }
  truth.exact = true;
  const auto error = CompareWithTruth(map, truth, {{"0", 0.0}});
  ASSERT_TRUE(error);
  EXPECT_EQ(error->paired, 40U);
  EXPECT_NEAR(error->aligned.position_m.max, 0.0, 1e-9);
  EXPECT_NEAR(error->aligned.heading_deg.max, 0.0, 1e-9);
  EXPECT_GT(error->as_it_stands.position_m.mean, 1.0);
  EXPECT_NEAR(error->relative_translation_m.max, 0.0, 1e-9);
  ASSERT_EQ(error->floors.size(), 1U);
}

TEST(TrajectoryError, OffsetsByHand) {
  Truth truth;
  truth.exact = true;
  truth.poses = {{0.0, {0, 0, 0}, 0.0}, {1.0, {1, 0, 0}, 0.0}, {5.0, {5, 0, 0}, 3.0}};
  const std::vector<StampedPose> map = {{0.0, {0, 0.3, 0}, 0.0},
                                        {0.5, {0.5, 0.1, 0}, 0.0},
                                        {3.0, {3, 9, 0}, 0.0},  // inside a gap of the truth
                                        {5.0, {5, 0.2, 0}, 3.5}};
  const auto error = CompareWithTruth(map, truth, {{"0", 0.0}, {"1", 3.5}});
  ASSERT_TRUE(error);
  EXPECT_EQ(error->scans, 4U);
  EXPECT_EQ(error->paired, 3U);
  EXPECT_NEAR(error->as_it_stands.position_m.mean, 0.2, 1e-12);
  EXPECT_NEAR(error->elevation_m.max, 0.5, 1e-12);
  ASSERT_EQ(error->floors.size(), 2U);
  EXPECT_NEAR(error->floors[1].as_it_stands.position_m.mean, 0.2, 1e-12);
  EXPECT_NEAR(error->floors[1].aligned.position_m.mean, 0.0, 1e-12);
  EXPECT_FALSE(CompareWithTruth({{99.0, {}, 0.0}}, truth, {}));
}

}  // namespace
}  // namespace masked_mapper
