// SPDX-License-Identifier: BSD-3-Clause
#include "masked_mapper/mapping/map_log.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstdlib>
#include <filesystem>

#include "mapping/masked_mapper.hpp"
#include "mapping/ring_drive.hpp"
#include "mapping/same_map.hpp"
#include "masked_mapper/log/log_writer.hpp"
#include "masked_mapper/text/input_error.hpp"

namespace masked_mapper {
namespace {

/// The path of its log, by `name` in the tests' folder.
std::string LogOf(const RingDrive& drive, const std::string& name) {
  const std::string path = (std::filesystem::path(testing::TempDir()) / name).string();
  LogWriter writer(path);
  for (const LaserScan& scan : drive.scans) writer.Write(scan);
  writer.Close();
  return path;
}

TEST(MapLog, ALogBecomesAMapWithAPoseForEveryScan) {
  const RingDrive drive(1.25, 0.2);
  const std::string path = LogOf(drive, "ring.log.gz");
  ProgressSink silent;
  const BuildingMap map = MapLog(path, "openings", {}, silent);
  ASSERT_EQ(map.trajectory.size(), drive.scans.size());
  EXPECT_EQ(map.log.scans, drive.scans.size());
  EXPECT_EQ(map.motion_source, MotionSource::kFused);
  EXPECT_TRUE(map.warnings.empty());
  EXPECT_LT(LargestError(drive, map), 0.3) << "m";
  EXPECT_THROW(MapLog(path, "openingz", {}, silent), InputError);
  EXPECT_THROW(MapLog(path + ".missing", "openings", {}, silent), InputError);
}

// The wheels of this drive count 1 % too much, and nothing but what is closed can tell.
TEST(MapLog, ByWheelsAloneClosuresTellHowGoodTheyAre) {
  const RingDrive drive(2.0, 0.2);
  const std::string path = LogOf(drive, "wheels.log.gz");
  ProgressSink silent;
  MappingOptions options;
  options.motion.source = MotionSource::kOdometry;
  const BuildingMap map = MapLog(path, "always", options, silent);
  EXPECT_LT(LargestError(drive, map), 0.15) << "m";

  const FloorTimeline floors;
  MaskedMapper mapper("always", options, floors);
  for (const LaserScan& scan : drive.scans) mapper.Observe(scan);
  EXPECT_GT(LargestError(drive, mapper.Finish()), 0.2) << "m, with the wheels as they are";
}

TEST(MapLog, WhatOverlapsChangesNothing) {
  const std::string path = LogOf(RingDrive(1.6, 0.2), "threads.log.gz");
  ProgressSink silent;
  for (const MotionSource source : {MotionSource::kFused, MotionSource::kOdometry}) {
    MappingOptions options;
    options.motion.source = source;
    const BuildingMap alone = MapLog(path, "always", options, silent);
    options.threads = options.closures.matcher.threads = 3;
    EXPECT_TRUE(SameMap(alone, MapLog(path, "always", options, silent)));
    EXPECT_GE(alone.closures.size(), 2U);
  }
}

TEST(MapLog, ABagOfAFullCircleScannerIsMappedRight) {
  const RingDrive drive(1.25, 0.2, 1, 360, 359.0);
  ASSERT_TRUE(drive.scans.front().IsFullCircle());
  const std::string path = LogOf(drive, "full_circle.log");
  const std::string command = "/usr/bin/python3 " MASKED_MAPPER_SOURCE_DIR
                              "/tests/mapping/write_bag_of_log.py " +
                              path + " " + path + ".bag >/dev/null 2>&1";
  if (std::system(command.c_str()) != 0) GTEST_SKIP() << "python3-rosbag is not installed";
  ProgressSink silent;
  const BuildingMap map = MapLog(path + ".bag", "openings", {}, silent);
  ASSERT_EQ(map.trajectory.size(), drive.scans.size());
  EXPECT_TRUE(map.kept_scans.front().scan.IsFullCircle());
  EXPECT_LT(LargestError(drive, map), 0.3) << "m";
}

TEST(MapLog, ABagAndATextLogOfOneDriveGiveOneMap) {
  const std::string shared = MASKED_MAPPER_REAL_LOGS;
  for (const char* file : {"/data/mit-csail.clf.gz", "/bags/mit-csail.bag"}) {
    if (!std::filesystem::exists(shared + file)) GTEST_SKIP() << file << " is not there";
  }
  ProgressSink silent;
  const BuildingMap text = MapLog(shared + "/data/mit-csail.clf.gz", "openings", {}, silent);
  const BuildingMap bag = MapLog(shared + "/bags/mit-csail.bag", "openings", {}, silent);
  // Single precision of the bag's angles and the rounding of its quaternions are taken off: nothing
  // is left of them.
  ASSERT_EQ(text.trajectory.size(), 1988U);
  ASSERT_EQ(bag.trajectory.size(), text.trajectory.size());
  for (std::size_t i = 0; i < text.trajectory.size(); ++i) {
    EXPECT_EQ(bag.trajectory[i].stamp, text.trajectory[i].stamp);
    ASSERT_EQ(bag.trajectory[i].T_world_robot.AsVector(),
              text.trajectory[i].T_world_robot.AsVector())
        << "scan " << i;
  }
  ASSERT_EQ(bag.closures.size(), text.closures.size());
  for (std::size_t i = 0; i < text.closures.size(); ++i) {
    EXPECT_EQ(bag.closures[i].state, text.closures[i].state) << "closure " << i;
  }
}

TEST(MapLog, AcesIsMappedAsWellAsItsRelationsCanTell) {
  const std::string path = std::string(MASKED_MAPPER_REAL_LOGS) + "/data/aces.clf.gz";
  if (!std::filesystem::exists(path)) GTEST_SKIP() << path << " is not there";
  ProgressSink silent;
  const BuildingMap openings = MapLog(path, "openings", {}, silent);
  EXPECT_EQ(openings.trajectory.size(), 7374U);
  std::size_t validated = 0;
  for (const Closure& closure : openings.closures) {
    validated += closure.state == ClosureState::kValidated;
  }
  EXPECT_GT(validated, 20U);
  // Fewer matches is what a mask is for (Section I).
  const BuildingMap always = MapLog(path, "always", {}, silent);
  EXPECT_LE(3 * openings.closures.size(), always.closures.size());
  // And still fewer of the same map, where new ground asks for few nodes.
  const BuildingMap sparse = MapLog(path, "sparse(openings)", {}, silent);
  EXPECT_LE(4 * sparse.closures.size(), 3 * openings.closures.size());
  double apart = 0.0;
  for (std::size_t i = 0; i < sparse.trajectory.size(); ++i) {
    apart = std::max(
        apart, Distance(sparse.trajectory[i].T_world_robot, openings.trajectory[i].T_world_robot));
  }
  EXPECT_LT(apart, 0.5) << "m";
}

}  // namespace
}  // namespace masked_mapper
