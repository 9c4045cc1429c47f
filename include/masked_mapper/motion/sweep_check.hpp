// SPDX-License-Identifier: BSD-3-Clause
// How long a sweep of the scanner takes, and which way it goes, by the scans themselves. A robot
// that turns bends its scans: put straight for the right sweep, they fit best to what it saw before
// it turned. So it shows what a log does not state, or states wrongly, and whether the driver has
// straightened its scans already.
#pragma once

#include <cstddef>
#include <deque>
#include <memory>
#include <optional>
#include <vector>

#include "masked_mapper/motion/motion_estimator.hpp"
#include "masked_mapper/sensor/laser_scan.hpp"
#include "masked_mapper/sensor/observation.hpp"
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
  std::optional<SweepEstimate> Measured(int threads = 1) const;

  struct Verdict {
    double seconds_per_rad = 0.0;          ///< to be used
    std::optional<SensorFinding> finding;  ///< where it is not what the log states
  };
  /// The same at any number of threads.
  Verdict Find(int threads = 1) const;

 private:
  /// A scan and how the robot moved after it.
  struct Seen {
    std::shared_ptr<const LaserScan> scan;
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

/// How a scanner sweeps, the same all through a log (SweepCheck).
struct SweepTiming {
  /// From one direction to the next, in the order of the beams; negative: against it. 0: there is
  /// nothing to straighten.
  double seconds_per_rad = 0.0;
  bool by_wheels = true;  ///< false: they are not to be looked at
};

/// With the times of its beams.
LaserScan Timed(LaserScan scan, double seconds_per_rad);

/// Scans as they would be, had all their beams been measured at the stamp, by what the wheels say
/// of the motion during each sweep. A scan waits for the odometry at its end. Where the wheels are
/// silent it is handed on as it is, with the time of its beams, for the motion that scans tell.
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
