// SPDX-License-Identifier: BSD-3-Clause
// Clouds of one 3D lidar in, virtual 2D scans out: each cloud is straightened along the motion that
// the wheels tell, levelled and cut (virtual_scan.hpp).
#pragma once

#include <Eigen/Geometry>
#include <deque>
#include <optional>
#include <utility>
#include <vector>

#include "ground.hpp"
#include "masked_mapper/log/cloud_source.hpp"
#include "masked_mapper/log/log_reader.hpp"
#include "masked_mapper/log/packed_cloud.hpp"
#include "ros_point_cloud.hpp"

namespace masked_mapper {

/// What the log told of the robot up to now, in the order of the log.
class RobotMotion {
 public:
  void Add(const OdometryReading& reading);
  void Add(const AccelerationReading& reading);

  /// T_robot(from)_robot(to), s; beyond the last readings the robot goes on as it went. Where the
  /// log tells no motion it stands.
  Pose2 Between(double from, double to) const;
  /// Whether the log tells how the robot went between two stamps.
  bool Tells(double from, double to) const;
  /// Where up is in the robot frame; empty without an accelerometer.
  std::optional<Eigen::Vector3d> Up() const;

 private:
  Pose2 At(double stamp) const;

  std::deque<std::pair<double, Pose2>> odometry_;  ///< of the last seconds, by stamps
  std::optional<std::pair<double, Eigen::Vector3d>> gravity_;
};

/// Which clouds of a drive are worth keeping: those before which the robot went on.
class KeptPlaces {
 public:
  /// For clouds in order of stamps.
  bool IsNext(double stamp, const RobotMotion& motion);

 private:
  std::optional<double> stamp_;  ///< of the cloud before
  double kept_at_ = 0.0;         ///< stamp
  Pose2 since_kept_;             ///< T_then_now of the robot
};

class CloudScanner {
 public:
  CloudScanner(const LogOptions& options, const Eigen::Isometry3d& T_robot_lidar, float max_range);

  /// `stamp` is that of the cloud in the clock of the log, as below.
  LevelledCloud Level(RosPointCloud cloud, double stamp, const RobotMotion& motion);
  /// `keep`, unless null, is given what is worth keeping of the cloud.
  LaserScan Cut(RosPointCloud cloud, double stamp, const RobotMotion& motion,
                std::vector<StampedCloud>* keep);

 private:
  const LogOptions& options_;
  Eigen::Isometry3d T_robot_lidar_;
  float max_range_;
  GroundFinder finder_;
  Ground ground_;  ///< under the last cloud
  KeptPlaces places_;
};

}  // namespace masked_mapper
