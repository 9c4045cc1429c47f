// SPDX-License-Identifier: BSD-3-Clause
// What may be set of how floors and the ways between them are told, sensor by sensor.
#pragma once

#include <string>
#include <vector>

#include "masked_mapper/motion/floor_timeline.hpp"

namespace masked_mapper {

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
