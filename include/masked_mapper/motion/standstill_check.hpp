// SPDX-License-Identifier: BSD-3-Clause
// Whether a robot whose wheels stand still does stand still. Wheels freeze, and robots are carried;
// to the wheels both look like rest. The scene as a whole tells: where it has moved past the
// scanner, so has the robot. A door that opens and people who walk by move a part of it, or make it
// another scene.
#pragma once

#include <optional>
#include <vector>

#include "masked_mapper/motion/motion_estimator.hpp"
#include "masked_mapper/sensor/laser_scan.hpp"
#include "masked_mapper/sensor/time_span.hpp"

namespace masked_mapper {

/// A stretch in which wheels stood still, or seemed to, and the robot moved.
struct FalseRest {
  TimeSpan span;        ///< to the scan at which the wheels were seen to move again
  double leap_m = 0.0;  ///< by which odometry leapt at its end, faster than any robot
};

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
