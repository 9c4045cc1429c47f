// SPDX-License-Identifier: BSD-3-Clause
// Scans as they would be, had all their beams been measured at the stamp, by what the wheels say of
// the motion during each sweep. A scan waits for the odometry at its end. Where the wheels are
// silent it is handed on as it is, with the time of its beams, for the motion that scans tell.
#pragma once

#include <deque>
#include <optional>

#include "masked_mapper/sensor/observation.hpp"

namespace masked_mapper {

/// How a scanner sweeps, the same all through a log (sweep_check.hpp).
struct SweepTiming {
  /// From one direction to the next, in the order of the beams; negative: against it. 0: there is
  /// nothing to straighten.
  double seconds_per_rad = 0.0;
  bool by_wheels = true;  ///< false: they are not to be looked at
};

/// With the times of its beams.
LaserScan Timed(LaserScan scan, double seconds_per_rad);

class SweepStraightener {
 public:
  explicit SweepStraightener(const SweepTiming& timing) : timing_(timing) {}

  /// In order of stamps.
  void Add(Observation observation);
  /// No more will come.
  void Finish() { finished_ = true; }
  /// The next observation that is ready, in the order in which they were added.
  std::optional<Observation> Next();

 private:
  void Note(const OdometryReading& reading);
  bool MayComeYet(double end) const;
  void StraightenByWheels(LaserScan& scan) const;
  std::optional<Pose2> RobotAt(double stamp) const;

  SweepTiming timing_;
  std::deque<Observation> waiting_;
  std::deque<OdometryReading> track_;  ///< from the last before what waits first
  double newest_ = 0.0;                ///< s, stamp
  bool finished_ = false;
};

}  // namespace masked_mapper
