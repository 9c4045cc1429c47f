// SPDX-License-Identifier: BSD-3-Clause
#include "masked_mapper/export/closures_file.hpp"

#include <gtest/gtest.h>

#include "export/sample_map.hpp"

namespace masked_mapper {
namespace {

TEST(ClosuresFile, OneLinePerAttempt) {
  const MappingResult map = SampleMap();
  const TestFolder folder;
  WriteClosures(map.attempts, map.graph, folder / "c.csv");
  const auto lines = Split(ReadBytes(folder / "c.csv"), '\n');
  ASSERT_EQ(lines.size(), 6U);
  EXPECT_EQ(lines[0], "t_a,t_b,floor,dx,dy,dtheta,score,maha,votes,state,reason");
  const auto fields = Split(lines[2], ',');
  ASSERT_EQ(fields.size(), 11U);
  EXPECT_EQ(fields[0], "1000000010.25");
  EXPECT_EQ(fields[1], "1000000000.25");
  EXPECT_EQ(fields[2], "0");
  const Pose2 T_a_b =
      Between(map.graph.nodes()[1].T_world_robot, map.graph.nodes()[0].T_world_robot);
  EXPECT_NEAR(std::stod(fields[3]), T_a_b.x, 1e-6);
  EXPECT_NEAR(std::stod(fields[4]), T_a_b.y, 1e-6);
  EXPECT_NEAR(std::stod(fields[5]), T_a_b.theta, 1e-8);
  EXPECT_EQ(fields[6], "0.625000");
  EXPECT_EQ(fields[7], "1.500000");
  EXPECT_EQ(fields[8], "6");
  EXPECT_EQ(fields[9], "hypothesis");
  EXPECT_EQ(fields[10], "2 of 6 votes");
  EXPECT_EQ(Split(lines[1], ',')[9], "validated");
}

TEST(ClosuresFile, ReasonsWithCommasAndQuotesStayOneField) {
  const MappingResult map = SampleMap();
  const TestFolder folder;
  WriteClosures(map.attempts, map.graph, folder / "c.csv");
  const std::string text = ReadBytes(folder / "c.csv");
  EXPECT_NE(text.find(",rejected_score,\"score, below 42.5 %\"\n"), std::string::npos);
  EXPECT_NE(text.find(",audited_out,\"said \"\"no\"\"\"\n"), std::string::npos);
}

TEST(ClosuresFile, NoAttemptLeavesTheHeader) {
  const TestFolder folder;
  WriteClosures({}, {}, folder / "c.csv");
  EXPECT_EQ(Split(ReadBytes(folder / "c.csv"), '\n').size(), 1U);
}

}  // namespace
}  // namespace masked_mapper
