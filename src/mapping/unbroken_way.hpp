// SPDX-License-Identifier: BSD-3-Clause
// The robot's way through a whole log: by wheels, and where these are silent by scans alone.
#pragma once

#include <functional>
#include <optional>
#include <vector>

#include "masked_mapper/motion/motion_estimator.hpp"
#include "masked_mapper/sensor/observation.hpp"

namespace masked_mapper {

class UnbrokenWay {
 public:
  /// `wheels_are_due`: scans without odometry are a silence also before the first with it.
  UnbrokenWay(const MotionOptions& options, bool wheels_are_due);

  using Sink = std::function<void(const Observation&)>;
  /// In order of stamps. What comes out has odometry that goes on without a break; a reading is
  /// added behind a scan in silence, which has none of its own.
  void Follow(const Observation& observation, const Sink& sink);

  /// A stretch in which no wheels told the way.
  struct Silence {
    TimeSpan span;             ///< from the last scan with odometry to the next
    double way_sigma_m = 0.0;  ///< of the way by scans alone
  };
  /// Complete behind the last observation.
  const std::vector<Silence>& silences() const { return silences_; }

 private:
  void FollowScan(const LaserScan& scan);
  void Hear(const Pose2& T_odom_robot);

  MotionOptions options_;
  bool wheels_are_due_;
  std::optional<MotionEstimator> scans_;  ///< in a silence
  std::optional<LaserScan> last_scan_;
  Pose2 T_way_robot_;
  Pose2 T_way_silence_;              ///< where the present silence began
  std::optional<Pose2> T_way_odom_;  ///< since a silence ended
  std::vector<Silence> silences_;
};

}  // namespace masked_mapper
