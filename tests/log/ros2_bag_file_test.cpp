// SPDX-License-Identifier: BSD-3-Clause
#include "log/ros2_bag_file.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <random>
#include <vector>

#include "log/mcap_bytes.hpp"
#include "log/ros2_bag_writing.hpp"
#include "log/temporary_file.hpp"
#include "masked_mapper/log/log_reader.hpp"
#include "masked_mapper/text/input_error.hpp"

namespace masked_mapper {
namespace {

namespace fs = std::filesystem;

struct Drive {
  std::vector<LaserScan> scans;
  std::vector<Observation> others;
  LogStatistics statistics;
};

Drive ReadDrive(const std::string& path) {
  Drive drive;
  const std::unique_ptr<LogReader> reader = OpenLog(path, {});
  while (std::optional<Observation> observation = reader->Next()) {
    if (auto* scan = std::get_if<LaserScan>(&*observation)) {
      drive.scans.push_back(std::move(*scan));
    } else {
      drive.others.push_back(*observation);
    }
  }
  EXPECT_EQ(reader->Progress(), 1.0);
  drive.statistics = reader->Statistics();
  return drive;
}

std::string Refusal(const std::string& path) {
  try {
    ReadDrive(path);
  } catch (const InputError& error) {
    return error.what();
  }
  return "";
}

class Ros2BagFileTest : public ::testing::Test {
 protected:
  Ros2BagFileTest() : folder_(bag_.path() + ".folder") { fs::create_directory(folder_); }
  ~Ros2BagFileTest() override { fs::remove_all(folder_); }

