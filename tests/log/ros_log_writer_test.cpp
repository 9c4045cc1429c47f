// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>

#include "log/open_bag.hpp"
#include "log/ros_point_cloud.hpp"
#include "log/temporary_file.hpp"
#include "masked_mapper/geometry/pose2.hpp"
#include "masked_mapper/log/log_reader.hpp"
#include "masked_mapper/log/log_writer.hpp"
#include "masked_mapper/text/input_error.hpp"

namespace masked_mapper {
namespace {

constexpr int kScans = 2000;  // several chunks of them

LaserScan ScanAt(double stamp) {
  LaserScan scan;
  scan.stamp = stamp;
  scan.T_robot_laser = {0.2, -0.1, 0.3};
  scan.first_angle = DegToRad(-90.0);
  scan.angle_step = DegToRad(1.0);
  scan.max_range = 30.0F;
  scan.beam_time = 1e-4;
  for (int beam = 0; beam < 181; ++beam) {
    scan.ranges.push_back(static_cast<float>(2.0 + 0.01 * beam + 0.001 * std::fmod(stamp, 7.0)));
  }
  scan.ranges[0] = kNoReturn;
  scan.ranges[1] = kInvalidRange;
  const double angle = 0.01 * (stamp - 1e9);
  scan.T_odom_robot = Pose2{std::sin(angle), 1.0 - std::cos(angle), WrapAngle(angle)};
  return scan;
}

void WriteDriveTo(const std::string& path) {
  LogWriter log(path);
  log.WriteComment("a comment");
  for (int i = 0; i < kScans; ++i) {
    const double stamp = 1e9 + 0.1 * i;
    log.Write(OdometryReading{stamp, *ScanAt(stamp).T_odom_robot});
    if (i % 10 == 0) log.Write(PressureReading{stamp + 0.01, 101325.0 - i});
    if (i % 10 == 0) log.Write(AccelerationReading{stamp + 0.02, {0.1, 0.2, 9.81}});
    log.Write(ScanAt(stamp + 0.05));
  }
  log.Close();
}

/// What is written of a cloud and read of the file.
RosPointCloud WrittenAndRead(const std::string& ending, const CloudReading& cloud) {
  const TemporaryFile file(ending);
  LogWriter log(file.path());
  log.WriteCloud(cloud);
  log.Close();
  const std::unique_ptr<RosBag> bag = OpenBag(file.path());
  while (const std::optional<BagMessage> message = bag->Next()) {
    if (bag->Connections().at(message->connection).topic != "/points") continue;
    auto parsed = ParsePointCloud(message->data, message->size, message->encoding);
    if (parsed) return *parsed;
    ADD_FAILURE() << FaultOfPointCloud(message->data, message->size, message->encoding);
  }
  return {};
}

class RosLogWriterTest : public ::testing::TestWithParam<const char*> {};

TEST_P(RosLogWriterTest, CloudsOfAllLayoutsAreReadAgain) {
  for (const CloudLayout layout :
       {CloudLayout::kVelodyne, CloudLayout::kOuster, CloudLayout::kLivox}) {
    CloudReading cloud;
    cloud.stamp = 1.7e9;
    cloud.layout = layout;
    for (int i = 0; i < 500; ++i) {
      const auto value = static_cast<float>(i + 1);
      cloud.points.push_back({{value, -value, 0.5F}, 0.1F * value, 2e-4F * value});
    }
    const RosPointCloud read = WrittenAndRead(GetParam(), cloud);
    EXPECT_NEAR(read.header.stamp, cloud.stamp, 1e-6);
    EXPECT_TRUE(read.has_times);
    ASSERT_EQ(read.points.size(), cloud.points.size());
    for (std::size_t i = 0; i < read.points.size(); ++i) {
      ASSERT_EQ(read.points[i].position, cloud.points[i].position);
      ASSERT_EQ(read.points[i].intensity, cloud.points[i].intensity);
      ASSERT_NEAR(read.points[i].time, cloud.points[i].time, 1e-6);
    }
  }
}

TEST_P(RosLogWriterTest, WhatWasWrittenIsRead) {
  const TemporaryFile file(GetParam());
  WriteDriveTo(file.path());
  const std::unique_ptr<LogReader> reader = OpenLog(file.path(), {});
  int scans = 0;
  while (const std::optional<Observation> observation = reader->Next()) {
    if (const auto* pressure = std::get_if<PressureReading>(&*observation)) {
      EXPECT_NEAR(pressure->pressure_pa, 101325.0 - 10.0 * (pressure->stamp - 1e9 - 0.01), 1e-3);
    }
    if (const auto* reading = std::get_if<AccelerationReading>(&*observation)) {
      EXPECT_EQ(reading->acceleration_in_robot, Eigen::Vector3d(0.1, 0.2, 9.81));
    }
    const auto* scan = std::get_if<LaserScan>(&*observation);
    if (scan == nullptr) continue;
    const double stamp = 1e9 + 0.1 * scans++ + 0.05;
    const LaserScan expected = ScanAt(stamp);
    EXPECT_NEAR(scan->stamp, stamp, 1e-6);
    EXPECT_EQ(scan->first_angle, expected.first_angle);
    EXPECT_EQ(scan->angle_step, expected.angle_step);
    EXPECT_EQ(scan->max_range, 30.0F);
    EXPECT_NEAR(scan->beam_time, 1e-4, 1e-9);
    EXPECT_LT(Distance(scan->T_robot_laser, expected.T_robot_laser), 1e-12) << "m";
    ASSERT_TRUE(scan->T_odom_robot);
    EXPECT_LT(Distance(*scan->T_odom_robot, *expected.T_odom_robot), 1e-6) << "m";
    ASSERT_EQ(scan->size(), expected.size());
    EXPECT_EQ(scan->ranges[0], kNoReturn);
    EXPECT_TRUE(std::isnan(scan->ranges[1]));
    EXPECT_EQ(scan->ranges[100], expected.ranges[100]);
  }
  EXPECT_EQ(scans, kScans);
  const LogStatistics& statistics = reader->Statistics();
  EXPECT_FALSE(statistics.truncated);
  EXPECT_EQ(statistics.bad_lines, 0U) << statistics.first_bad_line;
  EXPECT_EQ(statistics.pressure, 200U);
  EXPECT_EQ(statistics.acceleration, 200U);
}

TEST_P(RosLogWriterTest, TheSameDriveGivesTheSameBytes) {
  const TemporaryFile first(GetParam());
  const TemporaryFile second(GetParam());
  WriteDriveTo(first.path());
  WriteDriveTo(second.path());
  EXPECT_TRUE(first.Read() == second.Read());
}

TEST_P(RosLogWriterTest, ABagThatWasNotClosedIsReadAsOneThatWasCut) {
  const TemporaryFile file(GetParam());
  {
    LogWriter log(file.path());
    for (int i = 0; i < kScans; ++i) log.Write(ScanAt(1e9 + 0.1 * i));
    log.Close();
  }
  const std::string bytes = file.Read();
  file.Write(bytes.substr(0, bytes.size() * 2 / 3));
  const std::unique_ptr<LogReader> reader = OpenLog(file.path(), {});
  while (reader->Next()) {
  }
  EXPECT_GT(reader->Statistics().scans, 500U);
  EXPECT_TRUE(reader->Statistics().truncated);
}

TEST_P(RosLogWriterTest, FloorLabelsHaveNoPlaceInABag) {
  const TemporaryFile file(GetParam());
  LogWriter log(file.path());
  EXPECT_THROW(log.Write(FloorLabel{1.0, "0"}), InputError);
}

INSTANTIATE_TEST_SUITE_P(Kinds, RosLogWriterTest, ::testing::Values(".bag", ".mcap"));

TEST(Ros1BagWriterTest, DebiansOwnRosbagReadsIt) {
  const TemporaryFile bag(".bag");
  const TemporaryFile output(".txt");
  WriteDriveTo(bag.path());
  const std::string command = "/usr/bin/python3 " MASKED_MAPPER_SOURCE_DIR
                              "/tests/log/read_bag.py " +
                              bag.path() + " >" + output.path() + " 2>&1";
  const bool is_read = std::system(command.c_str()) == 0;
  const std::string text = output.Read();
  if (!is_read && text.find("ModuleNotFoundError") != std::string::npos) {
    GTEST_SKIP() << "python3-rosbag is not installed";
  }
  ASSERT_TRUE(is_read) << text;
  EXPECT_EQ(text,
            "/imu sensor_msgs/Imu 200\n"
            "/odom nav_msgs/Odometry 4000\n"
            "/pressure sensor_msgs/FluidPressure 200\n"
            "/scan sensor_msgs/LaserScan 2000\n"
            "/tf tf2_msgs/TFMessage 4000\n"
            "/tf_static tf2_msgs/TFMessage 1\n"
            "1000000000.050000 laser 181 -1.570796 1.570796 30.000 inf nan\n");
}

}  // namespace
}  // namespace masked_mapper
