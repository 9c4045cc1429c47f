// SPDX-License-Identifier: BSD-3-Clause
#include "masked_mapper/log/log_reader.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <random>
#include <vector>

#include "log/bag_bytes.hpp"
#include "log/temporary_file.hpp"
#include "masked_mapper/geometry/pose2.hpp"
#include "masked_mapper/text/input_error.hpp"

namespace masked_mapper {
namespace {

struct Content {
  std::vector<LaserScan> scans;
  std::vector<OdometryReading> odometry;
  std::vector<PressureReading> pressure;
  std::vector<AccelerationReading> acceleration;
  LogStatistics statistics;

  void Take(LaserScan scan) { scans.push_back(std::move(scan)); }
  void Take(OdometryReading reading) { odometry.push_back(reading); }
  void Take(PressureReading reading) { pressure.push_back(reading); }
  void Take(AccelerationReading reading) { acceleration.push_back(reading); }
  void Take(FloorLabel) {}
};

Content ReadAll(const std::string& path, const LogOptions& options = {}) {
  Content content;
  const std::unique_ptr<LogReader> reader = OpenLog(path, options);
  double last_stamp = -1e300;
  while (std::optional<Observation> observation = reader->Next()) {
    EXPECT_GE(Stamp(*observation), last_stamp);
    last_stamp = Stamp(*observation);
    std::visit([&content](auto& reading) { content.Take(std::move(reading)); }, *observation);
  }
  EXPECT_EQ(reader->Progress(), 1.0);
  content.statistics = reader->Statistics();
  return content;
}

std::string Message(const std::string& path, const LogOptions& options = {}) {
  try {
    OpenLog(path, options);
  } catch (const InputError& error) {
    return error.what();
  }
  return "";
}

/// Written by Debian's own rosbag, when it is installed.
class WrittenBagTest : public ::testing::Test {
 protected:
  bool Write(const std::string& compression, const std::string& mode) {
    const std::string command = "/usr/bin/python3 " MASKED_MAPPER_SOURCE_DIR
                                "/tests/log/write_bag.py " +
                                bag_.path() + " " + compression + " " + mode + " >/dev/null 2>&1";
    return std::system(command.c_str()) == 0;
  }

