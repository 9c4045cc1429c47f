// SPDX-License-Identifier: BSD-3-Clause
// How the robot moved: by wheels, by scans, or by both; and how sure that is since the last node.
#pragma once

#include <optional>
#include <string>

#include "masked_mapper/motion/dead_reckoning.hpp"
#include "masked_mapper/motion/gyro_bias.hpp"
#include "masked_mapper/motion/scan_odometry.hpp"
#include "masked_mapper/motion/wheel_noise.hpp"
#include "masked_mapper/sensor/motion_source.hpp"
#include "masked_mapper/sensor/observation.hpp"

namespace masked_mapper {

/// What a robot may do between two scans when no wheels tell.
struct WheellessOptions {
  double sigma_speed_m_per_s = 0.4;  ///< about the speed of the step before, in the long run
  /// By which it changes from one step to the next. Where walls are blank along the way (a flight
  /// of stairs), this holds the way against what little seems to be seen of it.
  double sigma_acceleration_m_per_s2 = 1.0;
  double sigma_turn_deg_per_s = 40.0;  ///< about the turn of the step before
};

struct MotionOptions {
  MotionSource source = MotionSource::kAuto;  ///< kAuto is settled before a drive begins
  double longest_step_m = 2.0;     ///< from scan to scan; beyond it they share too little view
  double longest_turn_deg = 60.0;  ///< the same
  /// Not where a survey found turns by wheels to be of no use: their way is a length then, and the
  /// direction is that of the step before.
  bool wheels_tell_turns = true;
  DeadReckoningOptions odometry;
  ScanOdometryOptions scans;
  WheelNoiseOptions wheel_noise;
  GyroBiasOptions gyro_bias;
  WheellessOptions wheelless;
};

/// A scan straightened for a robot that goes on as in the step before it.
LaserScan StraightenedBySteps(LaserScan scan, const Pose2& T_before_now, double seconds);

/// The same, of a robot whose wheels are not asked.
inline MotionOptions ScansAlone(MotionOptions options) {
  options.source = MotionSource::kScans;
  return options;
}

class MotionEstimator {
 public:
  explicit MotionEstimator(const MotionOptions& options);

  /// Observations in order of stamps. The path moves at scans; readings between them gather.
  /// A scan that is still bent (`beam_time`) is straightened by the step before.
  /// `must_match`: the scene is about to be left, so that no correction may wait.
  /// A scan before which the wheels were silent moved as scans say: silence is no rest.
  void Observe(const OdometryReading& reading);
  void Observe(const LaserScan& scan, bool must_match = false);
  /// A node was made at the scan observed last: motion and uncertainty are counted from now on.
  void StartNode() { T_node_robot_ = UncertainPose2{}; }
  /// The robot is in a cab: only what is near stays the same when a door opens.
  void EnterTransit();
  /// It is said to be on a floor again: the next scan is aligned to none before it.
  void LeaveTransit();

  /// Pose at the scan observed last, along the path; frame `odom` is the robot's first pose.
  const Pose2& T_odom_robot() const { return T_odom_robot_; }
  /// Motion since the last node, with covariance in the node's frame.
  const UncertainPose2& T_node_robot() const { return T_node_robot_; }

  /// The state, for a checkpoint (mapping/state_archive.hpp).
  template <class Archive>
  void Serialize(Archive& archive) {
    archive(wheels_, gyro_bias_, scan_odometry_, wheel_noise_, last_scan_stamp_, last_step_,
            last_step_s_, advance_m_, in_transit_, was_heard_, is_heard_, T_odom_robot_,
            T_node_robot_);
  }

 private:
  void RestartScans();
  bool HearsWheels(const LaserScan& scan);
  UncertainPose2 StepWithoutWheels(double stamp) const;
  UncertainPose2 StepWithoutTurns(double stamp) const;
  void NoteAdvance(double wheel_travel_m, double advance_m);
  void LearnWheelNoise(const Pose2& by_wheels, const Pose2& corrected);

  MotionOptions options_;
  DeadReckoning wheels_;  ///< since the scan before
  GyroBias gyro_bias_;
  ScanOdometry scan_odometry_;
  WheelNoise wheel_noise_;
  std::optional<double> last_scan_stamp_;
  UncertainPose2 last_step_;
  double last_step_s_ = 0.0;
  double advance_m_ = 0.0;   ///< by scans since the wheels rested; below 0 the robot backs
  bool in_transit_ = false;  ///< since the scene was last begun anew
  bool was_heard_ = false;   ///< the wheels, up to the scan before
  bool is_heard_ = false;    ///< the wheels, since the scan before
  Pose2 T_odom_robot_;
  UncertainPose2 T_node_robot_;
};

}  // namespace masked_mapper
