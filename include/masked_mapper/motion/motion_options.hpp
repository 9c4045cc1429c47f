// SPDX-License-Identifier: BSD-3-Clause
// What may be set of how the motion of a robot is told: by wheels, by scans, or by both.
#pragma once

#include "masked_mapper/scan_matching/local_map.hpp"
#include "masked_mapper/sensor/motion_source.hpp"

namespace masked_mapper {

/// Noise of wheel odometry as a random walk. The paper leaves its covariance open; these values
/// cover the robots of public logs, whose headings drift by 7 to 42 degrees over 50 m.
struct DeadReckoningOptions {
  double sigma_position_per_sqrt_m = 0.05;      ///< m of position error after one metre of travel
  double sigma_heading_deg_per_sqrt_m = 2.0;    ///< deg of heading error after one metre of travel
  double sigma_heading_deg_per_sqrt_rad = 3.0;  ///< deg of heading error after turning by a radian
  double sigma_heading_deg_per_sqrt_s = 0.03;  ///< deg of heading error after a second (gyro drift)
  double sigma_position_per_step = 0.002;      ///< m, of every step with motion: no edge is perfect

  /// For a checkpoint (sensor/state_archive.hpp): what was learnt of them on the way.
  template <class Archive>
  void Serialize(Archive& archive) {
    archive(sigma_position_per_sqrt_m, sigma_heading_deg_per_sqrt_m, sigma_heading_deg_per_sqrt_rad,
            sigma_heading_deg_per_sqrt_s, sigma_position_per_step);
  }
};

struct ScanOdometryOptions {
  LocalMapOptions map;
  double match_distance_m = 0.04;     ///< travel below which a scan is not matched: wheels suffice
  double match_angle_deg = 0.2;       ///< and turn
  double keyframe_distance_m = 0.15;  ///< travel from one scan in the local map to the next
  double keyframe_angle_deg = 12.0;   ///< or turn
  int keyframes_per_map = 60;         ///< after which the next local map is begun; two overlap
  double decorrelation_distance_m = 1.0;  ///< travel over which alignments err independently
  double decorrelation_angle_deg = 30.0;  ///< or turn
  double transit_reach_m = 2.5;  ///< in transit only walls this near: beyond the door floors differ
  double min_inlier_share = 0.5;     ///< below it other guesses are tried
  double repeat_difference_m = 0.1;  ///< between wheels and the step before, to try both
  double settled_deg = 0.03;  ///< sigma of the heading below which a robot at rest is not matched
  int rest_scans = 15;        ///< nor after as many scans at rest
  double blank_ratio =
      40.0;  ///< of what a scan knows across and along, that makes a corridor blank
  double overruling_sigmas = 3.0;   ///< of the wheels, beyond which a scan has to be clear:
  double overruling_share = 0.1;    ///< of its points more must agree than where the wheels put it
  double lost_inlier_share = 0.25;  ///< below it after all guesses the scan is not believed
};

struct WheelNoiseOptions {
  double window_m = 1.0;             ///< travel over which wheels and scans are compared
  double window_deg = 45.0;          ///< or turn, whichever comes first
  double sure_sigma_deg = 0.05;      ///< of a scan's heading, above which it is no measure
  double least_scale = 0.05;         ///< of the heading sigmas of dead reckoning
  double first_windows = 2.0;        ///< weight of those sigmas before anything was seen
  double remembered_windows = 60.0;  ///< after which what was seen fades
};

struct GyroBiasOptions {
  double rest_m = 1e-4;              ///< travel between two readings, below which wheels stand
  double most_deg_per_s = 0.05;      ///< turning faster than this is a robot that turns
  double first_seconds = 10.0;       ///< weight of no bias before anything was seen
  double remembered_seconds = 60.0;  ///< of rest, after which what was seen fades
};

/// What a robot may do between two scans when no wheels tell.
struct WheellessOptions {
  double sigma_speed_m_per_s = 0.4;  ///< about the speed of the step before, in the long run
  /// By which it changes from one step to the next. Where walls are blank along the way (a flight
  /// of stairs), this holds the way against what little seems to be seen of it.
  double sigma_acceleration_m_per_s2 = 1.0;
  double sigma_turn_deg_per_s = 40.0;  ///< about the turn of the step before
};

struct MotionOptions {
  MotionSource source = MotionSource::kAuto;  ///< kAuto is settled before a drive begins
  double longest_step_m = 2.0;     ///< from scan to scan; beyond it they share too little view
  double longest_turn_deg = 60.0;  ///< the same
  /// Not where a survey found turns by wheels to be of no use: their way is a length then, and the
  /// direction is that of the step before.
  bool wheels_tell_turns = true;
  DeadReckoningOptions odometry;
  ScanOdometryOptions scans;
  WheelNoiseOptions wheel_noise;
  GyroBiasOptions gyro_bias;
  WheellessOptions wheelless;
};

/// The same of a robot whose wheels are not asked.
inline MotionOptions ScansAlone(MotionOptions options) {
  options.source = MotionSource::kScans;
  return options;
}

}  // namespace masked_mapper
