// SPDX-License-Identifier: BSD-3-Clause
// Changes of floor as they happen, by the sensors that measure them: the last minutes are looked at
// again and again, as mapping looks at a whole log.
#pragma once

#include <limits>
#include <optional>
#include <string>

#include "masked_mapper/motion/floor_tracker.hpp"

namespace masked_mapper {

/// The robot is between floors, or was until just now.
struct RideNews {
  /// Up, so far, since the last ride that was told as over: a ride may go on behind a landing.
  std::optional<double> climb_m;  ///< nothing: nobody knows
  double sigma_m = 0.0;
  bool is_over = false;
};

class RideWatch {
 public:
  explicit RideWatch(const FloorOptions& options) : options_(options) {}

  /// Observations in order of stamps; labels are not its business.
  void Observe(const Observation& observation);
  /// Where the robot is at the scan observed last, by its motion.
  void NotePose(const Pose2& T_odom_robot);

  /// Whether the wheels rest, as in a cab; on stairs they turn.
  bool IsResting() const;

  /// Whether it is time for News() again.
  bool IsDue() const;
  /// Of a ride that goes on; of one that is over, once.
  std::optional<RideNews> News();

 private:
  FloorOptions options_;
  SensorReadings readings_;    ///< of the last minutes
  double newest_ = 0.0;        ///< s
  double looked_ = 0.0;        ///< s, when the last minutes were last looked at
  double told_climb_m_ = 0.0;  ///< of the ride that was told last
  double told_to_ = -std::numeric_limits<double>::infinity();  ///< s: rides up to here are told
  std::optional<Pose2> T_odom_rest_;
  double moved_at_ = 0.0;  ///< s, since when the robot rests
  bool may_tell_ = false;  ///< there was a reading that tells of floors
};

}  // namespace masked_mapper
