// SPDX-License-Identifier: BSD-3-Clause
// How long a sweep of the scanner takes, and which way it goes, by the scans themselves. A robot
// that turns bends its scans: put straight for the right sweep, they fit best to what it saw before
// it turned. So it shows what a log does not state, or states wrongly, and whether the driver has
// straightened its scans already.
#pragma once

#include <cstddef>
#include <deque>
#include <optional>
#include <vector>

#include "masked_mapper/motion/motion_estimator.hpp"
#include "masked_mapper/sensor/laser_scan.hpp"
#include "masked_mapper/sensor/sensor_finding.hpp"

namespace masked_mapper {

/// Of s per rad, in the order of the beams; negative: against it.
struct SweepEstimate {
  double seconds_per_rad = 0.0;
  double sigma = 0.0;
};

class SweepCheck {
 public:
  explicit SweepCheck(const MotionOptions& options);

  /// Scans in order, with beams, bent as they are. `beam_time` is what the log states.
  void Observe(const LaserScan& scan);

  /// What the log states; 0: nothing that could be.
  double Stated() const;
  /// What the scans themselves say; empty: the robot turned too little to tell.
  std::optional<SweepEstimate> Measured() const;

  struct Verdict {
    double seconds_per_rad = 0.0;          ///< to be used
    std::optional<SensorFinding> finding;  ///< where it is not what the log states
  };
  Verdict Find() const;

 private:
  /// A scan and how the robot moved after it.
  struct Seen {
    LaserScan scan;
    Pose2 T_odom_robot;
    Pose2 T_now_next;
    double seconds = 0.0;      ///< to the next
    double lasting_rad = 0.0;  ///< of the turn to the next
  };
  /// Two scans of one place, bent differently.
  struct Pair {
    Seen first;
    Seen second;
    double bent_rad_per_s = 0.0;
  };

  static double BentApart(const Seen& a, const Seen& b);
  void Enter(const Seen& seen);
  void Keep(Pair pair);
  std::vector<double> Fits(const Pair& pair) const;
  double LongestSweep() const;
  std::optional<SensorFinding> Finding(double used,
                                       const std::optional<SweepEstimate>& measured) const;

  MotionEstimator scans_alone_;
  std::optional<Seen> last_;
  Pose2 step_before_;  ///< to the last
  std::deque<Seen> recent_;
  std::vector<Pair> pairs_;
  std::vector<float> periods_;  ///< s
  std::vector<float> stated_;   ///< s per rad
  double first_stamp_ = 0.0;    ///< s, of the log
  double last_stamp_ = 0.0;
  std::size_t without_wheels_ = 0;
};

}  // namespace masked_mapper
