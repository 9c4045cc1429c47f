// SPDX-License-Identifier: BSD-3-Clause
#include "masked_mapper/map_file/saved_map.hpp"

#include <gtest/gtest.h>

#include <random>

#include "export/sample_map.hpp"
#include "map_file/database.hpp"
#include "map_file/schema.hpp"
#include "mapping/same_map.hpp"
#include "masked_mapper/options/option_table.hpp"
#include "masked_mapper/text/input_error.hpp"

namespace masked_mapper {
namespace {

namespace fs = std::filesystem;

/// Values that are easily lost on the way: zeros with a sign, what is not finite, odd bytes.
BuildingMap AwkwardMap() {
  BuildingMap map = SampleMap();
  LaserScan& scan = map.kept_scans[1].scan;
  scan.ranges = {1.5F, kNoReturn, kInvalidRange, 1e-38F};
  scan.T_odom_robot = Pose2{-0.0, 1e-300, 3.0};
  map.kept_scans[2].scan.ranges.clear();
  map.trajectory[3].T_world_robot = {-0.0, 0.1, -0.2};
  map.trajectory[3].stamp = 0.1 + 0.2;
  map.trajectory[3].log_stamp = 0.25;
  map.motion_source = MotionSource::kScans;
  map.log.first_bad_line = std::string("line 3: \xff\0 odd", 14);
  map.log.truncated = true;
  map.log.other_messages = {{"NEWDATA", 3}, {"SYNC", 7}};
  map.log.max_range = 0.1;
  map.warnings.emplace_back("");
  map.places = {{"dock", 1, {-0.0, 0.1 + 0.2}}, {"b", 0, {5.0, 1e-300}}};
  map.areas = {{AreaKind::kKeepOut, 1, {{0.0, 0.0}, {1.0, -0.0}, {0.1, 1.0}}},
               {AreaKind::kErased, 0, {{3.0, 0.0}, {4.0, 0.0}, {4.0, 1.0}, {3.0, 1.0}}}};
  return map;
}

std::string Refusal(const fs::path& path) {
  try {
    ReadMapFile(path);
  } catch (const InputError& error) {
    EXPECT_EQ(std::string(error.what()).find('\n'), std::string::npos) << error.what();
    EXPECT_EQ(std::string(error.what()).rfind(path.string(), 0), 0U) << error.what();
    return error.what();
  }
  return "";
}

TEST(MapFileReader, GivesBackWhatWasWritten) {
  const TestFolder folder;
  MapOrigin origin{"a drive's \"log\"?%41#.gz", "any(openings,eccentricity)", {}};
  SetOption("test", "matcher.min_score", "0.3", origin.options);
  SetOption("test", "motion.source", "scans", origin.options);
  SetOption("test", "log.scan_topic", "/scan", origin.options);
  const BuildingMap map = AwkwardMap();
  WriteMapFile(origin, map, folder / "odd name?%41#.mmap");
  const SavedMap read = ReadMapFile(folder / "odd name?%41#.mmap");
  EXPECT_TRUE(SameMap(map, read.result));
  EXPECT_EQ(read.origin.log, origin.log);
  EXPECT_EQ(read.origin.mask, origin.mask);
  EXPECT_EQ(OptionValues(read.origin.options), OptionValues(origin.options));
}

/// With clouds at two of its poses.
BuildingMap MapWithClouds() {
  BuildingMap map = SampleMap();
  map.kept_clouds = {{1, std::make_shared<const std::string>(std::string("\0 one", 5))},
                     {4, std::make_shared<const std::string>("another")}};
  return map;
}

TEST(MapFileReader, KeepsCloudsAndWithoutAnyIsOfTheVersionBefore) {
  const TestFolder folder;
  const auto version = [](const fs::path& path) {
    return Database(path, OpenMode::kRead).Number("PRAGMA user_version");
  };
  WriteMapFile({}, SampleMap(), folder / "without.mmap");
  EXPECT_EQ(version(folder / "without.mmap"), 4);
  EXPECT_TRUE(ReadMapFile(folder / "without.mmap").result.kept_clouds.empty());
  const BuildingMap map = MapWithClouds();
  WriteMapFile({}, map, folder / "with.mmap");
  EXPECT_EQ(version(folder / "with.mmap"), 5);
  EXPECT_TRUE(SameMap(map, ReadMapFile(folder / "with.mmap").result));
}

TEST(MapFileReader, KeepsEdgesThatTellATurnAlone) {
  const TestFolder folder;
  BuildingMap map = SampleMap();
  Edge tie{0, 1, {{0.0, 0.0, 0.25}, Eigen::Matrix3d::Identity()}, EdgeKind::kHeading};
  map.graph.AddEdge(tie);
  WriteMapFile({}, map, folder / "a.mmap");
  EXPECT_EQ(Database(folder / "a.mmap", OpenMode::kRead).Number("PRAGMA user_version"), 6);
  const BuildingMap read = ReadMapFile(folder / "a.mmap").result;
  EXPECT_TRUE(SameMap(map, read));
  EXPECT_EQ(read.graph.edges().back().kind, EdgeKind::kHeading);
}

TEST(MapFileReader, AMapOfNothingIsAMap) {
  const TestFolder folder;
  WriteMapFile({}, {}, folder / "a.mmap");
  EXPECT_TRUE(SameMap(ReadMapFile(folder / "a.mmap").result, {}));
}

TEST(MapFileReader, RefusesWhatIsNoMap) {
  const TestFolder folder;
  const auto refused = [&](const std::string& part, const fs::path& path) {
    EXPECT_NE(Refusal(path).find(part), std::string::npos) << Refusal(path);
  };
  refused("no such file", folder / "missing");
  refused("not a file", folder.path());
  std::ofstream(folder / "empty").flush();
  refused("not a saved map", folder / "empty");
  std::ofstream(folder / "text") << "FLASER 3 1 2 3 and so on and on and on";
  refused("not a saved map", folder / "text");
  {
    Database other(folder / "other", OpenMode::kWrite);
    other.Run("CREATE TABLE t(a)");
  }
  refused("another database", folder / "other");
}

TEST(MapFileReader, RefusesANewerVersion) {
  const TestFolder folder;
  WriteMapFile({}, SampleMap(), folder / "a.mmap");
  Database(folder / "a.mmap", OpenMode::kWrite).Run("PRAGMA user_version = 99");
  EXPECT_NE(Refusal(folder / "a.mmap").find("newer"), std::string::npos);
}

// A damaged file is either read rightly (the damage fell where nothing is kept) or refused.
TEST(MapFileReader, DamageIsNoticed) {
  const TestFolder folder;
  const BuildingMap map = AwkwardMap();
  WriteMapFile({}, map, folder / "a.mmap");
  const std::string whole = ReadBytes(folder / "a.mmap");
  std::mt19937 random(1);
  const auto damaged = [&](const std::string& bytes) {
    std::ofstream(folder / "b.mmap", std::ios::binary) << bytes;
    if (Refusal(folder / "b.mmap").empty()) {
      EXPECT_TRUE(SameMap(ReadMapFile(folder / "b.mmap").result, map));
      return false;
    }
    return true;
  };
  for (int i = 0; i < 20; ++i) {
    EXPECT_TRUE(damaged(whole.substr(0, random() % whole.size()))) << i;
  }
  int refused = 0;
  for (int i = 0; i < 300; ++i) {
    std::string bytes = whole;
    bytes[random() % bytes.size()] ^= static_cast<char>(1U << (random() % 8));
    refused += damaged(bytes) ? 1 : 0;
  }
  EXPECT_GT(refused, 30);
  for (int i = 0; i < 50; ++i) {  // a block of nothing, as a bad disk gives
    std::string bytes = whole;
    const std::size_t start = random() % bytes.size();
    const std::size_t length = std::min<std::size_t>(512, bytes.size() - start);
    bytes.replace(start, length, length, '\0');
    damaged(bytes);
  }
}

/// Of two logs: the second drive made the last node, and the scans from there on.
BuildingMap MapOfTwoDrives() {
  BuildingMap map = SampleMap();
  map.drives.resize(2);
  map.drives[0].log = "one.log";
  map.drives[1].log = "two \"logs\".gz";
  map.drives[1].reason = "7 of 9 places fit";
  map.drives[1].stamp_offset_s = 3600.0;
  map.drives[1].motion_source = MotionSource::kOdometry;
  map.drives[1].first_node = map.trajectory.back().node_before;
  while (map.trajectory[map.drives[1].first_pose].node_before < map.drives[1].first_node) {
    ++map.drives[1].first_pose;
  }
  PoseGraph graph;
  for (Floor floor : map.graph.floors()) {
    floor.label_given = floor.label == map.graph.floors().back().label;
    graph.AddFloor(floor);
  }
  for (const Node& node : map.graph.nodes()) graph.AddNode(node);
  for (const Edge& edge : map.graph.edges()) graph.AddEdge(edge);
  map.graph = graph;
  return map;
}

TEST(MapFileReader, GivesBackDrives) {
  const TestFolder folder;
  MapOrigin origin{"one.log", "openings", {}};
  origin.later_logs = {{"two.log", ""}, {"three.log", "floors.csv"}};
  origin.onto = "old/building.mmap";
  origin.identity = "12 bytes\n13 bytes";
  const BuildingMap map = MapOfTwoDrives();
  WriteMapFile(origin, map, folder / "a.mmap");
  const SavedMap read = ReadMapFile(folder / "a.mmap");
  EXPECT_TRUE(SameMap(map, read.result));
  ASSERT_EQ(read.origin.later_logs.size(), 2U);
  EXPECT_EQ(read.origin.later_logs[0].log, "two.log");
  EXPECT_EQ(read.origin.later_logs[0].floors, "");
  EXPECT_EQ(read.origin.later_logs[1].floors, "floors.csv");
  EXPECT_EQ(read.origin.onto, origin.onto);
  EXPECT_EQ(read.origin.identity, origin.identity);
}

TEST(MapFileReader, GivesBackChangesOfFloor) {
  const TestFolder folder;
  BuildingMap map = MapOfTwoDrives();
  map.transits = {{10.5, 20.25, 3.5, 0.1, {"pressure", "acceleration"}, ""},
                  {40.0, 60.0, -3.5, 4.9, {"lidar"}, "it fits in more than one way"}};
  WriteMapFile({"one.log", "openings", {}}, map, folder / "a.mmap");
  const SavedMap read = ReadMapFile(folder / "a.mmap");
  ASSERT_EQ(read.result.transits.size(), 2U);
  EXPECT_EQ(read.result.transits[0].t_in, 20.25);
  EXPECT_EQ(read.result.transits[0].by, map.transits[0].by);
  EXPECT_EQ(read.result.transits[1].sigma_m, 4.9);
  EXPECT_EQ(read.result.transits[1].open, map.transits[1].open);
}

// A file that a program wrote which knew of version 1 alone.
TEST(MapFileReader, UpgradesVersion1) {
  const fs::path file = fs::path(MASKED_MAPPER_SOURCE_DIR) / "tests/map_file/version1.mmap";
  EXPECT_EQ(Database(file, OpenMode::kRead).Number("PRAGMA user_version"), 1);
  const SavedMap map = ReadMapFile(file);
  EXPECT_EQ(map.result.trajectory.size(), 24U);
  EXPECT_EQ(map.result.graph.nodes().size(), 3U);
  ASSERT_EQ(map.result.drives.size(), 1U);
  EXPECT_EQ(map.result.drives[0].log, map.origin.log);
  EXPECT_EQ(map.result.drives[0].first_node, 0);
  EXPECT_EQ(map.result.drives[0].motion_source, map.result.motion_source);
  ASSERT_EQ(map.result.graph.floors().size(), 2U);
  EXPECT_EQ(map.result.graph.floors()[0].label, "0");
  EXPECT_FALSE(map.result.graph.floors()[0].label_given) << "may be its place";
  EXPECT_EQ(map.result.graph.floors()[1].label, "up");
  EXPECT_TRUE(map.result.graph.floors()[1].label_given);
  // What it is upgraded to is written as what it is.
  const TestFolder folder;
  WriteMapFile(map.origin, map.result, folder / "new.mmap");
  EXPECT_EQ(Database(folder / "new.mmap", OpenMode::kRead).Number("PRAGMA user_version"), 4);
  EXPECT_TRUE(SameMap(map.result, ReadMapFile(folder / "new.mmap").result));
  // The version is part of what is believed: neither passes for the other.
  for (const auto& [from, version] :
       {std::make_pair(file, 2), std::make_pair(folder / "new.mmap", 1)}) {
    fs::copy_file(from, folder / "other.mmap", fs::copy_options::overwrite_existing);
    Database(folder / "other.mmap", OpenMode::kWrite)
        .Run("PRAGMA user_version = " + std::to_string(version));
    EXPECT_NE(Refusal(folder / "other.mmap").find("tables are not those"), std::string::npos);
  }
}

/// A map whose rows were changed by hand: the checksums are right, what they say may not be.
void WriteChanged(const BuildingMap& map, const fs::path& path, const std::string& change) {
  WriteMapFile({}, map, path);
  Database database(path, OpenMode::kWrite);
  database.Run("PRAGMA foreign_keys = OFF");
  database.Run(change);
  database.Run("DELETE FROM content");
  Seal(database);
}

TEST(MapFileReader, RefusesCloudsThatDoNotHoldTogether) {
  const TestFolder folder;
  int number = 0;
  for (const char* change :
       {"UPDATE clouds SET trajectory_index = 8 WHERE id = 1",
        "UPDATE clouds SET trajectory_index = -1 WHERE id = 0",
        "UPDATE clouds SET trajectory_index = 4 WHERE id = 0", "DELETE FROM clouds WHERE id = 0"}) {
    const fs::path path = folder / (std::to_string(number++) + ".mmap");
    WriteChanged(MapWithClouds(), path, change);
    EXPECT_NE(Refusal(path).find("table clouds"), std::string::npos) << change;
  }
}

TEST(MapFileReader, RefusesDrivesThatDoNotHoldTogether) {
  const TestFolder folder;
  int number = 0;
  for (const char* change : {
           "UPDATE drives SET first_pose = 1 WHERE id = 0",
           "UPDATE drives SET first_node = 1 WHERE id = 0",
           "UPDATE drives SET first_pose = 0 WHERE id = 1",
           "UPDATE drives SET first_pose = 1 WHERE id = 1",
           "UPDATE drives SET first_pose = 1 << 40 WHERE id = 1",
           "UPDATE drives SET first_node = 99 WHERE id = 1",
           "UPDATE drives SET stamp_offset = 9e999 WHERE id = 1",
           "UPDATE drives SET motion_source = 'wings' WHERE id = 1",
           "DELETE FROM drives WHERE id = 0",
           "UPDATE floors SET label_given = 2 WHERE id = 0",
           "UPDATE scans SET trajectory_index = 0",
       }) {
    const fs::path path = folder / (std::to_string(number++) + ".mmap");
    WriteChanged(MapOfTwoDrives(), path, change);
    EXPECT_NE(Refusal(path).find("damaged"), std::string::npos) << change;
  }
}

// Rows that no damage makes, but a hand: the checksums are right, what they say is not.
TEST(MapFileReader, RefusesRowsThatDoNotHoldTogether) {
  const TestFolder folder;
  int number = 0;
  for (const char* change : {
           "UPDATE floors SET elevation = 9e999 WHERE id = 0",
           "DELETE FROM floors WHERE id = 1",
           "UPDATE nodes SET floor = 2 WHERE id = 1",
           "UPDATE nodes SET floor = -1 WHERE id = 1",
           "UPDATE nodes SET world_x = -9e999 WHERE id = 1",
           "UPDATE nodes SET scan = 99 WHERE id = 1",
           "UPDATE edges SET closure = 3 WHERE kind = 'closure'",
           "DELETE FROM nodes WHERE id = 3",
           "DELETE FROM nodes WHERE id = 1",
           "UPDATE edges SET from_node = to_node WHERE id = 0",
           "UPDATE edges SET to_node = 4 WHERE id = 0",
           "UPDATE edges SET kind = 'closure' WHERE id = 2",
           "UPDATE edges SET kind = 'rope' WHERE id = 2",
           "UPDATE edges SET covariance = x'0000' WHERE id = 2",
           "UPDATE closures SET older = 99 WHERE id = 2",
           "UPDATE closures SET votes = 1 << 40 WHERE id = 2",
           "UPDATE closures SET state = 'sure' WHERE id = 2",
           "UPDATE trajectory SET pose_count = 7",
           "UPDATE trajectory SET poses_checksum = 0",
           "DELETE FROM trajectory",
           "UPDATE scans SET trajectory_index = 8 WHERE id = 0",
           "UPDATE scans SET beam_count = 1 << 60 WHERE id = 0",
           "UPDATE scans SET odom_x = 1.0 WHERE id = 0",
           "UPDATE scans SET id = 99 WHERE id = 0",
           "UPDATE run SET key = 'legs' WHERE key = 'mask'",
           "UPDATE run SET value = 'wings' WHERE key = 'motion_source'",
           "UPDATE log_statistics SET value = 'many' WHERE key = 'scans'",
       }) {
    const fs::path path = folder / (std::to_string(number++) + ".mmap");
    WriteChanged(SampleMap(), path, change);
    EXPECT_FALSE(Refusal(path).empty()) << change;
  }
}

TEST(MapFileReader, RefusesAnnotationsThatDoNotHoldTogether) {
  const TestFolder folder;
  int number = 0;
  for (const char* change : {
           "UPDATE places SET floor = 2 WHERE id = 0",
           "UPDATE places SET x = 9e999 WHERE id = 0",
           "UPDATE places SET id = 7 WHERE id = 1",
           "UPDATE areas SET kind = 'moat' WHERE id = 0",
           "UPDATE areas SET floor = -1 WHERE id = 0",
           "UPDATE areas SET corners = x'' WHERE id = 0",
           "UPDATE areas SET corners = CAST(substr(corners, 9) AS BLOB) WHERE id = 1",
           "UPDATE areas SET corners = CAST(substr(corners, 17) AS BLOB) WHERE id = 0",
           "UPDATE areas SET corners = CAST(x'000000000000F07F' || substr(corners, 9) AS BLOB)"
           " WHERE id = 0",
       }) {
    const fs::path path = folder / (std::to_string(number++) + ".mmap");
    WriteChanged(AwkwardMap(), path, change);
    EXPECT_NE(Refusal(path).find("damaged"), std::string::npos) << change;
  }
}

// Before version 4 maps knew no changes of floor, and nothing was written into them by hand.
TEST(MapFileReader, UpgradesVersion3) {
  const TestFolder folder;
  WriteMapFile({}, SampleMap(), folder / "a.mmap");
  {
    Database database(folder / "a.mmap", OpenMode::kWrite);
    database.Run("DROP TABLE places");
    database.Run("DROP TABLE areas");
    database.Run("DROP TABLE transits");
    database.Run("DELETE FROM content WHERE name IN ('places', 'areas', 'transits')");
    database.Run("PRAGMA user_version = 3");
  }
  BuildingMap older = SampleMap();
  older.transits.clear();
  EXPECT_TRUE(SameMap(older, ReadMapFile(folder / "a.mmap").result));
}

// Finite numbers that no covariance has: a solve would find nothing to divide by.
TEST(MapFileReader, RefusesCovariancesThatAreNone) {
  const TestFolder folder;
  int number = 0;
  for (const char* table : {"edges", "closures"}) {
    for (const char* covariance : {
             "x'000000000000F0BF' || substr(covariance, 9)",  // minus one m^2
             "x'9C7500883CE4377E' || substr(covariance, 9)",  // 1e300
             "substr(covariance, 1, 8) || x'000000000000F03F' || substr(covariance, 17)",
         }) {
      const fs::path path = folder / (std::to_string(number++) + ".mmap");
      WriteChanged(SampleMap(), path,
                   std::string("UPDATE ") + table + " SET covariance = CAST(" + covariance +
                       " AS BLOB) WHERE id = 2");
      EXPECT_NE(Refusal(path).find("a covariance that is none"), std::string::npos)
          << table << ": " << covariance;
    }
  }
}

SavedMap WithOptions(const fs::path& path, const std::vector<std::string>& changes) {
  std::string all;
  for (const std::string& change : changes) all += change + ";";
  WriteChanged(SampleMap(), path, all);
  return ReadMapFile(path);
}

std::string Insert(const std::string& key, const std::string& value) {
  return "INSERT INTO options(key, value) VALUES ('" + key + "', '" + value + "')";
}

TEST(MapFileReader, OptionsThatAreTheDefaultAreNotKept) {
  const TestFolder folder;
  MapOrigin origin{"a.log", "openings", {}};
  WriteMapFile(origin, SampleMap(), folder / "default.mmap");
  EXPECT_EQ(
      Database(folder / "default.mmap", OpenMode::kRead).Number("SELECT count(*) FROM options"), 0);
  SetOption("matcher.min_score=0.3", origin.options);
  WriteMapFile(origin, SampleMap(), folder / "other.mmap");
  Database other(folder / "other.mmap", OpenMode::kRead);
  EXPECT_EQ(other.Text("SELECT group_concat(key || '=' || value) FROM options"),
            "matcher.min_score=0.3");
}

// Options come and go with the program; the map stays.
TEST(MapFileReader, OptionsThatAreNotUnderstoodAreSaidAndLeftAside) {
  const TestFolder folder;
  const SavedMap map = WithOptions(
      folder / "a.mmap", {Insert("matcher.min_score", "0.3"), Insert("matcher.of_old", "12"),
                          Insert("motion.legs", "4"), Insert("nodes.min_edge_length_m", "-5")});
  EXPECT_TRUE(SameMap(map.result, SampleMap()));
  EXPECT_EQ(map.origin.options.mapping.closures.matcher.min_score, 0.3);
  EXPECT_EQ(map.origin.options.mapping.nodes.min_edge_length_m,
            Options().mapping.nodes.min_edge_length_m);
  ASSERT_EQ(map.left_aside.size(), 2U);
  EXPECT_NE(map.left_aside[0].find("matcher.of_old, motion.legs"), std::string::npos)
      << map.left_aside[0];
  EXPECT_NE(map.left_aside[1].find("nodes.min_edge_length_m must be"), std::string::npos)
      << map.left_aside[1];
  EXPECT_TRUE(ReadMapFile(folder / "a.mmap").left_aside.size() == 2U) << "each time";
  WriteMapFile({}, SampleMap(), folder / "b.mmap");
  EXPECT_TRUE(ReadMapFile(folder / "b.mmap").left_aside.empty());
}

TEST(MapFileReader, OptionsThatContradictEachOtherAreLeftAside) {
  const TestFolder folder;
  const SavedMap map = WithOptions(folder / "a.mmap", {Insert("nodes.min_edge_length_m", "20"),
                                                       Insert("nodes.max_edge_length_m", "9")});
  EXPECT_EQ(map.left_aside.size(), 1U);
  EXPECT_TRUE(ChangedOptions(map.origin.options).empty());
}

TEST(MapFileReader, ALongListOfUnknownOptionsIsOneShortLine) {
  const TestFolder folder;
  std::vector<std::string> changes;
  for (int i = 0; i < 200; ++i) changes.push_back(Insert("old.\n" + std::to_string(i), "1"));
  const SavedMap map = WithOptions(folder / "a.mmap", changes);
  ASSERT_EQ(map.left_aside.size(), 1U);
  EXPECT_EQ(map.left_aside[0].find('\n'), std::string::npos);
  EXPECT_NE(map.left_aside[0].find("old.?0, old.?1"), std::string::npos) << map.left_aside[0];
  EXPECT_NE(map.left_aside[0].find("and 188 more"), std::string::npos) << map.left_aside[0];
}

TEST(MapFileReader, RefusesTablesThatAreNotOurs) {
  const TestFolder folder;
  int number = 0;
  for (const char* change : {"CREATE TABLE more(a)", "CREATE INDEX i ON nodes(stamp)",
                             "DROP TABLE scans; CREATE VIEW scans AS SELECT * FROM nodes",
                             "ALTER TABLE nodes ADD COLUMN more ANY", "DELETE FROM content",
                             "DELETE FROM content WHERE id = 10",
                             "CREATE TRIGGER t AFTER INSERT ON run BEGIN SELECT 1; END"}) {
    const fs::path path = folder / (std::to_string(number++) + ".mmap");
    WriteMapFile({}, SampleMap(), path);
    Database(path, OpenMode::kWrite).Run(change);
    EXPECT_FALSE(Refusal(path).empty()) << change;
  }
}

}  // namespace
}  // namespace masked_mapper
