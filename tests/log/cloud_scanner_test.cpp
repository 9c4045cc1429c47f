// SPDX-License-Identifier: BSD-3-Clause
// Clouds of a bag as virtual scans.
#include "log/cloud_scanner.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <map>
#include <sstream>

#include "log/bag_drive.hpp"
#include "log/cloud_bytes.hpp"
#include "log/open_bag.hpp"
#include "masked_mapper/log/packed_cloud.hpp"
#include "masked_mapper/text/input_error.hpp"
#include "sensor/room_cloud.hpp"

namespace masked_mapper {
namespace {

constexpr double kHeight = 0.6;  // m, of the lidar above the floor

CloudBytes AsMessage(const CloudPoints& points, double stamp, const std::vector<double>& times) {
  std::vector<std::vector<double>> rows;
  for (std::size_t i = 0; i < points.size(); ++i) {
    const Eigen::Vector3f& p = points[i].position;
    rows.push_back({p.x(), p.y(), p.z(), times.empty() ? 0.0 : times[i]});
  }
  CloudBytes cloud = CloudOf({{"x", 0}, {"y", 4}, {"z", 8}, {"time", 12}}, 16, rows);
  cloud.stamp = stamp;
  return cloud;
}

std::string Connections(bool with_scans) {
  const std::string scans = ConnectionRecord(3, "/scan", "sensor_msgs/LaserScan", kLaserScanMd5);
  return (with_scans ? scans : "") +
         ConnectionRecord(1, "/points", "sensor_msgs/PointCloud2", kPointCloud2Md5) +
         ConnectionRecord(2, "/tf", "tf2_msgs/TFMessage", "94810edda583a504dfda3829e70d7eec");
}

std::string TransformBytes(double stamp, const std::string& parent, const std::string& child,
                           const Eigen::Isometry3d& T) {
  std::string bytes = Raw(std::uint32_t{1}) + bag_drive::Header(stamp, parent) + WithLength(child);
  const Eigen::Quaterniond q(T.linear());
  for (const double value : {T.translation().x(), T.translation().y(), T.translation().z(), q.x(),
                             q.y(), q.z(), q.w()}) {
    bytes += Raw(value);
  }
  return bytes;
}

std::string Bag(const std::string& records, bool with_scans = false) {
  return BagMagic() + BagHeaderRecord(0, 0, 0) + ChunkRecord(Connections(with_scans) + records);
}

/// The lidar hangs 0.2 m ahead, tilted 4 degrees, on a robot that stands in the middle of the room.
std::string StandingBag(int clouds, bool with_scans) {
  RoomCloud room;
  room.T_world_lidar = Tilted(0.0, 4.0, kHeight);
  const CloudPoints points = room.Seen();
  Eigen::Isometry3d T_robot_lidar = room.T_world_lidar;
  T_robot_lidar.translation().x() = 0.2;
  std::string records =
      bag_drive::Record(2, 100.0, TransformBytes(100.0, "base_link", "lidar", T_robot_lidar));
  for (int i = 0; i < clouds; ++i) {
    const double stamp = 100.0 + 0.1 * i;
    records += bag_drive::Record(1, stamp, AsMessage(points, stamp, {}).Ros1());
    if (!with_scans) continue;
    bag_drive::ScanSpec scan;
    scan.stamp = stamp;
    scan.ranges = bag_drive::RangesOfScan(i);
    records += bag_drive::Record(3, stamp, bag_drive::ScanBytes(scan));
  }
  return Bag(records, with_scans);
}

std::vector<LaserScan> ScansOf(const std::string& bytes, const LogOptions& options = {}) {
  const TemporaryFile file(".bag", bytes);
  LogSource source(file.path(), options);
  return bag_drive::ReadSource(source).scans;
}

TEST(CloudScannerTest, CloudsOfABagAreScansMountedByTf) {
  const std::vector<LaserScan> scans = ScansOf(StandingBag(5, false));
  ASSERT_EQ(scans.size(), 5U);
  const LaserScan& scan = scans.back();
  EXPECT_NEAR(scan.stamp, 100.4, 1e-6);
  EXPECT_NEAR(scan.T_robot_laser.x, 0.2, 0.01);
  int hits = 0;
  for (std::size_t beam = 0; beam < scan.size(); ++beam) {
    if (!scan.IsHit(beam)) continue;
    ++hits;
    const double x = scan.ranges[beam] * std::cos(scan.Angle(beam));
    const double y = scan.ranges[beam] * std::sin(scan.Angle(beam));
    EXPECT_NEAR(std::max(std::abs(x) - 6.0, std::abs(y) - 4.0), 0.0, 0.1);
  }
  EXPECT_GT(hits, static_cast<int>(0.9 * static_cast<double>(scan.size())));
}

TEST(CloudScannerTest, ScansGoBeforeCloudsUnlessTheUserSaysOtherwise) {
  const std::string bag = StandingBag(3, true);
  EXPECT_EQ(ScansOf(bag).front().size(), bag_drive::RangesOfScan(0).size());
  LogOptions options;
  options.scan_topic = "/points";
  EXPECT_GT(ScansOf(bag, options).front().size(), 100U);
}

TEST(CloudScannerTest, ASweepInATurnIsStraightened) {
  // 1.5 rad/s: a sweep of 0.1 s turns the far wall by half a metre where it is not straightened.
  constexpr double kRate = 1.5;
  RoomCloud room;
  const CloudPoints still = room.Seen();
  std::string records;
  for (int i = 0; i < 20; ++i) {
    const double stamp = 100.0 + 0.1 * i;
    for (int k = 0; k < 5; ++k) {
      const double t = stamp + 0.02 * k;
      records += bag_drive::Record(
          2, t,
          bag_drive::TransformBytes(t, "odom", "base_link", {0.001 * i, 0.0, kRate * (t - 100.0)}));
    }
    CloudPoints turned = still;
    std::vector<double> times;
    for (std::size_t j = 0; j < turned.size(); ++j) {
      times.push_back(-0.1 * static_cast<double>(j) / static_cast<double>(turned.size()));
      const Eigen::Rotation2Df back(static_cast<float>(-kRate * (stamp - 100.0 + times[j])));
      turned[j].position.head<2>() = back * turned[j].position.head<2>();
    }
    CloudBytes message = AsMessage(turned, stamp, times);
    message.frame = "base_link";
    records += bag_drive::Record(1, stamp + 0.005, message.Ros1());
  }
  const std::vector<LaserScan> scans = ScansOf(Bag(records));
  ASSERT_EQ(scans.size(), 20U);
  const LaserScan& scan = scans[15];
  int hits = 0;
  for (std::size_t beam = 0; beam < scan.size(); ++beam) {
    if (!scan.IsHit(beam)) continue;
    ++hits;
    const double turn = scan.Angle(beam) + kRate * (scan.stamp - 100.0);
    const double x = scan.ranges[beam] * std::cos(turn);
    const double y = scan.ranges[beam] * std::sin(turn);
    EXPECT_NEAR(std::max(std::abs(x) - 6.0, std::abs(y) - 4.0), 0.0, 0.06);
  }
  EXPECT_GT(hits, static_cast<int>(0.9 * static_cast<double>(scan.size())));
}

TEST(CloudScannerTest, AHostileCloudIsOneClearLine) {
  CloudBytes cloud = AsMessage(RoomCloud().Seen(), 100.0, {});
  cloud.point_step = 4294967295U;
  const std::string bag = Bag(bag_drive::Record(1, 100.0, cloud.Ros1()));
  try {
    ScansOf(bag);
    FAIL() << "expected an InputError";
  } catch (const InputError& error) {
    const std::string text = error.what();
    EXPECT_NE(text.find("on /points is a PointCloud2 that holds"), std::string::npos) << text;
    EXPECT_EQ(text.find('\n'), std::string::npos);
  }
}

TEST(RobotMotionTest, GravityTellsUpAndBrakingHardlyLeansIt) {
  RobotMotion motion;
  EXPECT_FALSE(motion.Up());
  double stamp = 0.0;
  const Eigen::Vector3d up = Tilted(5.0, 2.0, 0.0).linear() * Eigen::Vector3d(0.0, 0.0, 9.81);
  for (; stamp < 5.0; stamp += 0.01) motion.Add(AccelerationReading{stamp, up});
  EXPECT_GT(motion.Up()->dot(up.normalized()), std::cos(DegToRad(0.1)));
  for (; stamp < 5.5; stamp += 0.01) {
    motion.Add(AccelerationReading{stamp, up + Eigen::Vector3d(-1.0, 0.0, 0.0)});
  }
  EXPECT_GT(motion.Up()->dot(up.normalized()), std::cos(DegToRad(2.0)));
}

TEST(RobotMotionTest, GoesOnAsItWentAndStandsWhereNothingIsTold) {
  RobotMotion motion;
  EXPECT_EQ(motion.Between(1.0, 2.0).AsVector(), Pose2{}.AsVector());
  for (int i = 0; i < 100; ++i) motion.Add(OdometryReading{0.1 * i, {0.1 * i, 0.0, 0.0}});
  EXPECT_NEAR(motion.Between(9.0, 9.25).x, 0.25, 1e-9);
  EXPECT_NEAR(motion.Between(9.9, 10.0).x, 0.1, 1e-9);   // beyond the last reading
  EXPECT_NEAR(motion.Between(20.0, 20.1).x, 0.0, 1e-9);  // long after it
}

TEST(KeptPlacesTest, CloudsAreKeptWhereTheRobotWentOn) {
  const auto kept = [](double speed, double rate, bool has_odometry) {
    RobotMotion motion;
    KeptPlaces places;
    int count = 0;
    for (int i = 0; i < 200; ++i) {  // 20 s
      const double t = 0.1 * i;
      if (has_odometry) motion.Add(OdometryReading{t, {speed * t, 0.0, rate * t}});
      count += places.IsNext(t, motion) ? 1 : 0;
    }
    return count;
  };
  EXPECT_EQ(kept(0.0, 0.0, true), 1);
  EXPECT_NEAR(kept(0.5, 0.0, true), 1 + 10.0 / 0.3, 5);
  EXPECT_NEAR(kept(0.0, 0.5, true), 1 + RadToDeg(10.0) / 20.0, 4);
  EXPECT_NEAR(kept(0.5, 0.0, false), 40, 2);  // two a second
}

TEST(KeptPlacesTest, APassKeepsCloudsWhereTheyAreAskedFor) {
  const TemporaryFile file(".bag", StandingBag(12, false));
  LogSource source(file.path(), {});
  bag_drive::ReadSource(source);
  EXPECT_TRUE(source.KeptClouds().empty());
  LogSource keeping(file.path(), {});
  keeping.KeepClouds();
  const double stamp = bag_drive::ReadSource(keeping).scans.front().log_stamp;
  const std::vector<StampedCloud> clouds = keeping.KeptClouds();
  ASSERT_EQ(clouds.size(), 3U);  // without odometry two a second
  EXPECT_EQ(clouds[0].log_stamp, stamp);
  const auto cloud = UnpackCloud(*clouds[0].packed);
  ASSERT_TRUE(cloud);
  EXPECT_GT(cloud->points.size(), 1000U);
  EXPECT_NEAR(cloud->lidar.z(), kHeight, 0.05);  // levelled
}

// The four clouds and the bag are not ours, and looked at where they are.

/// A cloud file as the message that its driver would have sent; count, nearest and farthest of the
/// points in it.
struct RealCloud {
  CloudBytes message;
  std::size_t points = 0;
  double highest = 0.0;  ///< m
  double farthest = 0.0;
};

RealCloud FromPcd(const std::string& path) {
  std::ifstream file(path, std::ios::binary);
  RealCloud cloud;
  std::map<std::string, std::vector<std::string>> header;
  for (std::string line; std::getline(file, line);) {
    std::istringstream words(line);
    std::string key;
    words >> key;
    for (std::string word; words >> word;) header[key].push_back(word);
    if (key == "DATA") break;
  }
  std::uint32_t offset = 0;
  for (std::size_t i = 0; i < header["FIELDS"].size(); ++i) {
    const int size = std::stoi(header["SIZE"][i]);
    const bool is_float = header["TYPE"][i] == "F";
    const std::uint8_t type = is_float ? (size == 4 ? 7 : 8) : (size == 1 ? 2 : size == 2 ? 4 : 6);
    cloud.message.fields.push_back({header["FIELDS"][i], offset, type});
    offset += static_cast<std::uint32_t>(size);
  }
  cloud.points = std::stoul(header["POINTS"][0]);
  cloud.message.width = static_cast<std::uint32_t>(cloud.points);
  cloud.message.point_step = offset;
  cloud.message.row_step = cloud.message.width * offset;
  cloud.message.data.resize(cloud.message.row_step);
  file.read(cloud.message.data.data(), static_cast<std::streamsize>(cloud.message.data.size()));
  for (std::size_t i = 0; i < cloud.points; ++i) {
    std::array<float, 3> p{};
    std::memcpy(p.data(), cloud.message.data.data() + i * offset, sizeof(p));
    cloud.highest = std::max<double>(cloud.highest, p[2]);
    cloud.farthest = std::max<double>(cloud.farthest, std::hypot(p[0], p[1], p[2]));
  }
  return cloud;
}

class RealCloudTest : public ::testing::TestWithParam<const char*> {};

TEST_P(RealCloudTest, IsReadFromABagAndCut) {
  const std::string path =
      std::string(MASKED_MAPPER_REAL_LOGS) + "/clouds/" + GetParam() + "_cloud.pcd";
  if (!std::filesystem::exists(path)) GTEST_SKIP() << path << " is not here";
  const RealCloud cloud = FromPcd(path);
  const TemporaryFile file(".bag", Bag(bag_drive::Record(1, 100.0, cloud.message.Ros1())));
  const std::unique_ptr<RosBag> bag = OpenBag(file.path());
  const std::optional<BagMessage> message = bag->Next();
  ASSERT_TRUE(message);
  const auto parsed = ParsePointCloud(message->data, message->size, message->encoding);
  ASSERT_TRUE(parsed);
  EXPECT_EQ(parsed->points.size(), cloud.points);
  double highest = 0.0;
  double farthest = 0.0;
  for (const CloudPoint& point : parsed->points) {
    highest = std::max<double>(highest, point.position.z());
    farthest = std::max<double>(farthest, point.position.norm());
  }
  EXPECT_NEAR(highest, cloud.highest, 1e-6);
  EXPECT_NEAR(farthest, cloud.farthest, 1e-4);
  LogSource source(file.path(), {});
  const std::vector<LaserScan> scans = bag_drive::ReadSource(source).scans;
  ASSERT_EQ(scans.size(), 1U);
  const auto hits = std::count_if(scans[0].ranges.begin(), scans[0].ranges.end(),
                                  [](float range) { return std::isfinite(range); });
  EXPECT_GT(hits, 200);
}

INSTANTIATE_TEST_SUITE_P(Lidars, RealCloudTest,
                         ::testing::Values("vlp16", "vlp32", "hesai_xt32", "hesai_qt128"));

TEST(CloudScannerTest, ARealBagOfACloud) {
  const std::string path =
      std::string(MASKED_MAPPER_REAL_LOGS) + "/bags/pointcloud2_124914pts_lz4_ros1.bag";
  if (!std::filesystem::exists(path)) GTEST_SKIP() << path << " is not here";
  const std::unique_ptr<RosBag> bag = OpenBag(path);
  std::size_t clouds = 0;
  while (const std::optional<BagMessage> message = bag->Next()) {
    if (bag->Connections().at(message->connection).type != "sensor_msgs/PointCloud2") continue;
    ++clouds;
    const auto parsed = ParsePointCloud(message->data, message->size, message->encoding);
    ASSERT_TRUE(parsed) << FaultOfPointCloud(message->data, message->size, message->encoding);
    EXPECT_EQ(parsed->points.size(), 124914U);
  }
  EXPECT_GT(clouds, 0U);
  LogSource source(path, {});
  EXPECT_EQ(bag_drive::ReadSource(source).scans.size(), clouds);
}

}  // namespace
}  // namespace masked_mapper
