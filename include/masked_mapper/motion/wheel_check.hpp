// SPDX-License-Identifier: BSD-3-Clause
// What wheels are worth, by scans alone: whether both tell of the same turns at the same time, and
// of the same way. Scans are asked in windows all over the log, so that it costs a share of what
// mapping does.
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "masked_mapper/geometry/pose2.hpp"
#include "masked_mapper/motion/motion_estimator.hpp"
#include "masked_mapper/sensor/laser_scan.hpp"
#include "masked_mapper/sensor/observation.hpp"

namespace masked_mapper {

/// A number that was estimated.
struct Estimated {
  double value = 0.0;
  double sigma = 0.0;
};

/// Each is present where it was seen, surely, to be other than it should be.
struct WheelFault {
  std::optional<Estimated> scan_clock_s;   ///< by which scans are stamped ahead of the wheels
  std::optional<Estimated> travel_factor;  ///< true travel over what the wheels say
  std::optional<Estimated> turn_factor;    ///< the same of turns
  bool turns_useless = false;   ///< the turns that wheels tell are not those of the robot
  bool travel_useless = false;  ///< nor is the way

  bool IsNone() const {
    return !scan_clock_s && !travel_factor && !turn_factor && !turns_useless && !travel_useless;
  }
};

/// A stretch of the way as both tell it, from the robot's pose at its beginning.
struct StretchPair {
  Pose2 by_wheels;
  Pose2 by_scans;
  double way_sigma_m = 0.0;  ///< of the way by scans
};

struct WheelReport {
  WheelFault fault;
  std::vector<StretchPair> stretches;  ///< with the clock that was found
};

class WheelCheck {
 public:
  explicit WheelCheck(const MotionOptions& options);

  /// In order of stamps; scans with beams.
  void Observe(const OdometryReading& reading);
  void Observe(const LaserScan& scan);

  /// What wheels said in `left_out` does not count. No fault when too little was seen to tell.
  WheelReport Find(const std::vector<TimeSpan>& left_out) const;

  /// A stretch of the way by scans alone, of which they are sure.
  struct Stretch {
    TimeSpan span;
    Pose2 by_scans;
    double way_sigma_m = 0.0;
  };
  /// Where the wheels were; the heading is not wrapped.
  struct WheelPose {
    double stamp = 0.0;
    Eigen::Vector2d position_in_odom = Eigen::Vector2d::Zero();
    double heading_rad = 0.0;
  };

 private:
  bool IsDue(const LaserScan& scan) const;
  bool SeemsToTurn(const LaserScan& scan) const;
  void EndStretch(double stamp);

  MotionOptions options_;
  std::vector<WheelPose> wheels_;
  std::vector<Stretch> stretches_;
  std::optional<MotionEstimator> scans_;  ///< of the present window
  double window_begin_ = 0.0;             ///< s
  double stretch_begin_ = 0.0;            ///< s
  Pose2 T_window_stretch_;
  double last_matched_ = 0.0;  ///< s
  std::vector<float> last_ranges_;
  std::uint64_t observed_ = 0;
  std::uint64_t matched_ = 0;
  int matched_in_window_ = 0;
};

/// Whether the scanner sits on the robot as the log says. Scans alone and wheels alone both tell
/// how the robot moved, and each errs in its own way; but a mirrored scanner turns the other way in
/// every turn, and one that looks elsewhere than it is said to moves askew on every straight. At
/// most one of the three, in this order.
struct MountFault {
  bool upside_down = false;
  double yaw = 0.0;                                  ///< rad, truly minus as the log says
  Eigen::Vector2d offset = Eigen::Vector2d::Zero();  ///< m, the same, in the robot frame

  bool IsNone() const { return !upside_down && yaw == 0.0 && offset.isZero(); }
};

/// No fault when too little was seen to tell.
MountFault FindMountFault(const std::vector<StretchPair>& stretches);

/// One line that names the options to set; empty when nothing is wrong. `T_robot_laser` is as the
/// log has it.
std::string WarningOf(const MountFault& fault, const Pose2& T_robot_laser);

/// A stretch in which wheels stood still, or seemed to, and the robot moved.
struct FalseRest {
  TimeSpan span;        ///< to the scan at which the wheels were seen to move again
  double leap_m = 0.0;  ///< by which odometry leapt at its end, faster than any robot
};

/// Whether a robot whose wheels stand still does stand still. Wheels freeze, and robots are
/// carried; to the wheels both look like rest. The scene as a whole tells: where it has moved past
/// the scanner, so has the robot. A door that opens and people who walk by move a part of it, or
/// make it another scene.
class StandstillCheck {
 public:
  explicit StandstillCheck(const MotionOptions& options);

  /// In order of stamps; scans with beams. A scan without odometry ends a rest.
  void Observe(const OdometryReading& reading);
  void Observe(const LaserScan& scan);

  /// In order; a rest that lasts to the end of the log ends with its last scan.
  std::vector<FalseRest> Find() const;

 private:
  struct Rest {
    TimeSpan span;
    Pose2 T_odom_robot;
    int contradictions = 0;
    double leap_m = 0.0;
  };

  void ObserveAtWheels(const LaserScan& scan);
  bool LeapIsFalse(const LaserScan& scan) const;
  void BeginRest(const LaserScan& scan);
  void EndRest(double stamp);
  void BeginAnchor(const LaserScan& scan);
  bool HasChanged(const LaserScan& scan) const;
  bool Contradicts(const LaserScan& scan, const Pose2& T_anchor_robot) const;
  static bool IsFalse(const Rest& rest);

  MotionOptions options_;
  std::optional<Rest> rest_;
  std::vector<FalseRest> found_;
  std::optional<OdometryReading> last_;
  LaserScan last_scan_;
  // What was seen when the present guess of motion began, and the guess itself.
  LaserScan anchor_;
  std::optional<MotionEstimator> scans_;
};

}  // namespace masked_mapper
