// SPDX-License-Identifier: BSD-3-Clause
#include "masked_mapper/export/map_export.hpp"

#include <gtest/gtest.h>

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
  MappingResult map = SampleMap();
  for (TrajectoryPose& pose : map.trajectory) {
    if (pose.in_transit) pose.T_world_robot = {100.0, 100.0, 0.0};
  }
  for (const OccupancyGrid& grid : RenderFloors(map, {})) {
    EXPECT_LT(KnownArea(grid), 80.0);
    EXPECT_LT(grid.width, 300);
  }
}

TEST(MapExport, FloorWithoutScansHasItsFiles) {
  MappingResult map = SampleMap();
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
  MappingResult map = SampleMap();
  map.graph.AddFloor({"../outside"});
  const TestFolder folder;
  EXPECT_THROW(WriteMap(map, {}, {}, folder.path()), InputError);
  EXPECT_TRUE(FilesBelow(folder.path()).empty());
}

TEST(MapExport, FolderThatIsNotThereIsAnError) {
  const TestFolder folder;
  EXPECT_THROW(WriteMap(SampleMap(), {}, {}, folder / "missing"), std::runtime_error);
}

}  // namespace
}  // namespace masked_mapper
