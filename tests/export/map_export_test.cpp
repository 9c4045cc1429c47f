// SPDX-License-Identifier: BSD-3-Clause
#include "masked_mapper/export/map_export.hpp"

#include <gtest/gtest.h>

#include <algorithm>

#include "export/sample_map.hpp"
#include "masked_mapper/text/input_error.hpp"

namespace masked_mapper {
namespace {

TEST(MapExport, WritesTheFilesOfTheContract) {
  const TestFolder folder;
  const Summary summary = WriteMap(SampleMap(), {"a.log", "openings", {}}, {}, folder.path());
  EXPECT_EQ(FilesBelow(folder.path()),
            (std::vector<std::string>{"building.bt", "building.pcd", "building.ply", "closures.csv",
                                      "floors/-1.g2o", "floors/-1.pcd", "floors/-1.pgm",
                                      "floors/-1.yaml", "floors/0.g2o", "floors/0.pcd",
                                      "floors/0.pgm", "floors/0.yaml", "graph.g2o", "nodes.tum",
                                      "report.html", "summary.json", "trajectory.tum"}));
  EXPECT_GT(summary.seconds.rendering, 0.0);
  EXPECT_GT(summary.seconds.export_, 0.0);
  EXPECT_GE(summary.seconds.total, 1.25);
  ASSERT_EQ(summary.floors.size(), 2U);
  EXPECT_NEAR(summary.floors[1].area_m2, 36.0, 3.0);
}

TEST(MapExport, SameBytesAtAnyNumberOfThreads) {
  const TestFolder one;
  const TestFolder two;
  ExportOptions options;
  WriteMap(SampleMap(), {}, options, one.path());
  options.grid.threads = 2;
  WriteMap(SampleMap(), {}, options, two.path());
  for (const std::string& name : FilesBelow(one.path())) {
    if (name == "summary.json" || name == "report.html") continue;  // they show seconds
    EXPECT_EQ(ReadBytes(one / name), ReadBytes(two / name)) << name;
  }
}

TEST(MapExport, ScansInTransitAreNotDrawn) {
  BuildingMap map = SampleMap();
  for (TrajectoryPose& pose : map.trajectory) {
    if (pose.in_transit) pose.T_world_robot = {100.0, 100.0, 0.0};
  }
  for (const OccupancyGrid& grid : RenderFloors(map, {})) {
    EXPECT_LT(KnownArea(grid), 80.0);
    EXPECT_LT(grid.width, 300);
  }
}

TEST(MapExport, FloorWithoutScansHasItsFiles) {
  BuildingMap map = SampleMap();
  map.graph.AddFloor({"attic", 7.0, 0.1, true});
  const TestFolder folder;
  const Summary summary = WriteMap(map, {}, {}, folder.path());
  EXPECT_EQ(summary.floors[2].area_m2, 0.0);
  for (const char* name : {"attic.g2o", "attic.pcd", "attic.pgm", "attic.yaml"}) {
    EXPECT_TRUE(std::filesystem::exists(folder / "floors" / name)) << name;
  }
}

TEST(MapExport, EmptyMapIsWritten) {
  const TestFolder folder;
  WriteMap({}, {}, {}, folder.path());
  EXPECT_TRUE(std::filesystem::exists(folder / "building.bt"));
}

TEST(MapExport, LabelThatLeavesTheFolderIsRefused) {
  BuildingMap map = SampleMap();
  map.graph.AddFloor({"../outside"});
  const TestFolder folder;
  EXPECT_THROW(WriteMap(map, {}, {}, folder.path()), InputError);
  EXPECT_TRUE(FilesBelow(folder.path()).empty());
}

TEST(MapExport, NamesWhatItWrites) {
  const TestFolder folder;
  BuildingMap map = SampleMap();
  map.drives.resize(2);
  map.drives[1].first_pose = 3;
  map.drives[1].first_node = 1;
  WriteMap(map, {}, {}, folder.path());
  std::vector<std::string> names;
  for (const std::filesystem::path& file : ExportedFiles(map)) names.push_back(file.string());
  std::sort(names.begin(), names.end());
  EXPECT_EQ(names, FilesBelow(folder.path()));
}

/// What is said of the files that could not be written.
ExportError FailureOf(const BuildingMap& map, const ExportOptions& options,
                      const std::filesystem::path& folder) {
  try {
    WriteMap(map, {}, options, folder);
  } catch (const ExportError& error) {
    return error;
  }
  ADD_FAILURE() << "all could be written";
  return {"", false};
}

// 32768 cells to each side is all that an octree has.
TEST(MapExport, AnOctreeThatIsTooLargeHoldsUpNothingElse) {
  BuildingMap map = SampleMap();
  for (TrajectoryPose& pose : map.trajectory) pose.T_world_robot.x += 2000.0;
  const TestFolder folder;
  const ExportError error = FailureOf(map, {}, folder.path());
  EXPECT_TRUE(error.is_too_large);
  EXPECT_NE(std::string(error.what()).find("building.bt could not be written: the map reaches"),
            std::string::npos)
      << error.what();
  const std::vector<std::string> written = FilesBelow(folder.path());
  EXPECT_EQ(written.size() + 1, ExportedFiles(map).size());
  EXPECT_EQ(std::count(written.begin(), written.end(), "building.bt"), 0);
  EXPECT_NE(ReadBytes(folder / "summary.json").find("building.bt could not be written"),
            std::string::npos);
}

TEST(MapExport, AFloorThatIsTooLargeIsNotDrawnAndTheBuildingIsNoPartOfItself) {
  BuildingMap map = SampleMap();
  // Two scans so far from each other that no grid holds both.
  for (const KeptScan& kept : {map.kept_scans.front(), map.kept_scans.back()}) {
    TrajectoryPose& pose = map.trajectory[kept.trajectory_index];
    pose.floor = 0;
    pose.in_transit = false;
    pose.T_world_robot = {kept.trajectory_index == 0 ? -9000.0 : 9000.0,
                          kept.trajectory_index == 0 ? -9000.0 : 9000.0, 0.0};
  }
  const TestFolder folder;
  const ExportError error = FailureOf(map, {}, folder.path());
  EXPECT_TRUE(error.is_too_large);
  const std::vector<std::string> written = FilesBelow(folder.path());
  const auto is_there = [&](const std::string& name) {
    return std::count(written.begin(), written.end(), name) > 0;
  };
  for (const char* name : {"building.bt", "building.pcd", "building.ply", "floors/0.pcd",
                           "floors/0.pgm", "floors/0.yaml"}) {
    EXPECT_FALSE(is_there(name)) << name;
  }
  for (const char* name : {"trajectory.tum", "closures.csv", "floors/0.g2o", "floors/-1.pcd",
                           "summary.json", "report.html"}) {
    EXPECT_TRUE(is_there(name)) << name;
  }
}

TEST(MapExport, FolderThatIsNotThereIsAnError) {
  const TestFolder folder;
  EXPECT_THROW(WriteMap(SampleMap(), {}, {}, folder / "missing"), std::runtime_error);
}

}  // namespace
}  // namespace masked_mapper
