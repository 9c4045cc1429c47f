// SPDX-License-Identifier: BSD-3-Clause
#include "masked_mapper/evaluation/result_folder.hpp"

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>

#include "masked_mapper/text/input_error.hpp"

namespace masked_mapper {
namespace {

TEST(ResultFolder, FloorsAreFoundByHeight) {
  const std::vector<MappedFloor> floors = {{"0", 0.0}, {"1", 4.0}, {"-1", -3.5}};
  EXPECT_EQ(NearestFloor(floors, 0.4), 0U);
  EXPECT_EQ(NearestFloor(floors, 3.0), 1U);
  EXPECT_EQ(NearestFloor(floors, -9.0), 2U);
}

TEST(ResultFolder, AFolderThatIsNoMapIsTheUsersFault) {
  EXPECT_THROW(ReadResultFolder(testing::TempDir() + "/nowhere"), InputError);
  const std::string empty = testing::TempDir() + "/empty_result";
  std::filesystem::create_directories(empty);
  EXPECT_THROW(ReadResultFolder(empty), InputError);
}

TEST(OneDrive, HoldsItsOwnWithItsOwnStamps) {
  ResultFolder whole;
  whole.floors = {{"0", 0.0}, {"0.drive2", 0.0}};
  whole.drives = {{3, 2, 0.0, {"0"}}, {2, 2, 100.0, {"0.drive2"}}};
  whole.graph.emplace();
  for (const double stamp : {1.0, 2.0, 3.0, 101.5, 102.0}) {
    whole.trajectory.emplace_back();
    whole.trajectory.back().stamp = stamp;
  }
  for (const double stamp : {1.0, 3.0, 101.5, 102.0}) {
    whole.graph->nodes.emplace_back();
    whole.graph->nodes.back().stamp = stamp;
  }
  whole.graph->edges = {{0, 1}, {2, 3}, {3, 0}};
  whole.closures.emplace();
  whole.closures->push_back({3, 0, {}});
  whole.closures->push_back({3, 2, {}});
  const ResultFolder second = OneDrive("out", whole, 2);
  ASSERT_EQ(second.trajectory.size(), 2U);
  EXPECT_EQ(second.trajectory[0].stamp, 1.5);
  ASSERT_EQ(second.graph->nodes.size(), 2U);
  EXPECT_EQ(second.graph->nodes[1].stamp, 2.0);
  ASSERT_EQ(second.graph->edges.size(), 1U);
  EXPECT_EQ(second.graph->edges[0].to, 1U);
  ASSERT_EQ(second.closures->size(), 1U) << "one is with another drive";
  EXPECT_EQ((*second.closures)[0].b, 0U);
  ASSERT_EQ(second.floors.size(), 1U);
  EXPECT_EQ(second.floors[0].label, "0.drive2");
  EXPECT_EQ(OneDrive("out", whole, 1).trajectory.size(), 3U);
  EXPECT_THROW(OneDrive("out", whole, 0), InputError);
  EXPECT_THROW(OneDrive("out", whole, 3), InputError);
  // Numbers that no map has.
  whole.drives[0].scans = whole.drives[0].nodes = static_cast<std::size_t>(-1);
  EXPECT_THROW(OneDrive("out", whole, 2), InputError) << "no scan is left for it";
}

}  // namespace
}  // namespace masked_mapper