  const TemporaryFile bag_{".db3"};
  const fs::path folder_;
};

TEST_F(Ros2BagFileTest, EverythingArrives) {
  WriteDrive(bag_.path());
  const Drive drive = ReadDrive(bag_.path());
  ASSERT_EQ(drive.scans.size(), 12U);
  EXPECT_EQ(drive.statistics.odometry, 12U);
  EXPECT_EQ(drive.statistics.bad_lines, 0U);
  EXPECT_FALSE(drive.statistics.truncated);
  EXPECT_EQ(drive.statistics.other_messages.at("/camera (sensor_msgs/msg/Image)"), 12U);
  for (std::size_t i = 0; i < drive.scans.size(); ++i) {
    const LaserScan& scan = drive.scans[i];
    EXPECT_EQ(scan.stamp, 100.5 + static_cast<double>(i));
    EXPECT_NEAR(scan.T_robot_laser.x, 0.2, 1e-12) << "m";
    EXPECT_NEAR(scan.T_robot_laser.theta, 0.5, 1e-12) << "rad";
    ASSERT_TRUE(scan.T_odom_robot);
    EXPECT_NEAR(scan.T_odom_robot->x, 10.0 + 0.1 * static_cast<double>(i), 1e-9) << "m";
    ASSERT_EQ(scan.size(), 5U);
    EXPECT_EQ(scan.ranges[2], 3.0F);
    EXPECT_FALSE(scan.IsHit(3)) << "beyond its limit of 30 m";
  }
  std::size_t readings = 0;
  for (const Observation& other : drive.others) {
    if (const auto* pressure = std::get_if<PressureReading>(&other)) {
      EXPECT_EQ(pressure->pressure_pa, 101325.0 - std::floor(pressure->stamp));
      ++readings;
    }
    if (const auto* reading = std::get_if<AccelerationReading>(&other)) {
      EXPECT_LT((reading->acceleration_in_robot - Eigen::Vector3d(0.0, 1.0, 9.81)).norm(), 1e-9);
      ++readings;
    }
  }
  EXPECT_EQ(readings, 24U);
}

TEST_F(Ros2BagFileTest, MessagesMayBePackedEachOnItsOwn) {
  {
    Ros2BagWriter bag(bag_.path());
    bag.AddTables();
    bag.AddTopic(1, "/scan", "sensor_msgs/msg/LaserScan");
    for (int second = 7; second < 12; ++second) {
      const std::string scan = CdrScan(second, {1, 2, 3});
      bag.AddMessage(1, second + 0.5, second == 9 ? scan : ZstdPacked(scan));
    }
    bag.AddMessage(1, 12.5, ZstdPacked(CdrScan(12, {1, 2, 3})).substr(0, 20));
  }
  const Drive drive = ReadDrive(bag_.path());
  EXPECT_EQ(drive.scans.size(), 5U);
  EXPECT_EQ(drive.statistics.bad_lines, 1U);
}

TEST_F(Ros2BagFileTest, AFolderIsReadInOrderOfTime) {
  std::ofstream(folder_ / "metadata.yaml") << "rosbag2_bagfile_information:\n";
  WriteDrive((folder_ / "drive_10.db3").string(), 124);
  WriteDrive((folder_ / "drive_9.db3").string(), 112);
  WriteDrive((folder_ / "drive_0.db3").string(), 100);
  const Drive drive = ReadDrive(folder_.string());
  ASSERT_EQ(drive.scans.size(), 36U);
  for (std::size_t i = 0; i < 36; ++i) {
    EXPECT_EQ(drive.scans[i].stamp, 100.5 + static_cast<double>(i));
  }
  EXPECT_EQ(drive.statistics.stamp_jumps, 0U);
}

TEST_F(Ros2BagFileTest, ReadsWhatAnUnclosedRecordingLeftBesideTheFile) {
  Ros2BagWriter bag(bag_.path());
  bag.Run("PRAGMA journal_mode = WAL");
  bag.AddTables();
  bag.AddTopic(1, "/scan", "sensor_msgs/msg/LaserScan");
  bag.AddMessage(1, 7.5, CdrScan(7, {1, 2, 3}));
  EXPECT_EQ(ReadDrive(bag_.path()).scans.size(), 1U);
}

TEST_F(Ros2BagFileTest, BigEndianMessagesAndSeveralEchoes) {
  const auto bytes = [](const std::string& text) {
    return reinterpret_cast<const unsigned char*>(text.data());
  };
  const std::string swapped = CdrScan(9, {1, 2, 3}, Cdr::BIG_ENDIANNESS);
  const auto scan = ParseLaserScan(bytes(swapped), swapped.size(), MessageEncoding::kCdr);
  ASSERT_TRUE(scan);
  EXPECT_EQ(scan->header.stamp, 9.5);
  EXPECT_EQ(scan->header.frame_id, "laser");
  EXPECT_EQ(scan->ranges, (std::vector<float>{1, 2, 3}));
  const std::string echoes = CdrMultiEchoScan(9, {{1, 2}, {}, {3}}, {{5, 6}, {}, {7}});
  const auto strongest = ParseMultiEchoLaserScan(bytes(echoes), echoes.size(),
                                                 EchoChoice::kStrongest, MessageEncoding::kCdr);
  ASSERT_TRUE(strongest);
  EXPECT_EQ(strongest->ranges[0], 2.0F);
  EXPECT_TRUE(std::isnan(strongest->ranges[1]));
  EXPECT_EQ(strongest->ranges[2], 3.0F);
}

TEST_F(Ros2BagFileTest, ACutMessageIsNoneAndAHostileCountAllocatesNothing) {
  std::string scan = CdrScan(9, {1, 2, 3});
  const auto parse = [](const std::string& bytes) {
    return ParseLaserScan(reinterpret_cast<const unsigned char*>(bytes.data()), bytes.size(),
                          MessageEncoding::kCdr);
  };
  ASSERT_TRUE(parse(scan));
  for (std::size_t length = 0; length < scan.size(); ++length) {
    EXPECT_FALSE(parse(scan.substr(0, length))) << length;
  }
  for (std::size_t at = 4; at + 4 <= scan.size(); at += 4) {
    std::string hostile = scan;
    hostile.replace(at, 4, "\xff\xff\xff\xff");
    parse(hostile);
    hostile.replace(at, 4, std::string("\x03\x00\x00\x40", 4));
    parse(hostile);
  }
}

TEST_F(Ros2BagFileTest, MalformedMessagesAreSkippedAndCounted) {
  WriteDrive(bag_.path());
  {
    Ros2BagWriter bag(bag_.path());
    bag.AddTopic(9, "/scan_of_another_kind", "sensor_msgs/msg/LaserScan", "json");
    bag.AddMessage(1, 112.5, "garbage");
    bag.AddMessage(9, 112.5, "{}");
    bag.AddMessage(77, 112.5, CdrScan(112, {1, 2}));
    bag.AddMessage(1, 113.5, CdrScan(113, {1, 2, 3, 4, 5}));
  }
  const Drive drive = ReadDrive(bag_.path());
  EXPECT_EQ(drive.scans.size(), 13U);
  EXPECT_EQ(drive.statistics.bad_lines, 2U) << "one malformed, one of no topic";
  EXPECT_EQ(drive.statistics.other_messages.at(
                "/scan_of_another_kind (sensor_msgs/msg/LaserScan as json)"),
            1U);
}

TEST_F(Ros2BagFileTest, RefusesWithOneLine) {
  std::ofstream(folder_ / "metadata.yaml") << "rosbag2_bagfile_information:\n";
  EXPECT_NE(Refusal(folder_.string()).find("holds no .db3 and no .mcap file"), std::string::npos);
  std::ofstream(folder_ / "drive_0.db3") << "no database";
  EXPECT_NE(Refusal(folder_.string()).find("is not a ROS bag"), std::string::npos);
  {
    Ros2BagWriter other(bag_.path());
    other.Run("CREATE TABLE something(else_)");
  }
  EXPECT_NE(Refusal(bag_.path()).find("without the table `topics`"), std::string::npos);
  {
    Ros2BagWriter compressed(bag_.path());
    compressed.AddTables();
    compressed.AddTopic(1, "/scan", "sensor_msgs/msg/LaserScan");
    compressed.AddMessage(1, 7.0, "\x28\xb5\x2f\xfd and so on");
  }
  EXPECT_NE(Refusal(bag_.path()).find("no scan that can be read"), std::string::npos);
}

TEST_F(Ros2BagFileTest, TablesThatComputeAreRefused) {
  for (const char* messages :
       {"CREATE VIEW messages AS WITH RECURSIVE n(id) AS (SELECT 1 UNION ALL SELECT id + 1 FROM n) "
        "SELECT id, 1 AS topic_id, 1 AS timestamp, zeroblob(1000000) AS data FROM n",
        "CREATE TABLE messages(id INTEGER PRIMARY KEY, topic_id, timestamp, "
        "data BLOB GENERATED ALWAYS AS (zeroblob(50000000)))"}) {
    const TemporaryFile file(".db3");
    {
      Ros2BagWriter bag(file.path());
      bag.AddTables();
      bag.AddTopic(1, "/scan", "sensor_msgs/msg/LaserScan");
      bag.Run("DROP TABLE messages");
      bag.Run(messages);
    }
    EXPECT_NE(Refusal(file.path()).find("`messages` is not a plain table"), std::string::npos);
  }
}

TEST_F(Ros2BagFileTest, SurvivesCutsAndGarbledBytes) {
  WriteDrive(bag_.path());
  const std::string good = bag_.Read();
  std::mt19937 random(5);
  const TemporaryFile spoilt(".db3");
  std::size_t some_scans = 0;
  for (int i = 0; i < 200; ++i) {
    std::string bytes = good;
    if (i % 4 == 0) {
      bytes.resize(16 + random() % (bytes.size() - 16));
    } else {
      for (int k = 0; k < 8; ++k) {
        bytes[16 + random() % (bytes.size() - 16)] = static_cast<char>(random());
      }
    }
    spoilt.Write(bytes);
    try {
      some_scans += ReadDrive(spoilt.path()).scans.empty() ? 0 : 1;
    } catch (const InputError& error) {
      EXPECT_EQ(std::string(error.what()).find('\n'), std::string::npos);
    }
  }
  EXPECT_GT(some_scans, 20U) << "what is left of a damaged bag is read";
}

}  // namespace
}  // namespace masked_mapper
