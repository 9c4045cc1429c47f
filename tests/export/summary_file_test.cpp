// SPDX-License-Identifier: BSD-3-Clause
#include "masked_mapper/export/summary_file.hpp"

#include <gtest/gtest.h>

#include <limits>
#include <nlohmann/json.hpp>

#include "export/sample_map.hpp"

namespace masked_mapper {
namespace {

using Json = nlohmann::ordered_json;

Summary SampleSummary() {
  const RunDescription run{"logs/a.clf.gz",
                           "openings",
                           {{"matching.min_score", 0.425},
                            {"threads", std::int64_t{2}},
                            {"quiet", true},
                            {"motion.source", std::string("fused")}}};
  OccupancyGrid grid;
  grid.width = 2;
  grid.height = 1;
  grid.cells = {Cell::kFree, Cell::kUnknown};
  return Summarise(SampleMap(), run, {grid, OccupancyGrid()});
}

Json Written(const Summary& summary) {
  const TestFolder folder;
  WriteSummary(summary, folder / "summary.json");
  return Json::parse(ReadBytes(folder / "summary.json"));
}

std::vector<std::string> Keys(const Json& json) {
  std::vector<std::string> keys;
  for (const auto& item : json.items()) keys.push_back(item.key());
  return keys;
}

TEST(SummaryFile, HasTheKeysOfTheContract) {
  const Json json = Written(SampleSummary());
  using Names = std::vector<std::string>;
  EXPECT_EQ(Keys(json),
            (Names{"log", "mask", "motion_source", "counts", "floors", "transits", "seconds",
                   "peak_memory_mib", "options", "doubts", "warnings", "sensors"}));
  EXPECT_EQ(Keys(json["counts"]), (Names{"observations", "scans", "nodes", "scan_nodes",
                                         "odometry_nodes", "attempted", "matched", "validated"}));
  EXPECT_EQ(Keys(json["floors"][0]), (Names{"label", "elevation_m", "elevation_measured", "nodes",
                                            "area_m2", "parallel_parts"}));
  EXPECT_EQ(Keys(json["seconds"]),
            (Names{"read", "motion", "mask", "projection", "matching", "validation", "optimisation",
                   "rendering", "export", "total"}));
}

TEST(SummaryFile, TransitsNameTheFloorsOfThePosesAround) {
  BuildingMap map = SampleMap();
  const double first = map.trajectory.front().stamp;
  const double last = map.trajectory.back().stamp;
  map.transits.push_back({first, last, 3.8, 0.1, {"pressure", "acceleration"}, ""});
  const OccupancyGrid grid;
  const Json json = Written(Summarise(map, {"a.log", "always", {}}, {grid, grid}));
  ASSERT_EQ(json["transits"].size(), 1U);
  const Json& transit = json["transits"][0];
  EXPECT_EQ(transit["t_out"], first);
  EXPECT_EQ(transit["t_in"], last);
  const auto label_of = [&](const TrajectoryPose& pose) {
    return map.graph.floors()[static_cast<std::size_t>(pose.floor)].label;
  };
  EXPECT_EQ(transit["from"], label_of(map.trajectory.front()));
  EXPECT_EQ(transit["to"], label_of(map.trajectory.back()));
  EXPECT_EQ(transit["height_m"], 3.8);
  EXPECT_EQ(transit["sigma_m"], 0.1);
  EXPECT_EQ(transit["by"], (std::vector<std::string>{"pressure", "acceleration"}));
}

TEST(SummaryFile, CountsAddUp) {
  const Json json = Written(SampleSummary());
  const Json& counts = json["counts"];
  EXPECT_EQ(counts["observations"], 31);
  EXPECT_EQ(counts["scans"], 8);
  EXPECT_EQ(counts["nodes"], 4);
  EXPECT_EQ(counts["scan_nodes"], 3);
  EXPECT_EQ(counts["odometry_nodes"], 1);
  EXPECT_EQ(counts["attempted"], 5);
  EXPECT_EQ(counts["matched"], 3);
  EXPECT_EQ(counts["validated"], 1);
  EXPECT_EQ(json["floors"][0]["label"], "0");
  EXPECT_EQ(json["floors"][0]["nodes"], 3);
  EXPECT_NEAR(json["floors"][0]["area_m2"].get<double>(), 0.0025, 0.01);
  EXPECT_EQ(json["floors"][1]["label"], "-1");
  EXPECT_EQ(json["floors"][1]["elevation_m"], -3.5);
  EXPECT_EQ(json["floors"][1]["elevation_measured"], false);
  EXPECT_EQ(json["seconds"]["read"], 0.5);
  EXPECT_GT(json["peak_memory_mib"].get<double>(), 1.0);
}

TEST(SummaryFile, TotalIsTheSumOfTheStagesUnlessMeasured) {
  BuildingMap map = SampleMap();
  EXPECT_EQ(Summarise(map, {}, {{}, {}}).seconds.total, 1.25);
  map.seconds = {};
  map.seconds.read = 0.5;
  map.seconds.matching = 0.25;
  EXPECT_EQ(Summarise(map, {}, {{}, {}}).seconds.total, 0.75);
}

TEST(SummaryFile, SaysWhichMotionWasUsed) {
  BuildingMap map = SampleMap();
  map.motion_source = MotionSource::kScans;
  EXPECT_EQ(Written(Summarise(map, {}, {{}, {}}))["motion_source"], "scans");
}

TEST(SummaryFile, OptionsKeepTheirKinds) {
  const Json options = Written(SampleSummary())["options"];
  EXPECT_EQ(options["matching.min_score"], 0.425);
  EXPECT_TRUE(options["threads"].is_number_integer());
  EXPECT_EQ(options["quiet"], true);
  EXPECT_EQ(options["motion.source"], "fused");
}

TEST(SummaryFile, NumbersAreFiniteAndTextIsUtf8) {
  Summary summary = SampleSummary();
  summary.floors[0].elevation_m = std::numeric_limits<double>::quiet_NaN();
  summary.seconds.total = std::numeric_limits<double>::infinity();
  summary.run.log = "caf\xe9.log";
  summary.run.settings.emplace_back("x", std::numeric_limits<double>::infinity());
  const Json json = Written(summary);
  EXPECT_TRUE(json["floors"][0]["elevation_m"].is_number());
  EXPECT_TRUE(json["seconds"]["total"].is_number());
  EXPECT_TRUE(json["options"]["x"].is_number() || json["options"]["x"].is_string());
}

TEST(SummaryFile, RejectionsByFrequency) {
  const Summary summary = SampleSummary();
  ASSERT_EQ(summary.rejections.size(), 3U);
  EXPECT_EQ(summary.rejections[0].first, "score below the minimum");
  EXPECT_EQ(summary.rejections[0].second, 2U);
}

TEST(SummaryFile, EmptyMap) {
  const Json json = Written(Summarise({}, {}, {}));
  EXPECT_TRUE(json["floors"].is_array());
  EXPECT_TRUE(json["options"].is_object());
  EXPECT_TRUE(json["warnings"].is_array());
}

}  // namespace
}  // namespace masked_mapper
