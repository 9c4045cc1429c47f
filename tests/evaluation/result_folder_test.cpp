// SPDX-License-Identifier: BSD-3-Clause
#include "evaluation/result_folder.hpp"

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

// The scan that stood third in the drive steps back by a second in the log.
TEST(ResultFolder, PosesAndNodesAreFoundByTheLogsOwnStamps) {
  const std::filesystem::path folder = testing::TempDir() + "/stepping_result";
  std::filesystem::create_directories(folder);
  std::ofstream(folder / "trajectory.tum") << "1 0 0 0 0 0 0 1\n2 1 0 0 0 0 0 1\n"
                                              "1.5 2 0 0 0 0 0 1\n2.5 3 0 0 0 0 0 1\n";
  std::ofstream(folder / "nodes.tum") << "1 0 0 0 0 0 0 1\n2.25 2 0 0 0 0 0 1\n";
  std::ofstream(folder / "graph.g2o")
      << "VERTEX_SE2 0 0 0 0\nVERTEX_SE2 1 2 0 0\nEDGE_SE2 0 1 2 0 0 1 0 0 1 0 1\n";
  std::ofstream(folder / "summary.json")
      << R"({"floors": [{"label": "0", "elevation_m": 0.0}], "mended_stamps": [[2, 2.25]]})";
  const ResultFolder result = ReadResultFolder(folder.string());
  ASSERT_EQ(result.scans.size(), 4U);
  EXPECT_EQ(result.scans[2].pose.stamp, 1.5);
  EXPECT_EQ(result.scans[2].stamp, 2.25);
  EXPECT_EQ(result.trajectory[1].T_world_robot.x, 2.0) << "in order of the log's stamps";
  ASSERT_EQ(result.graph->log_stamps.size(), 2U);
  EXPECT_EQ(result.graph->log_stamps[1], 1.5);
}

TEST(OneDrive, HoldsItsOwnWithItsOwnStamps) {
  ResultFolder whole;
  whole.floors = {{"0", 0.0}, {"0.drive2", 0.0}};
  whole.drives = {{3, 2, 0.0, {"0"}}, {2, 2, 100.0, {"0.drive2"}}};
  whole.graph.emplace();
  for (const auto& [log_stamp, stamp] : std::vector<std::pair<double, double>>{
           {1.0, 1.0}, {2.0, 2.0}, {3.0, 3.0}, {1.5, 101.5}, {2.0, 102.0}}) {
    whole.scans.emplace_back();
    whole.scans.back().pose.stamp = log_stamp;
    whole.scans.back().stamp = stamp;
  }
  for (const double stamp : {1.0, 3.0, 101.5, 102.0}) {
    whole.graph->nodes.emplace_back();
    whole.graph->nodes.back().stamp = stamp;
  }
  whole.graph->log_stamps = {1.0, 3.0, 1.5, 2.0};
  whole.graph->edges = {{0, 1}, {2, 3}, {3, 0}};
  whole.closures.emplace();
  whole.closures->push_back({3, 0, {}});
  whole.closures->push_back({3, 2, {}});
  const ResultFolder second = OneDrive("out", whole, 2);
  ASSERT_EQ(second.trajectory.size(), 2U);
  EXPECT_EQ(second.trajectory[0].stamp, 1.5);
  ASSERT_EQ(second.graph->nodes.size(), 2U);
  EXPECT_EQ(second.graph->nodes[1].stamp, 2.0);
  EXPECT_EQ(second.graph->log_stamps[0], 1.5);
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
