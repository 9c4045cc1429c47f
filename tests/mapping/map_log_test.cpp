// SPDX-License-Identifier: BSD-3-Clause
#include "masked_mapper/mapping/map_log.hpp"

#include <gtest/gtest.h>

#include <filesystem>

#include "mapping/ring_drive.hpp"
#include "masked_mapper/log/input_error.hpp"
#include "masked_mapper/log/log_writer.hpp"

namespace masked_mapper {
namespace {

TEST(MapLog, ALogBecomesAMapWithAPoseForEveryScan) {
  const RingDrive drive(1.25, 0.2);
  const std::string path = (std::filesystem::path(testing::TempDir()) / "ring.log.gz").string();
  LogWriter writer(path);
  for (const LaserScan& scan : drive.scans) writer.Write(scan);
  writer.Close();
  ProgressSink silent;
  const MappingResult map = MapLog(path, "openings", {}, silent);
  ASSERT_EQ(map.trajectory.size(), drive.scans.size());
  EXPECT_EQ(map.log.scans, drive.scans.size());
  EXPECT_EQ(map.motion_source, MotionSource::kFused);
  EXPECT_TRUE(map.warnings.empty());
  double worst = 0.0;
  for (std::size_t i = 0; i < drive.truth.size(); ++i) {
    worst = std::max(worst, Distance(drive.truth[i], map.trajectory[i].T_world_robot));
  }
  EXPECT_LT(worst, 0.3) << "m";
  EXPECT_THROW(MapLog(path, "openingz", {}, silent), InputError);
  EXPECT_THROW(MapLog(path + ".missing", "openings", {}, silent), InputError);
}

TEST(MapLog, AcesIsMappedAsWellAsItsRelationsCanTell) {
  const std::string path = std::string(MASKED_MAPPER_REAL_LOGS) + "/data/aces.clf.gz";
  if (!std::filesystem::exists(path)) GTEST_SKIP() << path << " is not there";
  ProgressSink silent;
  const MappingResult openings = MapLog(path, "openings", {}, silent);
  EXPECT_EQ(openings.trajectory.size(), 7374U);
  std::size_t validated = 0;
  for (const ClosureAttempt& attempt : openings.attempts) {
    validated += attempt.state == ClosureState::kValidated;
  }
  EXPECT_GT(validated, 20U);
  // Fewer matches is what a mask is for (Section I).
  const MappingResult always = MapLog(path, "always", {}, silent);
  EXPECT_LE(3 * openings.attempts.size(), always.attempts.size());
}

}  // namespace
}  // namespace masked_mapper
