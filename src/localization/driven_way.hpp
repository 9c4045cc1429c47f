// SPDX-License-Identifier: BSD-3-Clause
// The motion of a robot that is localised: as a mapper tells it, over logs that follow each other.
#pragma once

#include <optional>
#include <string>

#include "carry_watch.hpp"
#include "masked_mapper/motion/motion_estimator.hpp"

namespace masked_mapper {

class DrivenWay {
 public:
  explicit DrivenWay(const MotionOptions& options) : options_(options) {}

  /// The motion begins anew, by `source`.
  void BeginLog(MotionSource source);

  /// Readings between scans; those before the first scan of a log tell nothing.
  void Observe(const OdometryReading& reading);
  /// The scan as it would be, had all its beams been measured at its stamp. `must_match`: the scene
  /// is about to be left, or was just entered.
  LaserScan Observe(const LaserScan& bent, bool must_match);

  /// From the first scan of a log on.
  MotionEstimator& motion() { return *motion_; }
  const MotionEstimator& motion() const { return *motion_; }
  bool HasBegun() const { return motion_.has_value(); }

  /// Why the robot may be elsewhere than motion says, since the scan before the last; empty: no
  /// reason.
  const std::string& carried() const { return carried_; }
  /// Way from the scan before the last to the last, m; none where it was carried.
  double step_m() const { return step_m_; }
  /// All of it, m.
  double travelled_m() const { return travelled_m_; }

 private:
  MotionOptions options_;
  std::optional<MotionEstimator> motion_;
  CarryWatch carrying_;
  std::string carried_;
  std::optional<double> stamp_before_;  ///< s, of the scan before, in this log
  Pose2 T_odom_before_;
  double step_m_ = 0.0;
  double travelled_m_ = 0.0;
};

}  // namespace masked_mapper
