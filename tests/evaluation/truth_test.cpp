// SPDX-License-Identifier: BSD-3-Clause
#include "evaluation/truth.hpp"

#include <gtest/gtest.h>

#include "evaluation/written_file.hpp"
#include "masked_mapper/text/input_error.hpp"

namespace masked_mapper {
namespace {

TEST(Truth, OfASimulationIsExactAndBringsItsFloors) {
  Write("drive.log.truth_floors.csv", "t,label\n0,0\n5,-\n8,1\n");
  const std::string path = Write("drive.log.truth.tum", "0 0 0 0 0 0 0 1\n0.2 1 0 0 0 0 0 1\n");
  const Truth truth = ReadTruth(path);
  EXPECT_TRUE(truth.exact);
  EXPECT_EQ(truth.poses.size(), 2U);
  ASSERT_EQ(truth.floors.size(), 3U);
  EXPECT_EQ(truth.floors[1].label, "-");
  const auto pose = TruePoseAt(truth, 0.1);
  ASSERT_TRUE(pose);
  EXPECT_NEAR(pose->T_world_robot.x, 0.5, 1e-12) << "m";
}

TEST(Truth, AReferenceIsNotExact) {
  EXPECT_FALSE(ReadTruth(Write("a.reference.txt", "0 0 0 0\n1 1 0 0\n")).exact);
  EXPECT_THROW(ReadTruth(testing::TempDir() + "/no.truth.tum"), InputError);
}

}  // namespace
}  // namespace masked_mapper
