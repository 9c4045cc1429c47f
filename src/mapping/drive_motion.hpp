// SPDX-License-Identifier: BSD-3-Clause
// The motion of a drive through a building: that of its scans, held where the robot rides. It never
// looks at the map, so that nothing that a closure moves comes back to it, and it may run ahead.
#pragma once

#include <cstddef>
#include <optional>
#include <string>

#include "masked_mapper/motion/floor_timeline.hpp"
#include "masked_mapper/motion/motion_estimator.hpp"
#include "masked_mapper/sensor/observation.hpp"

namespace masked_mapper {

/// A scan, and how the robot moved to it.
struct MovedScan {
  LaserScan scan;               ///< as observed
  UncertainPose2 T_last_robot;  ///< since the scan before; of the first: identity
  Pose2 T_odom_robot;           ///< along the motion path
  FloorInterval interval;       ///< where the robot is
};

class DriveMotion {
 public:
  /// `cab_m`: travel in transit above which it is no cab. `floors` outlives this.
  DriveMotion(const MotionOptions& options, double cab_m, const FloorTimeline& floors)
      : uses_points_(options.source != MotionSource::kOdometry),
        cab_m_(cab_m),
        floors_(floors),
        motion_(options) {}

  /// Whether points of scans that somebody has made already are of use.
  bool uses_points() const { return uses_points_; }

  /// Observations in order of stamps. `points`: of a scan, where somebody has made them already.
  std::optional<MovedScan> Observe(Observation observation, const FacedPoints* points = nullptr);

  /// s, spent on it.
  double seconds() const { return seconds_; }

  // For checkpoints; these stand in checkpoint.cpp.
  std::string SaveState();
  /// To one made alike. Throws StateError.
  void RestoreState(const std::string& bytes);

 private:
  template <class Archive>
  void SerializeState(Archive& archive);
  void ChangeFloor(const FloorInterval& interval);

  bool uses_points_;
  double cab_m_;
  const FloorTimeline& floors_;
  MotionEstimator motion_;
  double seconds_ = 0.0;
  std::optional<std::size_t> level_;  ///< on which the robot was last; empty: no scan came yet
  bool in_transit_ = false;
  bool on_stairs_ = false;  ///< the transit that runs, or the last
};

}  // namespace masked_mapper
