// SPDX-License-Identifier: BSD-3-Clause
#include "masked_mapper/log/log_writer.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <random>
#include <stdexcept>

#include "log/temporary_file.hpp"
#include "masked_mapper/geometry/pose2.hpp"
#include "masked_mapper/log/log_reader.hpp"

namespace masked_mapper {
namespace {

LaserScan SomeScan(double stamp, std::size_t beams, double field_of_view_deg, float max_range,
                   std::mt19937* random) {
  LaserScan scan;
  scan.stamp = stamp;
  scan.T_robot_laser = {0.15, -0.02, 0.03};
  const double steps = static_cast<double>(beams % 2 == 0 ? beams : beams - 1);
  scan.first_angle = -0.5 * DegToRad(field_of_view_deg);
  scan.angle_step = DegToRad(field_of_view_deg) / steps;
  scan.max_range = max_range;
  std::uniform_real_distribution<float> range(0.1F, max_range);
  for (std::size_t i = 0; i < beams; ++i) {
    scan.ranges.push_back(i % 11 == 3 ? kNoReturn : i % 17 == 5 ? kInvalidRange : range(*random));
  }
  scan.ranges.back() = std::nextafter(max_range, 0.0F);
  scan.T_odom_robot = Pose2{0.1 * stamp, std::sin(stamp), WrapAngle(0.1 * stamp)};
  return scan;
}

std::vector<Observation> SomeLog(std::size_t beams, double field_of_view_deg, float max_range) {
  std::mt19937 random(11);
  std::vector<Observation> log;
  for (int i = 0; i < 50; ++i) {
    const double stamp = 1000.0 + 0.2 * i;
    log.emplace_back(OdometryReading{stamp - 0.1, {0.01 * i, -0.3, 3.0}});
    log.emplace_back(PressureReading{stamp - 0.05, 101325.125 - i});
    log.emplace_back(AccelerationReading{stamp - 0.02, {0.1, -0.2, 9.81}});
    if (i == 20) log.emplace_back(FloorLabel{stamp - 0.01, "-"});
    if (i == 30) log.emplace_back(FloorLabel{stamp - 0.01, "2b"});
    log.emplace_back(SomeScan(stamp, beams, field_of_view_deg, max_range, &random));
  }
  return log;
}

void ExpectPoseNear(const Pose2& found, const Pose2& expected) {
  EXPECT_NEAR(found.x, expected.x, 2e-6) << "m";
  EXPECT_NEAR(found.y, expected.y, 2e-6) << "m";
  EXPECT_NEAR(WrapAngle(found.theta - expected.theta), 0.0, 2e-6) << "rad";
}

void ExpectSame(const Observation& found, const Observation& expected) {
  ASSERT_EQ(found.index(), expected.index());
  EXPECT_NEAR(Stamp(found), Stamp(expected), 1e-6);
  if (const auto* scan = std::get_if<LaserScan>(&expected)) {
    const auto& read = std::get<LaserScan>(found);
    ASSERT_EQ(read.size(), scan->size());
    EXPECT_NEAR(read.first_angle, scan->first_angle, 1e-9);
    EXPECT_NEAR(read.angle_step, scan->angle_step, 1e-9);
    EXPECT_NEAR(read.max_range, scan->max_range, 1e-3);
    ExpectPoseNear(*read.T_odom_robot, *scan->T_odom_robot);
    EXPECT_NEAR(Distance(read.T_robot_laser, scan->T_robot_laser), 0.0, 1e-4);
    for (std::size_t beam = 0; beam < scan->size(); ++beam) {
      EXPECT_EQ(read.IsHit(beam), scan->IsHit(beam)) << beam;
      EXPECT_EQ(std::isnan(read.ranges[beam]), std::isnan(scan->ranges[beam])) << beam;
      if (!scan->IsHit(beam)) continue;
      EXPECT_NEAR(read.ranges[beam], scan->ranges[beam], 1.1e-3);
    }
  } else if (const auto* odometry = std::get_if<OdometryReading>(&expected)) {
    ExpectPoseNear(std::get<OdometryReading>(found).T_odom_robot, odometry->T_odom_robot);
  } else if (const auto* pressure = std::get_if<PressureReading>(&expected)) {
    EXPECT_NEAR(std::get<PressureReading>(found).pressure_pa, pressure->pressure_pa, 1e-3);
  } else if (const auto* acceleration = std::get_if<AccelerationReading>(&expected)) {
    EXPECT_EQ(std::get<AccelerationReading>(found).acceleration_in_robot,
              acceleration->acceleration_in_robot);
  } else if (const auto* label = std::get_if<FloorLabel>(&expected)) {
    EXPECT_EQ(std::get<FloorLabel>(found).label, label->label);
  }
}

struct Case {
  std::size_t beams;
  double field_of_view_deg;
  float max_range;
};

TEST(LogWriterTest, WhatIsWrittenIsReadBack) {
  for (const Case& c : {Case{361, 270.0, 30.0F}, Case{360, 360.0, 12.34F}, Case{361, 180.0, 81.91F},
                        Case{180, 180.0, 29.9996F}}) {
    for (const char* ending : {".log", ".log.gz"}) {
      const std::vector<Observation> log = SomeLog(c.beams, c.field_of_view_deg, c.max_range);
      const TemporaryFile file(ending);
      LogWriter writer(file.path());
      writer.WriteComment("two\nlines");
      for (const Observation& observation : log) writer.Write(observation);
      writer.Close();
      const std::unique_ptr<LogReader> reader = OpenLog(file.path(), {});
      for (const Observation& expected : log) {
        const std::optional<Observation> found = reader->Next();
        ASSERT_TRUE(found) << reader->Statistics().first_bad_line;
        ExpectSame(*found, expected);
      }
      EXPECT_FALSE(reader->Next());
      EXPECT_EQ(reader->Statistics().bad_lines, 0U) << reader->Statistics().first_bad_line;
      EXPECT_NEAR(reader->Statistics().max_range, c.max_range, 1e-3);
    }
  }
}

TEST(LogWriterTest, WritesTheSameBytesTwice) {
  const std::vector<Observation> log = SomeLog(361, 270.0, 30.0F);
  std::string first;
  for (int i = 0; i < 2; ++i) {
    const TemporaryFile file(".gz");
    LogWriter writer(file.path());
    for (const Observation& observation : log) writer.Write(observation);
    writer.Close();
    if (i == 0) first = file.Read();
    EXPECT_EQ(file.Read(), first);
  }
}

TEST(LogWriterTest, AMirroredScanKeepsItsPoints) {
  std::mt19937 random(2);
  LaserScan scan = SomeScan(1.0, 91, 200.0, 20.0F, &random);
  scan.first_angle = -scan.first_angle;
  scan.angle_step = -scan.angle_step;
  const TemporaryFile file(".log");
  LogWriter writer(file.path(), 5);
  writer.Write(scan);
  writer.Close();
  const std::optional<Observation> found = OpenLog(file.path(), {})->Next();
  const auto& read = std::get<LaserScan>(*found);
  EXPECT_GT(read.angle_step, 0.0);
  const ScanPoints::ConstPtr written_points = PointsInRobot(scan);
  const ScanPoints::ConstPtr read_points = PointsInRobot(read);
  ASSERT_EQ(read_points->size(), written_points->size());
  for (std::size_t i = 0; i < read_points->size(); ++i) {
    const auto& other = (*written_points)[written_points->size() - 1 - i];
    EXPECT_NEAR((*read_points)[i].x, other.x, 1e-3);
    EXPECT_NEAR((*read_points)[i].y, other.y, 1e-3);
  }
}

TEST(LogWriterTest, SaysWhenItCannotWrite) {
  EXPECT_THROW(LogWriter("/no/such/folder/x.log"), std::runtime_error);
  LogWriter writer("/dev/full");
  writer.Write(OdometryReading{});
  EXPECT_THROW(writer.Close(), std::runtime_error);
}

TEST(LogWriterTest, RefusesLabelsThatCouldNotBeReadBack) {
  const TemporaryFile file(".log");
  LogWriter writer(file.path());
  EXPECT_THROW(writer.Write(FloorLabel{1.0, "two words"}), std::invalid_argument);
}

}  // namespace
}  // namespace masked_mapper