  const TemporaryFile bag_{".bag"};
};

Pose2 TruePose(double stamp) {
  const double angle = 0.1 * (stamp - 1600000000.0);
  return {std::sin(angle), 1.0 - std::cos(angle), angle};
}

double DistanceToWall(const Eigen::Vector2d& point) {
  return std::abs(std::max(std::abs(point.x()) - 5.0, std::abs(point.y()) - 3.0));
}

/// The farthest that a hit lies off the walls of the room when seen from the odometry's pose, m.
double FarthestOffTheWalls(const LaserScan& scan) {
  double farthest = 0.0;
  const ScanPoints::ConstPtr points_in_robot = PointsInRobot(scan);
  for (const pcl::PointXY& point : *points_in_robot) {
    farthest =
        std::max(farthest, DistanceToWall(*scan.T_odom_robot * Eigen::Vector2d(point.x, point.y)));
  }
  return farthest;
}

TEST_F(WrittenBagTest, EverythingArrivesInEveryCompression) {
  for (const char* compression : {"none", "bz2", "lz4"}) {
    if (!Write(compression, "full")) GTEST_SKIP() << "python3-rosbag is not installed";
    const Content content = ReadAll(bag_.path());
    EXPECT_EQ(content.statistics.bad_lines, 0U);
    EXPECT_FALSE(content.statistics.truncated);
    EXPECT_EQ(content.odometry.size(), 200U);
    ASSERT_EQ(content.scans.size(), 100U);
    for (const LaserScan& scan : content.scans) {
      EXPECT_TRUE(scan.IsFullCircle());
      EXPECT_EQ(scan.max_range, 30.0F);
      EXPECT_EQ(scan.ranges[0], kNoReturn);
      EXPECT_TRUE(std::isnan(scan.ranges[1]));
      ASSERT_TRUE(scan.T_odom_robot);
      EXPECT_LT(Distance(*scan.T_odom_robot, TruePose(scan.stamp)), 1e-5) << "m";
      EXPECT_LT(FarthestOffTheWalls(scan), 1e-4) << "m";
    }
    ASSERT_EQ(content.pressure.size(), 50U);
    EXPECT_EQ(content.pressure[1].pressure_pa, 101321.0);
    ASSERT_EQ(content.acceleration.size(), 50U);
    EXPECT_LT(
        (content.acceleration[0].acceleration_in_robot - Eigen::Vector3d(0.0, 1.0, 9.81)).norm(),
        1e-9);
  }
}

TEST_F(WrittenBagTest, TfStandsInForOdometry) {
  if (!Write("none", "tf")) GTEST_SKIP() << "python3-rosbag is not installed";
  const Content content = ReadAll(bag_.path());
  EXPECT_EQ(content.odometry.size(), 200U);
  ASSERT_EQ(content.scans.size(), 100U);
  for (const LaserScan& scan : content.scans) EXPECT_LT(FarthestOffTheWalls(scan), 1e-4) << "m";
}

TEST_F(WrittenBagTest, SeveralTopicsAreListedAndTwoScannersMerged) {
  if (!Write("lz4", "two")) GTEST_SKIP() << "python3-rosbag is not installed";
  EXPECT_NE(Message(bag_.path()).find("/front, /rear"), std::string::npos) << Message(bag_.path());
  LogOptions options;
  options.scan_topic = "/rear";
  Content content = ReadAll(bag_.path(), options);
  ASSERT_EQ(content.scans.size(), 100U);
  EXPECT_LT(content.scans[0].angle_step, 0.0);  // upside down
  for (const LaserScan& scan : content.scans) EXPECT_LT(FarthestOffTheWalls(scan), 1e-4) << "m";
  options.scan_topic = "/front, /rear";
  content = ReadAll(bag_.path(), options);
  ASSERT_EQ(content.scans.size(), 100U);
  EXPECT_EQ(content.odometry.size(), 200U);
  for (const LaserScan& scan : content.scans) {
    EXPECT_TRUE(scan.IsFullCircle());
    EXPECT_GT(PointsInRobot(scan)->size(), 280U);
    EXPECT_LT(FarthestOffTheWalls(scan), 0.06) << "m, half a beam at 6 m";
  }
  options.scan_topic = "/fromt";
  EXPECT_NE(Message(bag_.path(), options).find("/front"), std::string::npos);
}

TEST_F(WrittenBagTest, TheChosenEchoStandsForItsBeam) {
  if (!Write("none", "multi_echo")) GTEST_SKIP() << "python3-rosbag is not installed";
  const Content first = ReadAll(bag_.path());
  LogOptions options;
  options.strongest_echo = true;
  const Content strongest = ReadAll(bag_.path(), options);
  ASSERT_EQ(first.scans.size(), 100U);
  EXPECT_LT(FarthestOffTheWalls(first.scans[5]), 1e-4) << "m";
  EXPECT_NEAR(strongest.scans[5].ranges[20] - first.scans[5].ranges[20], 1.0, 1e-5);
}

TEST_F(WrittenBagTest, AmbiguousOrMissingTopicsAreTheUsersToChoose) {
  if (!Write("none", "two_odometries")) GTEST_SKIP() << "python3-rosbag is not installed";
  EXPECT_NE(Message(bag_.path()).find("log.odometry_topic"), std::string::npos);
  LogOptions options;
  options.odometry_topic = "/odom/filtered";
  EXPECT_EQ(ReadAll(bag_.path(), options).odometry.size(), 200U);
  options.odometry_topic = "none";
  options.imu_topic = "none";
  const Content content = ReadAll(bag_.path(), options);
  EXPECT_TRUE(content.odometry.empty());
  EXPECT_TRUE(content.acceleration.empty());
  EXPECT_FALSE(content.scans[0].T_odom_robot);
  EXPECT_EQ(content.statistics.other_messages.at("/odom (nav_msgs/Odometry)"), 200U);
  ASSERT_TRUE(Write("none", "no_scan"));
  EXPECT_NE(Message(bag_.path()).find("holds no sensor_msgs/LaserScan"), std::string::npos);
}

TEST(OpenRosBagTest, ReadsACutBag) {
  const std::string bytes = ScanBag(true);
  const TemporaryFile file(".bag", bytes.substr(0, bytes.size() * 2 / 3));
  const Content content = ReadAll(file.path());
  EXPECT_GE(content.scans.size(), 6U);
  EXPECT_LT(content.scans.size(), 12U);
  EXPECT_TRUE(content.statistics.truncated);
  const TemporaryFile unindexed(".bag", ScanBag(false));
  EXPECT_EQ(ReadAll(unindexed.path()).scans.size(), 12U);
}

TEST(OpenRosBagTest, RefusesWithOneLine) {
  const TemporaryFile obsolete(".bag", "#ROSBAG V1.2\nxxxx");
  EXPECT_NE(Message(obsolete.path()).find("version 1.2"), std::string::npos);
  const TemporaryFile nothing(".bag", BagMagic() + BagHeaderRecord(0, 0, 0));
  EXPECT_NE(Message(nothing.path())
                .find("holds no sensor_msgs/LaserScan and no PointCloud2 (topics: none)"),
            std::string::npos);
  // The topic is announced, but silent.
  const TemporaryFile silent(".bag", BagMagic() + BagHeaderRecord(0, 0, 0) +
                                         ChunkRecord(ConnectionRecord(
                                             1, "/scan", "sensor_msgs/LaserScan", kLaserScanMd5)));
  EXPECT_NE(Message(silent.path()).find("no scan that can be read"), std::string::npos);
}

TEST(OpenRosBagTest, AllThatIsToBeChosenIsSaidAtOnce) {
  const std::string odometry_md5 = "cd5e73d190d741a2f92e81eda573aca7";
  const TemporaryFile file(
      ".bag", BagMagic() + BagHeaderRecord(0, 0, 0) +
                  ChunkRecord(ConnectionRecord(1, "/a", "sensor_msgs/LaserScan", kLaserScanMd5) +
                              ConnectionRecord(2, "/b", "sensor_msgs/LaserScan", kLaserScanMd5) +
                              ConnectionRecord(3, "/c", "nav_msgs/Odometry", odometry_md5) +
                              ConnectionRecord(4, "/d", "nav_msgs/Odometry", odometry_md5)));
  const std::string message = Message(file.path());
  EXPECT_NE(message.find("log.scan_topic=/a"), std::string::npos) << message;
  EXPECT_NE(message.find("log.odometry_topic=/c"), std::string::npos) << message;
}

TEST(OpenRosBagTest, EveryScannerThatIsNamedMustSpeakAndBeNamedOnce) {
  const std::string records =
      ConnectionRecord(1, "/front", "sensor_msgs/LaserScan", kLaserScanMd5) +
      ConnectionRecord(2, "/rear", "sensor_msgs/LaserScan", kLaserScanMd5) +
      MessageRecord(1, 5, LaserScanBytes(5, 9)) + MessageRecord(1, 6, LaserScanBytes(6, 9));
  const TemporaryFile file(".bag", BagMagic() + BagHeaderRecord(0, 0, 0) + ChunkRecord(records));
  LogOptions options;
  options.scan_topic = "/front,/rear";
  EXPECT_NE(Message(file.path(), options).find("`/rear` holds no scan"), std::string::npos);
  options.scan_topic = "/rear,/front";
  EXPECT_NE(Message(file.path(), options).find("`/rear` holds no scan"), std::string::npos);
  options.scan_topic = "/front, /front";
  EXPECT_NE(Message(file.path(), options).find("names `/front` twice"), std::string::npos);
  options.scan_topic = "/front";
  EXPECT_EQ(ReadAll(file.path(), options).scans.size(), 2U);
}

TEST(OpenRosBagTest, MalformedMessagesAreSkippedAndCounted) {
  const std::string records =
      ConnectionRecord(1, "/scan", "sensor_msgs/LaserScan", kLaserScanMd5) +
      ConnectionRecord(2, "/other", "sensor_msgs/LaserScan", "of another version") +
      MessageRecord(1, 5, LaserScanBytes(5, 9)) + MessageRecord(1, 6, "garbage") +
      MessageRecord(2, 6, LaserScanBytes(6, 9)) + MessageRecord(1, 7, LaserScanBytes(7, 9));
  const TemporaryFile file(".bag", BagMagic() + BagHeaderRecord(0, 0, 0) + ChunkRecord(records));
  const Content content = ReadAll(file.path());
  EXPECT_EQ(content.scans.size(), 2U);
  EXPECT_EQ(content.statistics.bad_lines, 1U);
  EXPECT_EQ(content.statistics.first_bad_line, "message 2 on /scan: malformed");
  EXPECT_EQ(content.statistics.other_messages.size(), 1U);
}

TEST(OpenRosBagTest, SurvivesGarbledBytes) {
  std::mt19937 random(3);
  const std::string good = ScanBag(true);
  for (int i = 0; i < 200; ++i) {
    std::string bytes = good;
    for (int k = 0; k < 8; ++k) {
      bytes[BagMagic().size() + random() % (bytes.size() - BagMagic().size())] =
          static_cast<char>(random());
    }
    const TemporaryFile file(".bag", bytes);
    try {
      const std::unique_ptr<LogReader> reader = OpenLog(file.path(), {});
      while (reader->Next()) {
      }
    } catch (const InputError&) {
    }
  }
}

TEST(OpenRosBagTest, TheSameDriveAsTextAndAsBag) {
  const std::string shared = MASKED_MAPPER_REAL_LOGS;
  const std::string bag = shared + "/bags/mit-csail.bag";
  const std::string text = shared + "/data/mit-csail.clf.gz";
  if (!std::filesystem::exists(bag) || !std::filesystem::exists(text)) {
    GTEST_SKIP() << bag << " is not here";
  }
  const Content from_bag = ReadAll(bag);
  const Content from_text = ReadAll(text);
  ASSERT_EQ(from_bag.scans.size(), from_text.scans.size());
  for (std::size_t i = 0; i < from_bag.scans.size(); ++i) {
    const LaserScan& a = from_bag.scans[i];
    const LaserScan& b = from_text.scans[i];
    ASSERT_NEAR(a.stamp, b.stamp, 1e-6);
    ASSERT_NEAR(a.first_angle, b.first_angle, 1e-6);
    ASSERT_NEAR(a.angle_step, b.angle_step, 1e-8);
    ASSERT_LT(Distance(*a.T_odom_robot, *b.T_odom_robot), 1e-6) << "m";
    ASSERT_NEAR(WrapAngle(a.T_odom_robot->theta - b.T_odom_robot->theta), 0.0, 1e-6);
    ASSERT_EQ(a.T_robot_laser.AsVector(), b.T_robot_laser.AsVector());
    ASSERT_EQ(a.size(), b.size());
    for (std::size_t beam = 0; beam < a.size(); ++beam) {
      ASSERT_EQ(a.IsHit(beam), b.IsHit(beam)) << i << " " << beam;
      ASSERT_EQ(std::isnan(a.ranges[beam]), std::isnan(b.ranges[beam]));
      if (!a.IsHit(beam)) continue;
      ASSERT_EQ(a.ranges[beam], b.ranges[beam]);
    }
  }
}

TEST(OpenRosBagTest, ABagWithoutOdometryIsReadAllTheSame) {
  const std::string bag =
      std::string(MASKED_MAPPER_REAL_LOGS) + "/bags/laser_scan_matcher_demo.bag";
  if (!std::filesystem::exists(bag)) GTEST_SKIP() << bag << " is not here";
  const Content content = ReadAll(bag);
  EXPECT_EQ(content.scans.size(), 360U);
  EXPECT_EQ(content.scans[0].size(), 681U);
  EXPECT_FALSE(content.scans[0].T_odom_robot);
  EXPECT_FALSE(content.statistics.truncated);
  EXPECT_NEAR(content.statistics.max_range, 5.6, 1e-6);
}

}  // namespace
}  // namespace masked_mapper
