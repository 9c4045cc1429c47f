// SPDX-License-Identifier: BSD-3-Clause
#include "export/trajectory_file.hpp"

#include <gtest/gtest.h>

#include "export/sample_map.hpp"

namespace masked_mapper {
namespace {

std::vector<std::vector<double>> ReadTum(const std::filesystem::path& path) {
  std::vector<std::vector<double>> rows;
  for (const std::string& line : Split(ReadBytes(path), '\n')) {
    rows.emplace_back();
    for (const std::string& field : Split(line, ' ')) rows.back().push_back(std::stod(field));
    EXPECT_EQ(rows.back().size(), 8U) << line;
  }
  return rows;
}

void ExpectPose(const std::vector<double>& row, double stamp, const Pose2& pose, double elevation) {
  EXPECT_EQ(row[0], stamp);
  EXPECT_NEAR(row[1], pose.x, 1e-6);
  EXPECT_NEAR(row[2], pose.y, 1e-6);
  EXPECT_NEAR(row[3], elevation, 1e-6);
  EXPECT_EQ(row[4], 0.0);
  EXPECT_EQ(row[5], 0.0);
  EXPECT_NEAR(WrapAngle(2.0 * std::atan2(row[6], row[7]) - pose.theta), 0.0, 1e-8);
  EXPECT_NEAR(row[6] * row[6] + row[7] * row[7], 1.0, 1e-8);
}

TEST(TrajectoryFile, OneLinePerScanAtItsFloor) {
  const BuildingMap map = SampleMap();
  const TestFolder folder;
  WriteTrajectory(map.trajectory, map.graph.floors(), folder / "t.tum");
  const auto rows = ReadTum(folder / "t.tum");
  ASSERT_EQ(rows.size(), map.trajectory.size());
  for (std::size_t i = 0; i < rows.size(); ++i) {
    ExpectPose(rows[i], map.trajectory[i].stamp, map.trajectory[i].T_world_robot,
               i >= 6 ? -3.5 : 0.0);
  }
}

TEST(TrajectoryFile, OneLinePerNode) {
  const BuildingMap map = SampleMap();
  const TestFolder folder;
  WriteNodes(map.graph, folder / "n.tum");
  const auto rows = ReadTum(folder / "n.tum");
  ASSERT_EQ(rows.size(), 4U);
  for (std::size_t i = 0; i < rows.size(); ++i) {
    ExpectPose(rows[i], map.graph.nodes()[i].stamp, map.graph.nodes()[i].T_world_robot,
               i == 3 ? -3.5 : 0.0);
  }
}

TEST(TrajectoryFile, NothingIsAnEmptyFile) {
  const TestFolder folder;
  WriteTrajectory({}, {}, folder / "t.tum");
  EXPECT_EQ(ReadBytes(folder / "t.tum"), "");
}

}  // namespace
}  // namespace masked_mapper
