// SPDX-License-Identifier: BSD-3-Clause
// Whether the scanner sits on the robot as the log says. Scans alone and wheels alone both tell how
// the robot moved, and each errs in its own way; but a mirrored scanner turns the other way in
// every turn, and one that looks elsewhere than it is said to moves askew on every straight.
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "masked_mapper/motion/motion_estimator.hpp"
#include "masked_mapper/sensor/laser_scan.hpp"

namespace masked_mapper {

/// What is wrong with a mount; at most one of the three, in this order.
struct MountFault {
  bool upside_down = false;
  double yaw = 0.0;                                  ///< rad, truly minus as the log says
  Eigen::Vector2d offset = Eigen::Vector2d::Zero();  ///< m, the same, in the robot frame

  bool IsNone() const { return !upside_down && yaw == 0.0 && offset.isZero(); }
};

class MountCheck {
 public:
  explicit MountCheck(const MotionOptions& options);

  /// Scans in order, with beams; those without odometry are passed over.
  void Observe(const LaserScan& scan);
  /// Whether enough was seen.
  bool IsSettled() const;
  /// No fault when too little was seen to tell.
  MountFault Find() const;
  /// One line that names the options to set; empty when nothing is wrong.
  std::string Warning() const;

 private:
  /// A stretch of the way, by wheels and by scans alone.
  struct Stretch {
    Pose2 by_wheels;
    Pose2 by_scans;
  };

  bool IsUpsideDown() const;
  double Yaw() const;
  Eigen::Vector2d Offset() const;

  MotionEstimator scans_;
  std::size_t observed_ = 0;
  std::optional<Stretch> begin_;  ///< poses at the begin of the present stretch
  std::vector<Stretch> turns_;
  std::vector<Stretch> straights_;
  Pose2 T_robot_laser_;
};

}  // namespace masked_mapper
