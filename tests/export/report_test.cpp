// SPDX-License-Identifier: BSD-3-Clause
#include "export/report.hpp"

#include <gtest/gtest.h>

#include <cstring>
#include <nlohmann/json.hpp>
#include <regex>

#include "export/sample_map.hpp"
#include "masked_mapper/export/map_export.hpp"
#include "masked_mapper/log/packed_cloud.hpp"

namespace masked_mapper {
namespace {

using Json = nlohmann::ordered_json;

std::string PageOf(const BuildingMap& map, const RunDescription& run) {
  const std::vector<OccupancyGrid> grids = RenderFloors(map, {});
  return ReportPage(ReportData(map, grids, 30.0), Summarise(map, run, grids));
}

Json DataOf(const BuildingMap& map) {
  return Json::parse(ReportData(map, RenderFloors(map, {}), 30.0));
}

std::size_t CountOf(const std::string& text, const std::string& part) {
  std::size_t count = 0;
  for (std::size_t at = text.find(part); at != std::string::npos; at = text.find(part, at + 1)) {
    ++count;
  }
  return count;
}

const std::string kDataStart = R"(<script type="application/json" id="report-data">)";

/// What a browser hands to the page's script: all up to the first end tag.
std::string EmbeddedData(const std::string& page) {
  const std::size_t start = page.find(kDataStart) + kDataStart.size();
  return page.substr(start, page.find("</script", start) - start);
}

template <typename T>
std::vector<T> Column(const Json& table, const std::string& name) {
  const auto text = table.at(name).get<std::string>();
  static const std::string kDigits =
      "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string bits;
  for (const char character : text) {
    if (character == '=') break;
    for (std::size_t bit = 6; bit-- > 0;) bits += (kDigits.find(character) >> bit & 1U) ? '1' : '0';
  }
  std::string bytes;
  for (std::size_t i = 0; i + 8 <= bits.size(); i += 8) {
    bytes += static_cast<char>(std::stoi(bits.substr(i, 8), nullptr, 2));
  }
  std::vector<T> column(bytes.size() / sizeof(T));
  std::memcpy(column.data(), bytes.data(), column.size() * sizeof(T));
  return column;
}

TEST(Report, IsOnePageThatAsksForNothing) {
  const std::string page = PageOf(SampleMap(), {"a.log", "openings", {}});
  EXPECT_EQ(page.rfind("<!DOCTYPE html>", 0), 0U);
  EXPECT_EQ(CountOf(page, kDataStart), 1U);
  EXPECT_EQ(page.find("@REPORT_DATA@"), std::string::npos);
  EXPECT_NE(page.find("default-src 'none'"), std::string::npos);
  EXPECT_NE(page.find("MIT License"), std::string::npos) << "licences of the packages";
  EXPECT_FALSE(std::regex_search(page.substr(0, page.find(kDataStart)),
                                 std::regex(R"((src|href)\s*=\s*["'](?!data:))")));
}

/// A slab of points from one height to another, about the robot.
std::shared_ptr<const std::string> Slab(float side, float low, float high) {
  LevelledCloud cloud;
  CloudPoint point;
  for (float x = -side; x < side; x += 0.04F) {
    for (float y = -side; y < side; y += 0.04F) {
      for (float z = low; z <= high; z += 0.1F) {
        point.position = {x, y, z};
        cloud.points.push_back(point);
      }
    }
  }
  return std::make_shared<const std::string>(PackCloud(cloud));
}

TEST(Report, PointsOfSpaceAreAboveTheirFloors) {
  BuildingMap map = SampleMap();
  EXPECT_EQ(DataOf(map).count("space"), 0U);
  map.kept_clouds = {{0, Slab(1.0F, 0.5F, 1.0F)}, {7, Slab(1.0F, 0.5F, 1.0F)}};
  const Json data = DataOf(map);
  const Json& floors = data.at("space").at("floors");
  ASSERT_EQ(floors.size(), 2U);
  for (const Json& floor : floors) {
    const auto xyz = Column<std::uint16_t>(floor, "xyz_u16");
    ASSERT_EQ(xyz.size(), 3 * floor.at("count").get<std::size_t>());
    ASSERT_FALSE(xyz.empty());
    for (std::size_t i = 2; i < xyz.size(); i += 3) {
      const double z =
          floor.at("origin")[2].get<double>() + xyz[i] * floor.at("step_m").get<double>();
      EXPECT_GT(z, 0.4);  // whatever the floor's elevation
      EXPECT_LT(z, 1.1);
    }
  }
}

TEST(Report, ManyPointsOfSpaceAreThinned) {
  BuildingMap map = SampleMap();
  map.kept_clouds = {{0, Slab(10.0F, 0.2F, 1.4F)}, {6, Slab(10.0F, 0.2F, 1.4F)}};
  const std::string data = ReportData(map, RenderFloors(map, {}), 30.0);
  EXPECT_LT(data.size(), 6000000U);
  const Json space = Json::parse(data).at("space");
  EXPECT_GT(space.at("voxel_m"), 0.1);
  EXPECT_GT(space.at("floors")[0].at("count"), 100000);
}

TEST(Report, NastyTextsStayTexts) {
  BuildingMap map = SampleMap();
  const std::string nasty = "</script><script>alert(1)</script><!-- <b>\xE2\x80\xA8 $& \\ \" '";
  map.warnings = {nasty, "caf\xe9 is no UTF-8"};
  const std::string page =
      PageOf(map, {"logs/" + nasty, nasty, {{"key", nasty}, {"@REPORT_DATA@", true}}});
  const Json data = Json::parse(EmbeddedData(page));
  EXPECT_EQ(data["summary"]["warnings"][0], nasty);
  EXPECT_EQ(data["summary"]["log"], "logs/" + nasty);
  EXPECT_EQ(data["summary"]["mask"], nasty);
  EXPECT_EQ(data["summary"]["options"]["key"], nasty);
  EXPECT_EQ(EmbeddedData(page).find('<'), std::string::npos);
  EXPECT_EQ(CountOf(page, "</script>"),
            CountOf(PageOf(SampleMap(), {"a.log", "openings", {}}), "</script>"));
}

TEST(Report, OnlySecondsAndMemoryDependOnTheRun) {
  const BuildingMap map = SampleMap();
  const std::vector<OccupancyGrid> grids = RenderFloors(map, {});
  GridOptions two_threads;
  two_threads.threads = 2;
  EXPECT_EQ(ReportData(map, grids, 30.0), ReportData(map, RenderFloors(map, two_threads), 30.0));

  Summary summary = Summarise(map, {}, grids);
  const std::string data = ReportData(map, grids, 30.0);
  Json one = Json::parse(EmbeddedData(ReportPage(data, summary)));
  summary.seconds.total += 1.0;
  summary.seconds.matching += 1.0;
  summary.peak_memory_mib += 1.0;
  Json two = Json::parse(EmbeddedData(ReportPage(data, summary)));
  EXPECT_NE(one, two);
  for (Json* json : {&one, &two}) {
    (*json)["summary"].erase("seconds");
    (*json)["summary"].erase("peak_memory_mib");
  }
  EXPECT_EQ(one, two);
}

TEST(Report, WallsAreWhereTheGridHasThem) {
  const BuildingMap map = SampleMap();
  const std::vector<OccupancyGrid> grids = RenderFloors(map, {});
  const Json floors = DataOf(map)["floors"];
  ASSERT_EQ(floors.size(), 2U);
  EXPECT_EQ(floors[1]["label"], "-1");
  EXPECT_EQ(floors[1]["elevation_m"], -3.5);
  for (std::size_t i = 0; i < grids.size(); ++i) {
    const Json& walls = floors[i]["walls"];
    const auto xy = Column<std::uint16_t>(walls, "xy_u16");
    ASSERT_EQ(xy.size(), 2 * grids[i].walls.size());
    for (std::size_t k = 0; k < grids[i].walls.size(); ++k) {
      const double step = walls["step_m"];
      EXPECT_NEAR(walls["origin"][0].get<double>() + xy[2 * k] * step, grids[i].walls[k].x, 0.001);
      EXPECT_NEAR(walls["origin"][1].get<double>() + xy[2 * k + 1] * step, grids[i].walls[k].y,
                  0.001);
    }
  }
}

TEST(Report, FreeSpaceIsTheGrids) {
  const BuildingMap map = SampleMap();
  const OccupancyGrid grid = RenderFloors(map, {})[0];
  const Json free = DataOf(map)["floors"][0]["free"];
  ASSERT_EQ(free["width"], grid.width);
  ASSERT_EQ(free["height"], grid.height);
  const auto bits = Column<std::uint8_t>(free, "bits");
  const auto row_bytes = static_cast<std::size_t>((grid.width + 7) / 8);
  for (int row = 0; row < grid.height; ++row) {
    for (int column = 0; column < grid.width; ++column) {
      const unsigned byte =
          bits[static_cast<std::size_t>(row) * row_bytes + static_cast<std::size_t>(column / 8)];
      ASSERT_EQ((byte >> (column % 8) & 1U) != 0, grid.at(column, row) == Cell::kFree)
          << column << ", " << row;
    }
  }
}

/// The motion path has an origin of its own; drawn, both maps start at one place.
TEST(Report, BeforeStartsWhereAfterDoes) {
  BuildingMap map = SampleMap();
  const Json plain = DataOf(map)["nodes"];
  const Pose2 T_new_old{40.0, -7.0, 2.0};
  PoseGraph moved;
  for (const Floor& floor : map.graph.floors()) moved.AddFloor(floor);
  for (Node node : map.graph.nodes()) {
    node.T_odom_robot = T_new_old * node.T_odom_robot;
    moved.AddNode(node);
  }
  map.graph = moved;
  for (TrajectoryPose& pose : map.trajectory) pose.T_odom_robot = T_new_old * pose.T_odom_robot;
  const Json data = DataOf(map);
  for (const char* table : {"nodes", "trajectory"}) {
    const auto before = Column<float>(data[table], "before_f32");
    const auto after = Column<float>(data[table], "after_f32");
    ASSERT_EQ(before.size(), after.size());
    for (std::size_t i = 0; i < 3; ++i) EXPECT_NEAR(before[i], after[i], 1e-4) << table;
  }
  const auto expected = Column<float>(plain, "before_f32");
  const auto actual = Column<float>(data["nodes"], "before_f32");
  for (std::size_t i = 0; i < expected.size(); ++i) EXPECT_NEAR(actual[i], expected[i], 1e-4);
}

/// A scan's points, placed at its pose, are the walls of the room of 6 m.
TEST(Report, ScansLieOnTheWalls) {
  const Json scans = DataOf(SampleMap())["scans"];
  const auto points = Column<std::uint32_t>(scans, "points_u32");
  const auto xy = Column<std::int16_t>(scans, "xy_i16");
  ASSERT_EQ(points.size(), 7U) << "of eight scans, one is in transit";
  EXPECT_EQ(Column<std::uint16_t>(scans, "floor_u16"),
            (std::vector<std::uint16_t>{0, 0, 0, 0, 0, 1, 1}));
  const double step = scans["step_m"];
  std::size_t total = 0;
  for (const std::uint32_t count : points) total += count;
  ASSERT_EQ(xy.size(), 2 * total);
  EXPECT_EQ(total, 7U * 360U);
  for (std::size_t i = 0; i < total; ++i) {
    EXPECT_NEAR(std::max(std::abs(xy[2 * i]), std::abs(xy[2 * i + 1])) * step, 2.98, 0.002);
  }
}

TEST(Report, ErrorOfAClosureIsWhatTheMapLeaves) {
  BuildingMap map = SampleMap();
  // The map moves the newer node 0.3 m ahead and turns it by 2 degrees.
  const Pose2 match = Inverse(map.closures[0].T_older_newer.mean);
  const Pose2 T_world_b = map.graph.nodes()[0].T_world_robot;
  map.graph.SetPose(1, T_world_b * Inverse(match * Pose2{0.3, 0.0, DegToRad(2.0)}));
  const auto quality = Column<float>(DataOf(map)["attempts"], "quality_f32");
  ASSERT_EQ(quality.size(), 5 * map.closures.size());
  EXPECT_NEAR(quality[0], 0.625, 1e-6);
  EXPECT_NEAR(quality[3], 0.3, 1e-5);
  EXPECT_NEAR(RadToDeg(static_cast<double>(quality[4])), 2.0, 1e-4);
}

TEST(Report, EmptyMapIsAPage) {
  const Json data = Json::parse(EmbeddedData(PageOf({}, {})));
  EXPECT_TRUE(data["map"]["floors"].empty());
  EXPECT_EQ(data["map"]["nodes"]["count"], 0);
}

}  // namespace
}  // namespace masked_mapper
