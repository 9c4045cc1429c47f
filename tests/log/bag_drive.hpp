// SPDX-License-Identifier: BSD-3-Clause
// A short drive as a bag made by hand, to be spoilt, and what is to be read of it.
#pragma once

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <string>
#include <vector>

#include "log/bag_bytes.hpp"
#include "log/temporary_file.hpp"
#include "masked_mapper/geometry/pose2.hpp"
#include "masked_mapper/log/log_source.hpp"

namespace masked_mapper::bag_drive {

constexpr double kBegin = 1000.0;  // s
constexpr int kScans = 400;
constexpr double kPeriod = 0.1;  // s

inline std::string Stamp8(double stamp) {
  const auto seconds = static_cast<std::uint32_t>(std::floor(stamp));
  const auto nanoseconds = static_cast<std::uint32_t>(std::lround((stamp - seconds) * 1e9));
  return Raw(seconds) + Raw(nanoseconds);
}

inline std::string Header(double stamp, const std::string& frame) {
  return Raw(std::uint32_t{0}) + Stamp8(stamp) + WithLength(frame);
}

inline std::string Record(std::uint32_t id, double recorded, const std::string& data) {
  return BagRecord({{"op", Op(2)}, {"conn", Raw(id)}, {"time", Stamp8(recorded)}}, data);
}

struct ScanSpec {
  double stamp = 0.0;
  std::string frame = "laser";
  float range_min = 0.1F;
  float range_max = 30.0F;
  std::vector<float> ranges;
};

inline std::string ScanBytes(const ScanSpec& scan) {
  std::string bytes = Header(scan.stamp, scan.frame);
  const auto beams = static_cast<std::uint32_t>(scan.ranges.size());
  for (const float value : {-1.0F, 1.0F, 2.0F / static_cast<float>(beams), 0.0F, 0.0F,
                            scan.range_min, scan.range_max}) {
    bytes += Raw(value);
  }
  bytes += Raw(beams);
  for (const float range : scan.ranges) bytes += Raw(range);
  return bytes + Raw(std::uint32_t{0});
}

inline std::string TransformBytes(double stamp, const std::string& parent, const std::string& child,
                                  const Pose2& T) {
  std::string bytes = Raw(std::uint32_t{1}) + Header(stamp, parent) + WithLength(child);
  for (const double value :
       {T.x, T.y, 0.0, 0.0, 0.0, std::sin(T.theta / 2.0), std::cos(T.theta / 2.0)}) {
    bytes += Raw(value);
  }
  return bytes;
}

inline double StampOfScan(int i) { return kBegin + kPeriod * i + 0.0125; }

/// Walls that come nearer, then farther: nothing of them is part of the robot.
inline std::vector<float> RangesOfScan(int i) {
  std::vector<float> ranges;
  for (int beam = 0; beam < 40; ++beam) {
    ranges.push_back(3.0F + 0.05F * static_cast<float>(beam) +
                     std::sin(0.02F * static_cast<float>(i)));
  }
  return ranges;
}

/// A drive along x at 1 m/s: a scan and a transform of odometry each kPeriod.
struct Drive {
  std::string odometry_frame = "odom";
  double mount_comes = kBegin;
  std::function<void(int, ScanSpec*)> spoil = [](int, ScanSpec*) {};

  static std::string Connections() {
    return ConnectionRecord(1, "/scan", "sensor_msgs/LaserScan", kLaserScanMd5) +
           ConnectionRecord(2, "/tf", "tf2_msgs/TFMessage", "94810edda583a504dfda3829e70d7eec") +
           ConnectionRecord(3, "/tf_static", "tf2_msgs/TFMessage",
                            "94810edda583a504dfda3829e70d7eec");
  }
  std::string Mount() const {
    return Record(3, mount_comes, TransformBytes(kBegin, "base_link", "laser", {0.2, 0.0, kPi}));
  }
  std::string ScanOf(int i) const {
    ScanSpec scan;
    scan.stamp = StampOfScan(i);
    scan.ranges = RangesOfScan(i);
    spoil(i, &scan);
    return Record(1, StampOfScan(i), ScanBytes(scan));
  }
  std::string OdometryOf(int i) const {
    const double stamp = kBegin + kPeriod * i;
    return Record(2, stamp,
                  TransformBytes(stamp, odometry_frame, "base_link", {kPeriod * i, 0.0, 0.0}));
  }
  /// Messages `begin` to `end` in the order of recording.
  std::string Part(int begin, int end) const {
    std::string records;
    for (int i = begin; i < end; ++i) {
      const double stamp = kBegin + kPeriod * i;
      if (mount_comes >= stamp && mount_comes < stamp + kPeriod) records += Mount();
      records += OdometryOf(i) + ScanOf(i);
    }
    return records;
  }
  std::string Whole() const { return Bag(Part(0, kScans)); }

  static std::string Bag(const std::string& records) {
    return BagMagic() + BagHeaderRecord(0, 0, 0) + ChunkRecord(Connections() + records);
  }
};

struct Read {
  std::vector<LaserScan> scans;
  std::vector<SensorFinding> findings;
  int passes = 0;
};

inline Read ReadSource(LogSource& source) {
  Read read;
  do {
    ++read.passes;
    read.scans.clear();
    const std::unique_ptr<LogReader> reader = source.Read();
    while (const std::optional<Observation> observation = reader->Next()) {
      if (const auto* scan = std::get_if<LaserScan>(&*observation)) read.scans.push_back(*scan);
    }
  } while (source.Reconsider());
  read.findings = source.Findings();
  return read;
}

inline Read ReadBag(const std::string& bytes, const LogOptions& options = {}) {
  const TemporaryFile file(".bag", bytes);
  LogSource source(file.path(), options);
  return ReadSource(source);
}

/// All of the drive, as it was.
inline void ExpectTheDrive(const Read& read, double stamp_error = 1e-6) {
  ASSERT_EQ(read.scans.size(), static_cast<std::size_t>(kScans));
  for (int i = 0; i < kScans; ++i) {
    const LaserScan& scan = read.scans[static_cast<std::size_t>(i)];
    EXPECT_NEAR(scan.stamp, StampOfScan(i), stamp_error) << i;
    ASSERT_TRUE(scan.T_odom_robot) << i;
    EXPECT_NEAR(scan.T_odom_robot->x, scan.stamp - kBegin, 0.11) << i;
    EXPECT_NEAR(scan.T_robot_laser.x, 0.2, 1e-6);
    EXPECT_NEAR(std::abs(scan.T_robot_laser.theta), kPi, 1e-6);
    EXPECT_NEAR(scan.ranges[5], RangesOfScan(i)[5], 1e-4) << i;
  }
}

}  // namespace masked_mapper::bag_drive
