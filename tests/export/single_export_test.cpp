// SPDX-License-Identifier: BSD-3-Clause
#include "masked_mapper/export/map_export.hpp"

#include <gtest/gtest.h>

#include <map>
#include <nlohmann/json.hpp>

#include "export/sample_map.hpp"
#include "masked_mapper/text/input_error.hpp"

namespace masked_mapper {
namespace {

TEST(SingleExport, SameBytesAsInTheFolderOfTheMap) {
  const TestFolder folder;
  const BuildingMap map = SampleMap();
  WriteMap(map, {}, {}, folder.path());
  std::filesystem::create_directory(folder / "single");
  const struct {
    ExportFormat format;
    std::optional<FloorId> floor;
    const char* of_map;
    const char* name;
  } all[] = {
      {ExportFormat::kOctomap, {}, "building.bt", "a.bt"},
      {ExportFormat::kPcd, {}, "building.pcd", "a.pcd"},
      {ExportFormat::kPly, {}, "building.ply", "a.ply"},
      {ExportFormat::kTum, {}, "trajectory.tum", "a.tum"},
      {ExportFormat::kG2o, {}, "graph.g2o", "a.g2o"},
      {ExportFormat::kPcd, 1, "floors/-1.pcd", "b.pcd"},
      {ExportFormat::kG2o, 1, "floors/-1.g2o", "b.g2o"},
      {ExportFormat::kGrid, 1, "floors/-1.pgm", "-1.pgm"},
      {ExportFormat::kGrid, 0, "floors/0.yaml", "0.yaml"},
  };
  for (const auto& one : all) {
    const std::filesystem::path path = folder / (std::string("single/") + one.name);
    WriteSingleExport(map, {}, {one.format, one.floor, {}}, path);
    EXPECT_EQ(ReadBytes(path), ReadBytes(folder / one.of_map)) << one.of_map;
  }
  EXPECT_TRUE(std::filesystem::exists(folder / "single/-1.yaml"));
  EXPECT_TRUE(std::filesystem::exists(folder / "single/0.pgm"));
}

TEST(SingleExport, AFloorHasItsPosesAlone) {
  const TestFolder folder;
  WriteSingleExport(SampleMap(), {}, {ExportFormat::kTum, 1, {}}, folder / "a.tum");
  EXPECT_EQ(Split(ReadBytes(folder / "a.tum"), '\n').size(), 2U);
}

/// A room with a place and a kept-out corner as a plan of lines.
TEST(SingleExport, PlansAreLinesInMetres) {
  const TestFolder folder;
  BuildingMap map = SampleMap();
  if (map.drives.empty()) map.drives.push_back({});
  map.places.push_back({"dock", 1, {1.0, 2.0}});
  map.areas.push_back({AreaKind::kKeepOut, 0, {{0, 0}, {1, 0}, {0, 1}}});
  WriteSingleExport(map, {}, {ExportFormat::kGeojson, {}, {}}, folder / "a.geojson");
  const auto plan = nlohmann::json::parse(ReadBytes(folder / "a.geojson"));
  std::map<std::string, int> kinds;
  for (const auto& feature : plan.at("features")) {
    ++kinds[feature.at("properties").at("kind")];
    const std::string floor = feature.at("properties").at("floor");
    EXPECT_TRUE(floor == "0" || floor == "-1");
    if (feature["properties"]["kind"] == "place") {
      EXPECT_EQ(feature["geometry"]["coordinates"], nlohmann::json({1.0, 2.0}));
      EXPECT_EQ(floor, "-1");
    }
    if (feature["properties"]["kind"] == "keep_out") {
      EXPECT_EQ(feature["geometry"]["coordinates"][0].size(), 4U) << "closed";
    }
  }
  EXPECT_GT(kinds["wall"], 3);
  EXPECT_EQ(kinds["place"], 1);
  EXPECT_EQ(kinds["keep_out"], 1);
  EXPECT_EQ(kinds["elevator"], 2);

  WriteSingleExport(map, {}, {ExportFormat::kSvg, 1, {}}, folder / "a.svg");
  const std::string svg = ReadBytes(folder / "a.svg");
  EXPECT_EQ(svg.rfind("<svg xmlns=\"http://www.w3.org/2000/svg\"", 0), 0U);
  EXPECT_NE(svg.find("<g id=\"floor_-1\""), std::string::npos);
  EXPECT_EQ(svg.find("<g id=\"floor_0\""), std::string::npos);
  EXPECT_NE(svg.find("<title>dock</title>"), std::string::npos);
}

TEST(SingleExport, HeightsLeaveOutFloors) {
  const TestFolder folder;
  const BuildingMap map = SampleMap();
  WriteSingleExport(map, {}, {ExportFormat::kPcd, {}, {-1.0, 9.0}}, folder / "upper.pcd");
  WriteSingleExport(map, {}, {ExportFormat::kPcd, 0, {}}, folder / "ground.pcd");
  EXPECT_EQ(ReadBytes(folder / "upper.pcd"), ReadBytes(folder / "ground.pcd"));
  WriteSingleExport(map, {}, {ExportFormat::kPcd, {}, {5.0, 9.0}}, folder / "none.pcd");
  EXPECT_NE(ReadBytes(folder / "none.pcd").find("POINTS 0"), std::string::npos);
}

TEST(SingleExport, SaysWhatCannotBe) {
  const std::vector<Floor> floors = SampleMap().graph.floors();
  EXPECT_THROW(CheckSingleExport({ExportFormat::kGrid, {}, {}}, floors), InputError);
  EXPECT_NO_THROW(CheckSingleExport({ExportFormat::kGrid, 1, {}}, floors));
  EXPECT_THROW(CheckSingleExport({ExportFormat::kTum, {}, {0.0, 1.0}}, floors), InputError);
  EXPECT_THROW(CheckSingleExport({ExportFormat::kPcd, {}, {1.0, 0.0}}, floors), InputError);
  EXPECT_EQ(FloorOfLabel(floors, "-1"), 1);
  try {
    FloorOfLabel(floors, "7");
    FAIL();
  } catch (const InputError& error) {
    EXPECT_NE(std::string(error.what()).find("0, -1"), std::string::npos) << error.what();
  }
}

}  // namespace
}  // namespace masked_mapper
