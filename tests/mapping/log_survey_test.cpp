// SPDX-License-Identifier: BSD-3-Clause
#include "masked_mapper/mapping/log_survey.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <fstream>

#include "masked_mapper/log/log_writer.hpp"
#include "masked_mapper/text/input_error.hpp"
#include "scan_matching/box_scene.hpp"

namespace masked_mapper {
namespace {

std::string TemporaryLog(const std::string& name) {
  return (std::filesystem::path(testing::TempDir()) / name).string();
}

LogSurvey Survey(const std::string& path, const MappingOptions& options) {
  LogSource source(path, options.log);
  return SurveyLog(source, options);
}

LaserScan ScanAt(double stamp, double x) {
  LaserScan scan;
  scan.stamp = stamp;
  scan.first_angle = -0.5 * kPi;
  scan.angle_step = kPi / 180.0;
  scan.max_range = 30.0F;
  scan.ranges.assign(181, 4.0F);
  scan.T_odom_robot = Pose2{x, 0.0, 0.0};
  return scan;
}

TEST(SurveyLog, TellsSilencesOfTheOdometry) {
  for (const double silent_s : {1.0, 15.0, 1000.0}) {
    const std::string path = TemporaryLog("silence.mcap");
    LogWriter writer(path);
    for (int i = 0; i < 400; ++i) {
      const double stamp = 1000.0 + 0.1 * i;
      const bool is_silent = stamp > 1010.05 && stamp < 1010.05 + silent_s;
      if (!is_silent) writer.Write(OdometryReading{stamp, {0.01 * i, 0.0, 0.0}});
      LaserScan scan = ScanAt(stamp + 0.01, 0.0);
      scan.T_odom_robot.reset();
      writer.Write(scan);
    }
    writer.Close();
    const LogSurvey survey = Survey(path, {});
    if (silent_s < 2.0) {
      EXPECT_TRUE(survey.findings.empty()) << "s of silence: " << silent_s;
      continue;
    }
    ASSERT_EQ(survey.findings.size(), 1U) << "s of silence: " << silent_s;
    EXPECT_NEAR(survey.findings[0].t_a, 1010.0, 0.7);
    EXPECT_NEAR(survey.findings[0].t_b, std::min(1010.0 + silent_s, 1039.9), 0.7);
  }
}

TEST(SurveyLog, CountsScansAndTheirSteps) {
  const std::string path = TemporaryLog("survey.log");
  LogWriter writer(path);
  for (int i = 0; i < 20; ++i) writer.Write(ScanAt(0.2 * i, 0.1 * i));
  writer.Close();
  const LogSurvey survey = Survey(path, {});
  EXPECT_EQ(survey.scans, 20U);
  EXPECT_TRUE(survey.has_odometry);
  EXPECT_NEAR(survey.median_travel_m, 0.1, 1e-3);
  EXPECT_NEAR(survey.median_period_s, 0.2, 1e-3);
  EXPECT_EQ(SettleMotionSource(path, {}, survey), MotionSource::kFused);
}

/// Round and round through a furnished room at 5 Hz; the wheels freeze after 20 s for as long, then
/// leap to where they should be.
std::string FrozenLog(const std::string& name, double frozen_s) {
  const std::string path = TemporaryLog(name);
  const BoxScene room = FurnishedRoom();
  LogWriter writer(path);
  Pose2 T_world_robot{2.0, 2.5, 0.0};
  Pose2 frozen;
  for (int i = 0; i < 400; ++i) {
    const double stamp = 1000.0 + 0.2 * i;
    T_world_robot = T_world_robot * Pose2{0.06, 0.0, DegToRad(i % 60 < 30 ? 3.5 : 2.5)};
    if (i <= 100) frozen = T_world_robot;
    LaserScan scan = room.Scan(T_world_robot, 361, 270.0);
    scan.stamp = stamp;
    scan.T_odom_robot = i > 100 && i < 100 + 5.0 * frozen_s ? frozen : T_world_robot;
    writer.Write(scan);
  }
  writer.Close();
  return path;
}

TEST(SurveyLog, LeavesOutWheelsThatStandStillInPassing) {
  for (const double frozen_s : {0.0, 10.0, 100.0}) {
    const std::string path = FrozenLog("frozen.log", frozen_s);
    LogSource source(path, {});
    const LogSurvey survey = SurveyLog(source, {});
    if (frozen_s == 0.0) {
      EXPECT_TRUE(survey.mending.IsNone());
      EXPECT_TRUE(survey.findings.empty());
      continue;
    }
    ASSERT_EQ(survey.findings.size(), 1U) << "s: " << frozen_s;
    EXPECT_NEAR(survey.findings[0].t_a, 1020.0, 0.5);
    EXPECT_NEAR(survey.findings[0].t_b, std::min(1020.0 + frozen_s, 1079.8), 0.5);
    // The source is read so from now on.
    const std::unique_ptr<LogReader> log = source.Read();
    while (const std::optional<Observation> observation = log->Next()) {
      const auto& scan = std::get<LaserScan>(*observation);
      const bool is_frozen = scan.stamp > 1020.3 && scan.stamp < 1019.8 + frozen_s;
      EXPECT_FALSE(is_frozen && scan.T_odom_robot) << scan.stamp;
    }
  }
}

// Whoever wants the wheels believed gets them, and hears where scans say otherwise.
TEST(SurveyLog, WarnsOfWheelsThatStandStillWhereTheyAloneAreBelieved) {
  MappingOptions options;
  options.motion.source = MotionSource::kOdometry;
  for (const double frozen_s : {0.0, 10.0}) {
    const std::string path = FrozenLog("frozen_alone.log", frozen_s);
    LogSource source(path, {});
    const LogSurvey survey = SurveyLog(source, options);
    EXPECT_TRUE(survey.mending.IsNone());
    ASSERT_EQ(survey.warnings.size(), frozen_s == 0.0 ? 0U : 1U);
    if (frozen_s > 0.0) {
      EXPECT_NE(survey.warnings[0].find("10.0 s from 1020.000"), std::string::npos)
          << survey.warnings[0];
    }
  }
}

TEST(SurveyLog, OfWheelsThatNeverTurnTheWayIsKept) {
  const std::string path = TemporaryLog("no_turns.log");
  const BoxScene room = FurnishedRoom();
  LogWriter writer(path);
  Pose2 T_world_robot{2.0, 2.5, 0.0};
  for (int i = 0; i < 400; ++i) {
    T_world_robot = T_world_robot * Pose2{0.06, 0.0, DegToRad(i % 60 < 30 ? 3.5 : 2.5)};
    LaserScan scan = room.Scan(T_world_robot, 361, 270.0);
    scan.stamp = 1000.0 + 0.2 * i;
    scan.T_odom_robot = Pose2{T_world_robot.x, T_world_robot.y, 0.0};
    writer.Write(scan);
  }
  writer.Close();
  const LogSurvey survey = Survey(path, {});
  EXPECT_TRUE(survey.mending.turns_left_out);
  EXPECT_TRUE(survey.mending.left_out.empty());
  ASSERT_EQ(survey.findings.size(), 1U);
  EXPECT_NE(survey.findings[0].what.find("turns"), std::string::npos) << survey.findings[0].what;
}

TEST(SurveyLog, ScansFarApartAreLeftToTheWheels) {
  LogSurvey survey;
  survey.has_odometry = survey.odometry_moves = true;
  MotionOptions options;
  survey.median_travel_m = 1.5;
  EXPECT_EQ(SettleMotionSource("x", options, survey), MotionSource::kFused);
  survey.median_travel_m = 2.5;
  EXPECT_EQ(SettleMotionSource("x", options, survey), MotionSource::kOdometry);
  survey.median_travel_m = 0.1;
  survey.median_turn_rad = DegToRad(70.0);
  EXPECT_EQ(SettleMotionSource("x", options, survey), MotionSource::kOdometry);
  options.source = MotionSource::kFused;
  EXPECT_EQ(SettleMotionSource("x", options, survey), MotionSource::kFused);
  options.source = MotionSource::kAuto;
  survey.has_odometry = survey.odometry_moves = false;
  EXPECT_EQ(SettleMotionSource("x", options, survey), MotionSource::kScans);
  options.source = MotionSource::kOdometry;
  EXPECT_THROW(SettleMotionSource("x", options, survey), InputError);
}

TEST(SurveyLog, OdometryThatNeverMovesIsNone) {
  const std::string path = TemporaryLog("resting_odometry.log");
  LogWriter writer(path);
  for (int i = 0; i < 20; ++i) writer.Write(ScanAt(0.2 * i, 3.0));
  writer.Close();
  const LogSurvey survey = Survey(path, {});
  EXPECT_TRUE(survey.has_odometry);
  EXPECT_FALSE(survey.odometry_moves);
  EXPECT_EQ(SettleMotionSource(path, {}, survey), MotionSource::kScans);
  ASSERT_EQ(survey.warnings.size(), 1U);
  EXPECT_NE(survey.warnings.front().find("never moves"), std::string::npos);
}

TEST(SurveyLog, WithoutAScanThereIsNothingToMap) {
  const std::string path = TemporaryLog("no_scan.log");
  std::ofstream(path) << "# CARMEN\nODOM 0 0 0 0 0 0 1.0 host 1.0\n";
  EXPECT_THROW(Survey(path, {}), InputError);
}

TEST(SurveyLog, FloorsOfAFileStandForThoseOfTheLog) {
  const std::string path = TemporaryLog("floors.log");
  LogWriter writer(path);
  for (int i = 0; i < 50; ++i) writer.Write(ScanAt(10.0 + 0.2 * i, 0.1 * i));
  writer.Close();
  const std::string file = TemporaryLog("floors.csv");
  MappingOptions options;
  options.floors.file = file;

  std::ofstream(file) << "t,label\n9,EG\n14,-\n15,OG\n";
  const LogSurvey survey = Survey(path, options);
  EXPECT_EQ(survey.floor_source, FloorSource::kLabels);
  ASSERT_EQ(survey.floors.levels.size(), 2U);
  EXPECT_EQ(survey.floors.levels[0].label, "EG");
  EXPECT_EQ(survey.floors.At(13.9).level, 0U);
  EXPECT_TRUE(survey.floors.At(14.5).in_transit);
  EXPECT_EQ(survey.floors.At(15.1).level, 1U);

  std::ofstream(file) << "0,EG\n";  // one label may stand for the whole log
  EXPECT_EQ(Survey(path, options).floors.levels.front().label, "EG");
  for (const char* wrong : {"0,EG\n5,OG\n", "1000,EG\n1005,OG\n", "9,../x\n", "14,-\n", ""}) {
    std::ofstream(file) << wrong;
    EXPECT_THROW(Survey(path, options), InputError) << wrong;
  }
  options.floors.file = TemporaryLog("floors.missing");
  EXPECT_THROW(Survey(path, options), InputError);
}

}  // namespace
}  // namespace masked_mapper
