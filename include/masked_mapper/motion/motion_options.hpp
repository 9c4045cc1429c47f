// SPDX-License-Identifier: BSD-3-Clause
// What may be set of how the motion of a robot is told, by wheels, by scans, or by both; and of how
// floors and the ways between them are told, sensor by sensor.
#pragma once

#include <string>
#include <vector>

#include "masked_mapper/motion/floor_timeline.hpp"
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

struct FloorLabelOptions {
  double late_s = 60.0;       ///< s by which a label may be late or early, where none says `-`
  double cab_radius = 0.25;   ///< m within which a robot stays while it turns round in a cab
  double least_stay_s = 4.0;  ///< s that wheels rest in an elevator at least
};

struct PressureHeightOptions {
  double pressure_pa_per_m = 12.0;  ///< Pa less per metre up, near sea level
  double max_height = 500.0;        ///< m from the median height; what is beyond is no reading
  double spike_height = 1.5;        ///< m, by which a lone spell may not leave its neighbours
};

struct FloorPressureOptions {
  PressureHeightOptions heights;
  std::vector<double> windows_s = {4.0, 12.0, 40.0};  ///< s, on either side of a step
  double step_height = 1.5;    ///< m between the means of both windows: a step
  double moving_height = 0.5;  ///< m: the step is still going on
  double landing_s = 15.0;     ///< s between flights of the same stairs at most
  /// The weather around a transit: a steady drift (sigma, m/s), and a wandering part.
  double drift_m_per_s = 0.002;
  double wander_m_per_sqrt_s = 0.012;  ///< 0.15 m that are forgotten over 300 s do this
  double drift_window_s = 300.0;       ///< s on either side of a transit that show the drift
  double cab_radius = 0.25;         ///< m within which a robot stays while it turns round in a cab
  double least_stay_s = 6.0;        ///< s that wheels rest for a ride and its doors at least
  double least_travel_per_m = 0.8;  ///< m driven per m climbed on the steepest stairs
};

struct FloorAccelerationOptions {
  double spell_s = 0.1;     ///< s, over which readings are averaged
  double pulse = 0.12;      ///< m/s^2, for longer than `pulse_s`: the cab speeds up or slows down
  double pulse_s = 0.4;     ///< s
  double rest_speed = 0.2;  ///< m/s left after the last pulse of a ride at most ...
  double rest_share = 0.3;  ///< ... or this share of its highest speed
  double longest_ride_s = 300;  ///< s
  double cab_radius = 0.25;     ///< m within which a robot stays while it turns round in a cab
  double least_stay_s = 6.0;    ///< s that wheels rest for a ride and its doors at least
  FloorPressureOptions stairs;  ///< how steps are found in what the pitch makes of heights
};

struct FloorLidarOptions {
  double wall_distance_m = 3.5;    ///< m, to the walls of a cab at most
  double max_area_m2 = 9.0;        ///< m^2, of a cab at most
  double leak_share = 0.03;        ///< of beams that may pass gaps of doors
  double closed_s = 4.0;           ///< s for which doors are closed for a ride at least
  double cab_radius = 0.25;        ///< m within which a robot stays while it turns round in a cab
  double door_distance_m = 2.5;    ///< m from the cab's middle: surely outside its door
  double way_m = 6.0;              ///< m of the way in and of the way out that are looked at
  double scene_radius_m = 10.0;    ///< m from the cab's middle, up to which walls are compared
  double other_scene_share = 0.4;  ///< of walls seen alike at most: another scene
  double key_distance_m = 0.4;     ///< m, or ...
  double key_angle_deg = 20.0;     ///< ... deg between the scans kept of a way
  double agree_m = 0.3;            ///< m between two views of the same wall at most
};

struct FloorOptions {
  FloorSource source = FloorSource::kAuto;
  std::string file;  ///< lines `t,label` that stand for the log's labels; empty: none
  StoreyOptions storeys;
  FloorLabelOptions labels;
  FloorPressureOptions pressure;
  FloorAccelerationOptions acceleration;
  FloorLidarOptions lidar;
};

}  // namespace masked_mapper
