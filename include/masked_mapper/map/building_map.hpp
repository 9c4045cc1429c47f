// SPDX-License-Identifier: BSD-3-Clause
// What mapping a log leaves behind; every export is written from this.
#pragma once

#include <Eigen/Core>
#include <array>
#include <chrono>
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "masked_mapper/log/log_reader.hpp"
#include "masked_mapper/map/closure.hpp"
#include "masked_mapper/pose_graph/pose_graph.hpp"
#include "masked_mapper/sensor/laser_scan.hpp"
#include "masked_mapper/sensor/motion_source.hpp"
#include "masked_mapper/sensor/sensor_finding.hpp"

namespace masked_mapper {

/// What people wrote into a map: places with a name, and areas.
struct NamedPlace {
  std::string name;  ///< unique in its map; letters, digits, `_`, `.` and `-`
  FloorId floor = 0;
  Eigen::Vector2d at_in_world = Eigen::Vector2d::Zero();
};

enum class AreaKind {
  kKeepOut,  ///< nothing in it counts as free
  kErased,   ///< no wall in it counts
};
constexpr std::array<const char*, 2> NamesOf(AreaKind /*any*/) { return {"keep_out", "erase"}; }

struct Area {
  AreaKind kind = AreaKind::kKeepOut;
  FloorId floor = 0;
  std::vector<Eigen::Vector2d> corners_in_world;  ///< three or more
};

/// The pose of one scan of the log.
struct TrajectoryPose {
  double stamp = 0.0;      ///< s, never decreasing
  double log_stamp = 0.0;  ///< s, as the log gives it to the scan
  FloorId floor = 0;       ///< in transit: the floor left last
  bool in_transit = false;
  NodeId node_before = 0;  ///< the last node made at or before this scan
  Pose2 T_odom_robot;      ///< along the motion path
  Pose2 T_world_robot;     ///< after optimisation
};

/// A scan kept for rendering (thinned by travelled distance).
struct KeptScan {
  std::size_t trajectory_index = 0;  ///< its pose in BuildingMap::trajectory
  LaserScan scan;
};

/// A cloud kept for what is written in space (thinned by travelled distance).
struct KeptCloud {
  std::size_t trajectory_index = 0;           ///< its pose in BuildingMap::trajectory
  std::shared_ptr<const std::string> packed;  ///< by log/packed_cloud.hpp; never null
};

struct StageSeconds {
  double read = 0.0;
  double motion = 0.0;
  double mask = 0.0;
  double projection = 0.0;
  double matching = 0.0;
  double validation = 0.0;
  double optimisation = 0.0;
  double rendering = 0.0;
  double export_ = 0.0;
  double total = 0.0;

  StageSeconds& operator+=(const StageSeconds& more);
};

/// Adds the time of its scope to a stage's seconds.
class StageTimer {
 public:
  explicit StageTimer(double& seconds) : seconds_(seconds) {}
  ~StageTimer() {
    seconds_ += std::chrono::duration<double>(std::chrono::steady_clock::now() - start_).count();
  }
  StageTimer(const StageTimer&) = delete;
  StageTimer& operator=(const StageTimer&) = delete;

 private:
  double& seconds_;
  std::chrono::steady_clock::time_point start_ = std::chrono::steady_clock::now();
};

/// One log's part of a map: scans, nodes and poses of a drive stand together (map/drives.hpp).
struct Drive {
  std::string log;             ///< path as given
  std::size_t first_pose = 0;  ///< in BuildingMap::trajectory
  NodeId first_node = 0;
  double stamp_offset_s = 0.0;  ///< was added to the log's stamps, which must not step back
  MotionSource motion_source = MotionSource::kFused;  ///< the one that was used
  std::string reason;  ///< of a drive that was to join others: why it did, or did not
};

/// The robot went from one floor to another, or back to the same: those of the poses around.
struct TransitRecord {
  double t_out = 0.0;     ///< s, the floor was left
  double t_in = 0.0;      ///< s, the other one was reached
  double height_m = 0.0;  ///< up
  double sigma_m = 0.0;
  std::vector<std::string> by;  ///< the sensors that decided
  std::string open;             ///< why nobody can tell which floor was reached; empty: it is known
};

struct BuildingMap {
  PoseGraph graph;
  std::vector<TrajectoryPose> trajectory;  ///< one per scan of the logs, in order
  std::vector<KeptScan> kept_scans;        ///< in order
  std::vector<KeptCloud> kept_clouds;      ///< in order; of a 3D lidar
  std::vector<Closure> closures;           ///< every pair that was offered, in order
  std::vector<Drive> drives;               ///< in order; of one log: one
  std::vector<TransitRecord> transits;     ///< of the drives of this run, in order
  std::vector<NamedPlace> places;          ///< in order of naming
  std::vector<Area> areas;                 ///< in order of drawing
  LogStatistics log;
  MotionSource motion_source = MotionSource::kFused;  ///< that of the first drive
  StageSeconds seconds;
  std::vector<SensorFinding> findings;  ///< what the logs' own data say of their sensors
  std::vector<std::string> warnings;    ///< one line each, for people
};

}  // namespace masked_mapper
