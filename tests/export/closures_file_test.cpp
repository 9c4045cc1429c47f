// SPDX-License-Identifier: BSD-3-Clause
#include "export/closures_file.hpp"

#include <gtest/gtest.h>

#include "export/sample_map.hpp"

namespace masked_mapper {
namespace {

TEST(ClosuresFile, OneLinePerClosure) {
  const BuildingMap map = SampleMap();
  const TestFolder folder;
  WriteClosures(map.closures, map.graph, folder / "c.csv");
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
  EXPECT_EQ(fields[10], "too few votes");
  EXPECT_EQ(Split(lines[1], ',')[9], "validated");
}

TEST(ClosuresFile, AFloorsNameWithACommaStaysOneField) {
  BuildingMap map = SampleMap();
  std::vector<Floor> floors = map.graph.floors();
  floors[0].label = "said \"no\", twice";
  std::vector<FloorId> floor_of_node;
  for (const Node& node : map.graph.nodes()) floor_of_node.push_back(node.floor);
  map.graph.Refloor(floors, floor_of_node);
  const TestFolder folder;
  WriteClosures(map.closures, map.graph, folder / "c.csv");
  EXPECT_NE(ReadBytes(folder / "c.csv").find(",\"said \"\"no\"\", twice\","), std::string::npos);
}

TEST(ClosuresFile, NoClosureLeavesTheHeader) {
  const TestFolder folder;
  WriteClosures({}, {}, folder / "c.csv");
  EXPECT_EQ(Split(ReadBytes(folder / "c.csv"), '\n').size(), 1U);
}

}  // namespace
}  // namespace masked_mapper
