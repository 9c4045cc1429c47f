// SPDX-License-Identifier: BSD-3-Clause
// Writing observations as a log whose kind its name says: a ROS 1 bag (`.bag`), ROS 2 messages in
// MCAP (`.mcap`), else CARMEN text, gzip when the name ends in `.gz`.
#pragma once

#include <memory>
#include <optional>
#include <string>

#include "masked_mapper/sensor/lidar_cloud.hpp"
#include "masked_mapper/sensor/observation.hpp"

namespace masked_mapper {

class LogSink;

/// Whose driver's PointCloud2 is written.
enum class CloudLayout {
  kVelodyne,  ///< intensity, ring; `time` in seconds
  kOuster,    ///< intensity; `t` in nanoseconds, as a whole number
  kLivox,     ///< intensity; `timestamp` in nanoseconds of the clock
};

struct CloudReading {
  double stamp = 0.0;  ///< s
  CloudPoints points;  ///< in the lidar's frame
  Eigen::Isometry3d T_robot_lidar = Eigen::Isometry3d::Identity();
  std::optional<Pose2> T_odom_robot;
  CloudLayout layout = CloudLayout::kVelodyne;
};

class LogWriter {
 public:
  /// As text, ranges are written with `range_decimals` digits (1 to 9), poses and stamps with six.
  /// Throws std::runtime_error when the file cannot be created.
  explicit LogWriter(const std::string& path, int range_decimals = 3);
  ~LogWriter();
  LogWriter(const LogWriter&) = delete;
  LogWriter& operator=(const LogWriter&) = delete;

  /// As text, scans are written as ROBOTLASER1 when they carry geometry FLASER cannot say, else as
  /// FLASER with a PARAM for their limit. No return is written as the limit, an invalid range as 0.
  /// A scan without odometry gets the last odometry written (identity before there is any).
  void Write(const Observation& observation);
  /// Throws InputError where the log is text, which has no word for clouds.
  void WriteCloud(const CloudReading& cloud);
  /// A `#` line of text; bags have none.
  void WriteComment(const std::string& text);
  /// Flushes and closes; throws std::runtime_error when anything could not be written (disk full).
  void Close();

 private:
  std::unique_ptr<LogSink> sink_;
};

}  // namespace masked_mapper
