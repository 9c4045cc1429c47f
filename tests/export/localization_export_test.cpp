// SPDX-License-Identifier: BSD-3-Clause
#include "masked_mapper/export/localization_export.hpp"

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <sstream>

namespace masked_mapper {
namespace {

namespace fs = std::filesystem;

BuildingMap OneFloor() {
  BuildingMap map;
  map.graph.AddFloor({"2", 3.5, 0.1, true, true});
  return map;
}

std::string TextOf(const fs::path& path) {
  std::ostringstream text;
  text << std::ifstream(path).rdbuf();
  return text.str();
}

Localization TwoScans() {
  Localization drive;
  LocatedScan unsure;
  unsure.stamp = unsure.log_stamp = 10.0;
  LocatedScan sure = unsure;
  sure.stamp = sure.log_stamp = 10.5;
  sure.sure = sure.placed = true;
  sure.T_world_robot.mean = {1.0, 2.0, 0.0};
  drive.scans = {unsure, sure};
  drive.found = true;
  drive.found_after_m = 7.5;
  drive.unsure_spans = {{10.0, 10.0, "not found yet"}};
  return drive;
}

TEST(LocalizationExport, WritesPlacedScansAndWhatWasSure) {
  const fs::path folder = fs::path(testing::TempDir()) / "localization_export";
  fs::create_directories(folder);
  const BuildingMap map = OneFloor();
  WriteLocalization(map, TwoScans(), {}, {{"a.log"}, "out", 0.0, {}, {}}, folder);
  EXPECT_EQ(TextOf(folder / "trajectory.tum"),
            "10.5 1.000000 2.000000 3.500000 0 0 0.000000000 1.000000000\n");
  EXPECT_EQ(TextOf(folder / "floors.csv"), "t,label\n10,?\n10.5,2\n");
  EXPECT_NE(TextOf(folder / "page.html").find("Floor 2"), std::string::npos);
  const auto summary = nlohmann::json::parse(TextOf(folder / "summary.json"));
  EXPECT_TRUE(summary.at("found"));
  EXPECT_EQ(summary.at("found_after_m"), 7.5);
  EXPECT_EQ(summary.at("scans"), 2);
  EXPECT_EQ(summary.at("placed"), 1);
  EXPECT_EQ(summary.at("floors"), nlohmann::json({"2"}));
  EXPECT_EQ(summary.at("unsure_spans").size(), 1U);
  EXPECT_TRUE(summary.at("doubt").is_null());
  fs::remove_all(folder);
}

TEST(LocalizationExport, NotFoundIsAnAnswer) {
  Localization drive;
  drive.scans.resize(1);
  const auto summary = nlohmann::json::parse(LocalizationSummaryText(
      OneFloor(), drive, {}, {{"a.log"}, "out", 0.0, {}, "3 places come into question"}));
  EXPECT_FALSE(summary.at("found"));
  EXPECT_TRUE(summary.at("found_after_m").is_null());
  EXPECT_EQ(summary.at("doubt"), "3 places come into question");
}

TEST(LocalizationExport, APoseIsOneLine) {
  const Localization drive = TwoScans();
  const auto unsure = nlohmann::json::parse(PoseLine(OneFloor(), drive.scans[0]));
  EXPECT_FALSE(unsure.at("sure"));
  EXPECT_TRUE(unsure.at("floor").is_null());
  const std::string line = PoseLine(OneFloor(), drive.scans[1]);
  EXPECT_EQ(line.find('\n'), std::string::npos);
  const auto sure = nlohmann::json::parse(line);
  EXPECT_EQ(sure.at("floor"), "2");
  EXPECT_EQ(sure.at("x"), 1.0);
}

}  // namespace
}  // namespace masked_mapper
