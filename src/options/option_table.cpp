// SPDX-License-Identifier: BSD-3-Clause
#include "masked_mapper/options/option_table.hpp"

#include <algorithm>
#include <cassert>
#include <charconv>
#include <cmath>
#include <iterator>
#include <string_view>
#include <type_traits>
#include <utility>

#include "masked_mapper/text/did_you_mean.hpp"
#include "masked_mapper/text/input_error.hpp"

namespace masked_mapper {
namespace {

/// The shortest text that reads back the same; without an exponent where people write none.
std::string NumberText(double value) {
  char buffer[64];
  const bool plain = value == 0.0 || (std::abs(value) >= 1e-4 && std::abs(value) < 1e15);
  const auto format = plain ? std::chars_format::fixed : std::chars_format::general;
  const auto [end, error] = std::to_chars(std::begin(buffer), std::end(buffer), value, format);
  assert(error == std::errc());
  static_cast<void>(error);
  return {buffer, end};
}

/// The whole of `text` as a number, or false.
template <typename Number>
bool Parse(std::string_view text, Number& value) {
  if (text.size() > 1 && text.front() == '+' && text[1] != '-') text.remove_prefix(1);
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  return error == std::errc() && end == text.data() + text.size();
}

bool ParseValue(const std::string& text, double& value) {
  return Parse(text, value) && std::isfinite(value);
}
bool ParseValue(const std::string& text, int& value) { return Parse(text, value); }
bool ParseValue(const std::string& text, std::size_t& value) { return Parse(text, value); }
bool ParseValue(const std::string& text, bool& value) {
  value = text == "true";
  return text == "true" || text == "false";
}

/// Names of topics and the like: nothing that YAML or JSON would have to escape.
bool ParseValue(const std::string& text, std::string& value) {
  constexpr std::size_t kLongest = 1000;
  value = text;
  return text.size() <= kLongest && std::all_of(text.begin(), text.end(), [](char c) {
           return (c >= 'A' && c <= 'Z') || (c >= 'a' && c <= 'z') || (c >= '0' && c <= '9') ||
                  std::string_view("/_,.- ").find(c) != std::string_view::npos;
         });
}

template <typename Enum>
Choice ChoiceOf(Enum& field, std::vector<std::string> names) {
  return {std::move(names), [&field] { return static_cast<std::size_t>(field); },
          [&field](std::size_t index) { field = static_cast<Enum>(index); }};
}

template <typename Value>
std::string TypeName() {
  if (std::is_same_v<Value, bool>) return "true or false";
  if (std::is_same_v<Value, std::string>) return "a name";
  return std::is_same_v<Value, double> ? "a number" : "a whole number";
}

/// The nearest key; when only the section was forgotten or wrong, the key that ends alike.
std::string NearestKey(const std::string& unknown, const std::vector<OptionEntry>& table) {
  std::vector<std::string> keys;
  keys.reserve(table.size());
  for (const OptionEntry& entry : table) keys.push_back(entry.key);
  std::string near = DidYouMean(unknown, keys);
  if (!near.empty()) return near;
  const auto last_name = [](const std::string& key) { return key.substr(key.rfind('.') + 1); };
  for (const std::string& key : keys) {
    if (last_name(key) == last_name(unknown)) return " (did you mean `" + key + "`?)";
  }
  return {};
}

/// A user's text inside a message: one line, not too long.
std::string Quoted(std::string text) {
  constexpr std::size_t kLongest = 60;
  if (text.size() > kLongest) text = text.substr(0, kLongest) + "...";
  for (char& letter : text) {
    if (static_cast<unsigned char>(letter) < 0x20 || letter == 0x7f) letter = '?';
  }
  return "`" + text + "`";
}

}  // namespace

std::vector<OptionEntry> OptionTable(Options& o) {
  constexpr double kFar = 1000.0;  // m; no distance that makes sense here is longer
  MotionOptions& motion = o.mapping.motion;
  OpeningsMaskOptions& openings = o.mapping.masks.openings;
  return {
      {"threads", &o.threads, 0, 256, "0: as many as the machine has; never changes the result"},

      {"log.max_range", &o.mapping.log.max_range, 0, kFar,
       "m; at or beyond it nothing was hit; 0: found from the log"},
      {"log.min_range", &o.mapping.log.min_range, 0, 10, "m; anything nearer says nothing"},
      {"log.laser_x", &o.mapping.log.laser_x, -10, 10,
       "m; scanner on the robot; 0, 0, 0: as the log says"},
      {"log.laser_y", &o.mapping.log.laser_y, -10, 10, "m; to the left"},
      {"log.laser_theta_deg", &o.mapping.log.laser_theta_deg, -180, 180, "deg; counter-clockwise"},
      {"log.upside_down", &o.mapping.log.upside_down, 0, 0,
       "the scanner hangs: beams run the other way than the log says"},
      {"log.field_of_view_deg", &o.mapping.log.field_of_view_deg, 0, 360,
       "deg; of FLASER lines; 0: by the number of beams"},
      {"log.scan_topic", &o.mapping.log.scan_topic, 0, 0,
       "of ROS bags with several; a,b: merged into one scanner"},
      {"log.odometry_topic", &o.mapping.log.odometry_topic, 0, 0,
       "of ROS bags with several; none: not read"},
      {"log.imu_topic", &o.mapping.log.imu_topic, 0, 0, "of ROS bags with several; none: not read"},
      {"log.pressure_topic", &o.mapping.log.pressure_topic, 0, 0,
       "of ROS bags with several; none: not read"},
      {"log.strongest_echo", &o.mapping.log.strongest_echo, 0, 0,
       "of a scanner with several echoes per beam; false: the first"},

      {"motion.source", ChoiceOf(motion.source, {"auto", "odometry", "scans", "fused"}), 0, 0,
       "auto: fused where scans come often enough, else odometry"},
      {"motion.longest_step_m", &motion.longest_step_m, 0.1, kFar,
       "m from scan to scan, beyond which wheels alone are believed"},
      {"motion.longest_turn_deg", &motion.longest_turn_deg, 1, 180,
       "deg from scan to scan, the same"},
      {"motion.odometry.sigma_position_per_sqrt_m", &motion.odometry.sigma_position_per_sqrt_m,
       1e-6, 10, "m of position error after one metre of travel"},
      {"motion.odometry.sigma_heading_deg_per_sqrt_m",
       &motion.odometry.sigma_heading_deg_per_sqrt_m, 1e-6, 90,
       "deg of heading error after one metre of travel"},
      {"motion.odometry.sigma_heading_deg_per_sqrt_rad",
       &motion.odometry.sigma_heading_deg_per_sqrt_rad, 0, 90,
       "deg of heading error after turning by a radian"},
      {"motion.odometry.sigma_heading_deg_per_sqrt_s",
       &motion.odometry.sigma_heading_deg_per_sqrt_s, 0, 90,
       "deg of heading error after a second (gyro drift)"},
      {"motion.odometry.sigma_position_per_step", &motion.odometry.sigma_position_per_step, 1e-6, 1,
       "m of position error of every step with motion"},
      {"motion.scans.map.cell_m", &motion.scans.map.cell_m, 0.01, 2,
       "m; cell of the rolling local map"},
      {"motion.scans.map.window_cells", &motion.scans.map.window_cells, 0, 10,
       "cells to each side that a distribution looks at"},
      {"motion.scans.map.reach_m", &motion.scans.map.reach_m, 1, kFar,
       "m; points farther from the map's origin are left out"},
      {"motion.scans.map.point_sigma_m", &motion.scans.map.point_sigma_m, 1e-4, 1,
       "m; noise of a point"},
      {"motion.scans.map.first_sigma_m", &motion.scans.map.first_sigma_m, 1e-4, 2,
       "m; the same in the first iteration, then halved each time"},
      {"motion.scans.map.outlier_sigmas", &motion.scans.map.outlier_sigmas, 0.1, 100,
       "distance at which a point has lost half of its say"},
      {"motion.scans.map.guess_outlier_sigmas", &motion.scans.map.guess_outlier_sigmas, 0.1, 100,
       "distance at which the guess has lost half of its say"},
      {"motion.scans.map.line_ratio", &motion.scans.map.line_ratio, 0, 1,
       "smaller over larger variance below which points form a line"},
      {"motion.scans.map.max_iterations", &motion.scans.map.max_iterations, 1, 1000,
       "of one alignment"},
      {"motion.scans.map.covariance_inflation", &motion.scans.map.covariance_inflation, 1e-3, 1e4,
       "beams of one wall err together, not each on its own"},
      {"motion.scans.match_distance_m", &motion.scans.match_distance_m, 0, 10,
       "m of travel below which a scan is not matched"},
      {"motion.scans.match_angle_deg", &motion.scans.match_angle_deg, 0, 180,
       "deg of turn below which a scan is not matched"},
      {"motion.scans.keyframe_distance_m", &motion.scans.keyframe_distance_m, 0, 10,
       "m of travel from one scan in the local map to the next"},
      {"motion.scans.keyframe_angle_deg", &motion.scans.keyframe_angle_deg, 0, 180,
       "deg of turn from one scan in the local map to the next"},
      {"motion.scans.keyframes_per_map", &motion.scans.keyframes_per_map, 1, 10000,
       "scans after which the next local map is begun"},
      {"motion.scans.decorrelation_distance_m", &motion.scans.decorrelation_distance_m, 0.01, 100,
       "m of travel over which alignments err independently"},
      {"motion.scans.decorrelation_angle_deg", &motion.scans.decorrelation_angle_deg, 0.1, 3600,
       "deg of turn over which alignments err independently"},
      {"motion.scans.transit_reach_m", &motion.scans.transit_reach_m, 0.5, 1000,
       "m; in transit only walls this near are matched"},
      {"motion.scans.min_inlier_share", &motion.scans.min_inlier_share, 0, 1,
       "share of agreeing points below which other guesses are tried"},
      {"motion.scans.repeat_difference_m", &motion.scans.repeat_difference_m, 0, 100,
       "m between wheels and last step, above which both are tried"},
      {"motion.scans.settled_deg", &motion.scans.settled_deg, 0, 180,
       "sigma of heading below which rest is not matched"},
      {"motion.scans.rest_scans", &motion.scans.rest_scans, 0, 1000,
       "nor after as many scans at rest"},
      {"motion.scans.blank_ratio", &motion.scans.blank_ratio, 1, 1e9,
       "of knowledge across and along, that makes a corridor blank"},
      {"motion.scans.overruling_sigmas", &motion.scans.overruling_sigmas, 0, 1e6,
       "of wheels, beyond which a scan has to be clear:"},
      {"motion.scans.overruling_share", &motion.scans.overruling_share, 0, 1,
       "of its points more must agree than where wheels put it"},
      {"motion.scans.lost_inlier_share", &motion.scans.lost_inlier_share, 0, 1,
       "share of agreeing points below which a scan is not believed"},
      {"motion.wheel_noise.window_m", &motion.wheel_noise.window_m, 0.01, 1000,
       "travel over which wheels and scans are compared"},
      {"motion.wheel_noise.window_deg", &motion.wheel_noise.window_deg, 1, 3600,
       "or turn, whichever comes first"},
      {"motion.wheel_noise.sure_sigma_deg", &motion.wheel_noise.sure_sigma_deg, 0, 180,
       "of a scan's heading that measures the wheels; 0: none"},
      {"motion.wheel_noise.least_scale", &motion.wheel_noise.least_scale, 1e-3, 1,
       "of the heading sigmas of motion.odometry"},
      {"motion.wheel_noise.first_windows", &motion.wheel_noise.first_windows, 1, 1e6,
       "weight of those sigmas before anything was seen"},
      {"motion.wheel_noise.remembered_windows", &motion.wheel_noise.remembered_windows, 1, 1e6,
       "after which what was seen fades"},
      {"motion.gyro_bias.rest_m", &motion.gyro_bias.rest_m, 0, 1,
       "m between two readings, below which wheels stand"},
      {"motion.gyro_bias.most_deg_per_s", &motion.gyro_bias.most_deg_per_s, 0, 10,
       "faster is a robot that turns; 0: no bias is learnt"},
      {"motion.gyro_bias.first_seconds", &motion.gyro_bias.first_seconds, 0, 1e6,
       "weight of no bias before anything was seen"},
      {"motion.gyro_bias.remembered_seconds", &motion.gyro_bias.remembered_seconds, 1, 1e6,
       "s of rest after which what was seen fades"},
      {"motion.wheelless.sigma_speed_m_per_s", &motion.wheelless.sigma_speed_m_per_s, 1e-3, 100,
       "m/s about the speed of the step before"},
      {"motion.wheelless.sigma_turn_deg_per_s", &motion.wheelless.sigma_turn_deg_per_s, 0.01, 3600,
       "deg/s about the turn of the step before"},

      {"floors.source",
       ChoiceOf(o.mapping.floors.source,
                {"auto", "labels", "pressure", "acceleration", "lidar", "none"}),
       0, 0, "what tells floors apart; auto: the best that the log holds"},
      {"floors.file", &o.mapping.floors.file, 0, 0,
       "lines `t,label`, stand for the log's FLOOR lines (--floors)"},
      {"floors.storeys.min_gap", &o.mapping.floors.storeys.min_gap, 0.5, 100,
       "m between two floors at least"},
      {"floors.storeys.typical_height", &o.mapping.floors.storeys.typical_height, 0.5, 100,
       "m between floors where nothing measures it"},
      {"floors.labels.late_s", &o.mapping.floors.labels.late_s, 0, 3600,
       "s by which a label may be late or early, where none says `-`"},
      {"floors.labels.cab_radius", &o.mapping.floors.labels.cab_radius, 0, 10,
       "m within which a robot stays in a cab"},
      {"floors.labels.least_stay_s", &o.mapping.floors.labels.least_stay_s, 0, 3600,
       "s that wheels rest in an elevator at least"},
      {"floors.pressure.heights.pressure_pa_per_m",
       &o.mapping.floors.pressure.heights.pressure_pa_per_m, 1, 100, "Pa less per metre up"},
      {"floors.pressure.heights.max_height", &o.mapping.floors.pressure.heights.max_height, 1, 1e5,
       "m from the median height; what is beyond is no reading"},
      {"floors.pressure.heights.spike_height", &o.mapping.floors.pressure.heights.spike_height,
       0.01, 1000, "m by which a lone spell may not leave its neighbours"},
      {"floors.pressure.step_height", &o.mapping.floors.pressure.step_height, 0.1, 100,
       "m between before and after: a step"},
      {"floors.pressure.moving_height", &o.mapping.floors.pressure.moving_height, 0.01, 100,
       "m: the step is still going on"},
      {"floors.pressure.landing_s", &o.mapping.floors.pressure.landing_s, 0, 3600,
       "s between flights of the same stairs at most"},
      {"floors.pressure.drift_m_per_s", &o.mapping.floors.pressure.drift_m_per_s, 0, 1,
       "m/s; sigma of the weather's steady drift"},
      {"floors.pressure.wander_m_per_sqrt_s", &o.mapping.floors.pressure.wander_m_per_sqrt_s, 0, 1,
       "m of the weather's wandering after a second"},
      {"floors.pressure.drift_window_s", &o.mapping.floors.pressure.drift_window_s, 1, 36000,
       "s before and after a transit that show the drift"},
      {"floors.pressure.cab_radius", &o.mapping.floors.pressure.cab_radius, 0, 10,
       "m within which a robot stays in a cab"},
      {"floors.pressure.least_stay_s", &o.mapping.floors.pressure.least_stay_s, 0, 3600,
       "s that wheels rest for a ride at least"},
      {"floors.pressure.least_travel_per_m", &o.mapping.floors.pressure.least_travel_per_m, 0, 100,
       "m driven per m climbed on the steepest stairs"},
      {"floors.acceleration.spell_s", &o.mapping.floors.acceleration.spell_s, 0.001, 60,
       "s over which readings are averaged"},
      {"floors.acceleration.pulse", &o.mapping.floors.acceleration.pulse, 0.001, 10,
       "m/s^2 of a cab that speeds up or slows down"},
      {"floors.acceleration.pulse_s", &o.mapping.floors.acceleration.pulse_s, 0.01, 60,
       "s that a pulse lasts at least"},
      {"floors.acceleration.rest_speed", &o.mapping.floors.acceleration.rest_speed, 0, 10,
       "m/s left after a ride at most"},
      {"floors.acceleration.rest_share", &o.mapping.floors.acceleration.rest_share, 0, 1,
       "or share of the highest speed of the ride"},
      {"floors.acceleration.longest_ride_s", &o.mapping.floors.acceleration.longest_ride_s, 1, 3600,
       "s of a ride at most"},
      {"floors.acceleration.cab_radius", &o.mapping.floors.acceleration.cab_radius, 0, 10,
       "m within which a robot stays in a cab"},
      {"floors.acceleration.least_stay_s", &o.mapping.floors.acceleration.least_stay_s, 0, 3600,
       "s that wheels rest for a ride at least"},
      {"floors.lidar.wall_distance_m", &o.mapping.floors.lidar.wall_distance_m, 0.5, 100,
       "m to the walls of a cab at most"},
      {"floors.lidar.max_area_m2", &o.mapping.floors.lidar.max_area_m2, 0.5, 1000,
       "m^2 of a cab at most"},
      {"floors.lidar.leak_share", &o.mapping.floors.lidar.leak_share, 0, 1,
       "share of beams that may pass gaps of doors"},
      {"floors.lidar.closed_s", &o.mapping.floors.lidar.closed_s, 0, 3600,
       "s for which doors are closed at least"},
      {"floors.lidar.cab_radius", &o.mapping.floors.lidar.cab_radius, 0, 10,
       "m within which a robot stays in a cab"},
      {"floors.lidar.door_distance_m", &o.mapping.floors.lidar.door_distance_m, 0, 100,
       "m from the middle of a cab that are outside"},
      {"floors.lidar.way_m", &o.mapping.floors.lidar.way_m, 0.1, 100,
       "m of the way in and out that are looked at"},
      {"floors.lidar.scene_radius_m", &o.mapping.floors.lidar.scene_radius_m, 0.5, 100,
       "m around a cab in which walls are compared"},
      {"floors.lidar.other_scene_share", &o.mapping.floors.lidar.other_scene_share, 0, 1,
       "share of walls seen alike in another scene"},
      {"floors.lidar.key_distance_m", &o.mapping.floors.lidar.key_distance_m, 0.01, 10,
       "m between the scans kept of a way"},
      {"floors.lidar.key_angle_deg", &o.mapping.floors.lidar.key_angle_deg, 0.1, 360,
       "deg between the scans kept of a way"},
      {"floors.lidar.agree_m", &o.mapping.floors.lidar.agree_m, 0.01, 10,
       "m between two views of one wall at most"},

      {"nodes.min_edge_length_m", &o.mapping.nodes.min_edge_length_m, 0.1, kFar,
       "m between scan nodes, straight line; paper: 1.5"},
      {"nodes.max_edge_length_m", &o.mapping.nodes.max_edge_length_m, 0.1, kFar,
       "m to the last node of any kind; paper: 9"},
      {"nodes.cab_m", &o.mapping.nodes.cab_m, 0, 1000,
       "m in transit above which it is stairs or a ramp"},
      {"nodes.ride_sigma_m", &o.mapping.nodes.ride_sigma_m, 1e-6, 10,
       "most that a ride in a cab may be unsure of"},
      {"nodes.ride_sigma_deg", &o.mapping.nodes.ride_sigma_deg, 1e-6, 180, "and of its heading"},
      {"nodes.kept_scan_distance_m", &o.mapping.nodes.kept_scan_distance_m, 0, kFar,
       "m of travel from one rendered scan to the next"},
      {"nodes.kept_scan_angle_deg", &o.mapping.nodes.kept_scan_angle_deg, 0, 360,
       "deg of turn from one rendered scan to the next"},

      {"masks.eccentricity.isovist.max_range_m", &o.mapping.masks.eccentricity.isovist.max_range_m,
       0.5, kFar, "m; beams end here at the latest"},
      {"masks.eccentricity.open_below", &o.mapping.masks.eccentricity.open_below, 0, 1,
       "eccentricity below which a corridor has opened"},
      {"masks.eccentricity.corridor_above", &o.mapping.masks.eccentricity.corridor_above, 0, 1,
       "eccentricity above which a place is a corridor"},
      {"masks.eccentricity.max_drift", &o.mapping.masks.eccentricity.max_drift, 0, 100,
       "distance to the centroid, in sigmas, that makes a dead end"},
      {"masks.eccentricity.drift_min_span_deg", &o.mapping.masks.eccentricity.drift_min_span_deg, 0,
       360, "deg that a scan must span for drift to be judged"},
      {"masks.openings.detection.min_range_m", &openings.detection.min_range_m, 0.1, kFar,
       "m; runs are cut from ranges above it; paper: 5"},
      {"masks.openings.detection.max_depth_m", &openings.detection.max_depth_m, 0.1, kFar,
       "m; how deep an opening may be; paper: 5"},
      {"masks.openings.detection.min_width_m", &openings.detection.min_width_m, 0, kFar,
       "m; paper: 0.75"},
      {"masks.openings.detection.min_angle_deg", &openings.detection.min_angle_deg, 0, 360,
       "deg, as seen from the laser; paper: 9"},
      {"masks.openings.detection.max_gap_deg", &openings.detection.max_gap_deg, 0, 360,
       "deg of invalid beams that do not end a run"},
      {"masks.openings.view_step_m", &openings.view_step_m, 0, kFar,
       "m from one look for openings to the next, or"},
      {"masks.openings.view_step_deg", &openings.view_step_deg, 0, 360,
       "deg turned from one to the next"},
      {"masks.openings.horizon_m", &openings.horizon_m, 0, kFar,
       "m of path over which directions are remembered"},
      {"masks.openings.min_views", &openings.min_views, 1, 10000,
       "views remembered however far back, for fast robots"},
      {"masks.openings.max_views", &openings.max_views, 1, 10000,
       "views remembered, for robots that turn on the spot"},
      {"masks.openings.min_share", &openings.min_share, 0, 1,
       "share of the remembered views that must show a direction"},
      {"masks.openings.max_deviation_deg", &openings.max_deviation_deg, 0, 180,
       "deg; standard deviation of a steady direction"},
      {"masks.openings.max_jump_deg", &openings.max_jump_deg, 0, 180,
       "deg between sightings of one direction"},
      {"masks.openings.min_turn_deg", &openings.min_turn_deg, 0, 180,
       "deg off the course, at least; paper: 40"},
      {"masks.openings.max_turn_deg", &openings.max_turn_deg, 0, 180,
       "deg off the course, at most; paper: 90"},
      {"masks.openings.course_distance_m", &openings.course_distance_m, 0.01, 100,
       "m of path that the course is taken over"},
      {"masks.openings.dead_end_turn_deg", &openings.dead_end_turn_deg, 0, 180,
       "deg turned since the last node; paper: 150"},
      {"masks.openings.dead_end_distance_m", &openings.dead_end_distance_m, 0, 100,
       "m from the last node before there is a direction"},
      {"masks.sparse.place_m", &o.mapping.masks.sparse.place_m, 0, kFar,
       "m; views nearer than this, straight line, are of one place"},
      {"masks.sparse.pass_m", &o.mapping.masks.sparse.pass_m, 0, kFar,
       "m of path that are one pass; earlier views are of another"},
      {"masks.sparse.turn_deg", &o.mapping.masks.sparse.turn_deg, 0, 180,
       "deg between views of one direction; full circles: any"},
      {"masks.sparse.drift_share", &o.mapping.masks.sparse.drift_share, 0, 10,
       "drift of odometry, m per m of path since the earlier view"},

      {"candidates.max_mahalanobis", &o.mapping.closures.candidates.max_mahalanobis, 0, 1000,
       "distance of a pair still matched; MaxMaha of the paper: 5"},
      {"candidates.max_matches", &o.mapping.closures.candidates.max_matches, 0, 10000,
       "pairs offered per node; MaxMatches of the paper: 5"},
      {"candidates.match_range_m", &o.mapping.closures.candidates.match_range_m, 0.01, 100,
       "m at which two scans can still be matched; R of the paper: 2"},

      {"matcher.table.resolution_m", &o.mapping.closures.matcher.table.resolution_m, 0.005, 1,
       "m; side of a cell of the look-up table"},
      {"matcher.table.sigma_m", &o.mapping.closures.matcher.table.sigma_m, 0.005, 2,
       "m; blur of the look-up table"},
      {"matcher.table.max_range_m", &o.mapping.closures.matcher.table.max_range_m, 1, 100,
       "m; points farther away are left out"},
      {"matcher.table.join_gap_m", &o.mapping.closures.matcher.table.join_gap_m, 0, 10,
       "m; nearer consecutive points are joined by a line; 0: never"},
      {"matcher.table.levels", &o.mapping.closures.matcher.table.levels, 1, 16,
       "of the pyramid, cells included"},
      {"matcher.min_score", &o.mapping.closures.matcher.min_score, 0, 1,
       "how much scans must overlap; MinScore of the paper: 0.425"},
      {"matcher.window_sigmas", &o.mapping.closures.matcher.window_sigmas, 0.1, 100,
       "half the search window, in sigmas of the guess"},
      {"matcher.min_window_m", &o.mapping.closures.matcher.min_window_m, 0, 100,
       "m; half the search window at least"},
      {"matcher.max_window_m", &o.mapping.closures.matcher.max_window_m, 0, 100,
       "m; half the search window at most"},
      {"matcher.min_window_deg", &o.mapping.closures.matcher.min_window_deg, 0, 180,
       "deg; half the search window at least"},
      {"matcher.max_window_deg", &o.mapping.closures.matcher.max_window_deg, 0, 180,
       "deg; half the search window at most"},
      {"matcher.angle_step_deg", &o.mapping.closures.matcher.angle_step_deg, 0.01, 45,
       "deg between search angles"},
      {"matcher.point_spacing_m", &o.mapping.closures.matcher.point_spacing_m, 0, 10,
       "m; scans are thinned to one point per cell of this size"},
      {"matcher.prior_weight", &o.mapping.closures.matcher.prior_weight, 0, 1,
       "score lost per chi^2 of the distance from the guess"},
      {"matcher.table_memory_mib", &o.mapping.closures.matcher.table_memory_mib, 1, 1 << 20,
       "MiB of look-up tables kept"},

      {"matcher.look_elsewhere", &o.mapping.closures.matcher.look_elsewhere, 0, 0,
       "also look for a second place in the window that fits"},
      {"matcher.elsewhere_m", &o.mapping.closures.matcher.elsewhere_m, 0, 100,
       "m from the match that is elsewhere"},
      {"matcher.elsewhere_deg", &o.mapping.closures.matcher.elsewhere_deg, 0, 180,
       "deg from the match that is elsewhere"},
      {"matcher.elsewhere_floor", &o.mapping.closures.matcher.elsewhere_floor, 0, 1,
       "share of the match's score that another place must reach"},
      {"matcher.refine.max_iterations", &o.mapping.closures.matcher.refine.max_iterations, 0, 1000,
       "of the climb from the best cell to the maximum"},
      {"matcher.refine.max_shift_m", &o.mapping.closures.matcher.refine.max_shift_m, 0, 10,
       "m that the climb may go at most"},
      {"matcher.refine.max_turn_deg", &o.mapping.closures.matcher.refine.max_turn_deg, 0, 90,
       "deg that the climb may turn at most"},
      {"matcher.refine.sharpness", &o.mapping.closures.matcher.refine.sharpness, 0.1, 1e4,
       "likelihood of a pose = exp(sharpness * score)"},
      {"matcher.refine.floor_sigma_m", &o.mapping.closures.matcher.refine.floor_sigma_m, 1e-4, 10,
       "m; added to a match's covariance: what no score knows"},
      {"matcher.refine.floor_sigma_deg", &o.mapping.closures.matcher.refine.floor_sigma_deg, 1e-3,
       90, "deg; the same for the angle"},
      {"matcher.refine.reach_m", &o.mapping.closures.matcher.refine.reach_m, 0.1, 100,
       "m around the maximum that the response surface is looked at"},

      {"submaps.half_length_m", &o.mapping.closures.submaps.half_length_m, 0.1, 100,
       "m of travel before and after a node that its submap holds"},
      {"submaps.min_inlier_share", &o.mapping.closures.submaps.min_inlier_share, 0, 1,
       "share of a scan's points that must agree with a submap"},
      {"submaps.max_correction_m", &o.mapping.closures.submaps.max_correction_m, 0, 10,
       "m that a refinement may move a match"},
      {"submaps.max_correction_deg", &o.mapping.closures.submaps.max_correction_deg, 0, 90,
       "deg that a refinement may turn a match"},
      {"submaps.sigma_floor_m", &o.mapping.closures.submaps.sigma_floor_m, 1e-6, 10,
       "m; added to a refined match: no submap is perfect"},
      {"submaps.sigma_floor_deg", &o.mapping.closures.submaps.sigma_floor_deg, 1e-6, 90,
       "deg; the same"},
      {"submaps.prior_weight", &o.mapping.closures.submaps.prior_weight, 1e-6, 1,
       "say of the coarse match beside the points'"},
      {"submaps.cached", &o.mapping.closures.submaps.cached, 1, 1e6, "submaps kept in memory"},

      {"ambiguity.max_sigma_m", &o.mapping.closures.ambiguity.max_sigma_m, 0.001, 1000,
       "m; a match less sure in any direction is no closure"},
      {"ambiguity.max_sigma_deg", &o.mapping.closures.ambiguity.max_sigma_deg, 0.01, 360,
       "deg; the same"},

      {"floor_joins.reach_m", &o.mapping.floor_joins.reach_m, 0.1, 1000,
       "m from a node to its neighbours on an older floor"},
      {"floor_joins.sigma_m", &o.mapping.floor_joins.sigma_m, 1e-3, 100,
       "m, of where motion through rides puts them"},
      {"floor_joins.sigma_deg", &o.mapping.floor_joins.sigma_deg, 1e-3, 180, "and of the heading"},
      {"floor_joins.agree_m", &o.mapping.floor_joins.agree_m, 1e-3, 100,
       "m between places that are shifted alike"},
      {"floor_joins.agree_deg", &o.mapping.floor_joins.agree_deg, 1e-3, 180,
       "the same of their headings"},
      {"floor_joins.min_places", &o.mapping.floor_joins.min_places, 1, 10000,
       "places that agree, for two visits to be of one floor"},
      {"floor_joins.min_share", &o.mapping.floor_joins.min_share, 0, 1,
       "of the places that have a neighbour"},
      {"drive_joins.search.resolution_m", &o.drive_joins.search.resolution_m, 0.05, 2,
       "m; side of a cell, where a whole floor is searched"},
      {"drive_joins.search.sigma_m", &o.drive_joins.search.sigma_m, 0.05, 2,
       "m; blur of its walls"},
      {"drive_joins.search.angle_step_deg", &o.drive_joins.search.angle_step_deg, 0.25, 10,
       "deg between headings"},
      {"drive_joins.search.point_spacing_m", &o.drive_joins.search.point_spacing_m, 0.05, 5,
       "m; a place is thinned to one point per cell of this size"},
      {"drive_joins.search.max_range_m", &o.drive_joins.search.max_range_m, 1, kFar,
       "m; of a place that is looked for"},
      {"drive_joins.search.min_score", &o.drive_joins.search.min_score, 0.1, 1,
       "below which a place is not found"},
      {"drive_joins.stretch_m", &o.drive_joins.stretch_m, 0, kFar,
       "m of travel before and after a node that make it a place"},
      {"drive_joins.place_spacing_m", &o.drive_joins.place_spacing_m, 0.1, kFar,
       "m from place to place"},
      {"drive_joins.searched_places", &o.drive_joins.searched_places, 1, 10000,
       "places looked for everywhere; others where those say"},
      {"drive_joins.min_score", &o.drive_joins.min_score, 0.1, 1, "of a place that fits"},
      {"drive_joins.agree_m", &o.drive_joins.agree_m, 1e-3, 100,
       "m between a place and where all of them together put it"},
      {"drive_joins.min_places", &o.drive_joins.min_places, 1, 10000,
       "places that fit and agree, for drives to be of one building"},
      {"drive_joins.min_share", &o.drive_joins.min_share, 0, 1,
       "of the places that lie within the older map"},
      {"drive_joins.min_spread_m", &o.drive_joins.min_spread_m, 0, kFar,
       "m between the two places farthest apart"},
      {"drive_joins.clear_lead", &o.drive_joins.clear_lead, 0, 1,
       "of score, by which a place speaks against another way"},
      {"drive_joins.places_needed", &o.drive_joins.places_needed, 1, 1000,
       "stands for the validator's: where the drive lies is known"},
      {"drive_joins.reach_m", &o.drive_joins.reach_m, 0.1, kFar,
       "m from a node to those of the older map it is tried with"},
      {"drive_joins.sigma_m", &o.drive_joins.sigma_m, 1e-3, 100, "m, of where the places put it"},
      {"drive_joins.sigma_deg", &o.drive_joins.sigma_deg, 1e-3, 180, "and of the heading"},
      {"validator.votes_needed", &o.mapping.closures.validator.votes_needed, 1, 1000,
       "loops that must agree with a closure; paper: 6"},
      {"validator.max_loop_error", &o.mapping.closures.validator.max_loop_error, 0.01, 1000,
       "distance from identity of an agreeing loop; paper: 2"},
      {"validator.max_loop_trace", &o.mapping.closures.validator.max_loop_trace, 1e-6, 1e6,
       "m^2 + rad^2 of covariance beyond which a loop is no evidence"},
      {"validator.tight_loop_trace", &o.mapping.closures.validator.tight_loop_trace, 0, 1e6,
       "m^2 + rad^2 up to which every loop is evidence of its own"},
      {"validator.max_loose_votes", &o.mapping.closures.validator.max_loose_votes, 0, 1000,
       "votes from looser loops at most"},
      {"validator.sure_loop_trace", &o.mapping.closures.validator.sure_loop_trace, 0, kFar,
       "up to which a loop of validated closures alone suffices"},
      {"validator.places_needed", &o.mapping.closures.validator.places_needed, 1, 1000,
       "places that must agree before unconfirmed closures enter"},
      {"validator.place_radius_m", &o.mapping.closures.validator.place_radius_m, 0, 1000,
       "m beyond which two places are two"},
      {"validator.max_contradiction", &o.mapping.closures.validator.max_contradiction, 0.01, 1000,
       "distance at which the best validated way forbids a closure"},
      {"validator.hopeless_loops", &o.mapping.closures.validator.hopeless_loops, 1, 100000,
       "disagreeing loops after which a hypothesis is left"},
      {"validator.max_loops", &o.mapping.closures.validator.max_loops, 1, 100000,
       "loops looked at for one hypothesis"},

      {"optimizer.solver.max_iterations", &o.mapping.closures.optimizer.solver.max_iterations, 0,
       100000, "of one solve"},
      {"optimizer.solver.function_tolerance",
       &o.mapping.closures.optimizer.solver.function_tolerance, 0, 1,
       "relative decrease of chi^2 at which a solve ends"},
      {"optimizer.settled_m", &o.mapping.closures.optimizer.settled_m, 0, 10,
       "m; a closure that fits this well waits for the next solve"},
      {"optimizer.settled_deg", &o.mapping.closures.optimizer.settled_deg, 0, 90, "deg; the same"},
      {"optimizer.far_off_chi2", &o.mapping.closures.optimizer.far_off_chi2, 0, 1e12,
       "chi^2 of new closures above which all is solved at once"},
      {"optimizer.first_part_nodes", &o.mapping.closures.optimizer.first_part_nodes, 2, 1000000,
       "nodes that move in the first, smallest solve"},
      {"optimizer.negligible_gain", &o.mapping.closures.optimizer.negligible_gain, 0, 1e6,
       "decrease of chi^2 below which no larger part is solved"},

      {"polish.most_m", &o.mapping.closures.polish.most_m, 0, 100,
       "m between a late closure and the map; 0: none is late"},
      {"polish.most_deg", &o.mapping.closures.polish.most_deg, 0, 180, "deg, the same"},
      {"polish.revisits.distance_m", &o.mapping.closures.polish.revisits.distance_m, 0, 100,
       "m between two nodes that see one place"},
      {"polish.revisits.walk_m", &o.mapping.closures.polish.revisits.walk_m, 0, 1e6,
       "m along edges, up to which two nodes are joined already"},
      {"audit.max_chi2", &o.mapping.closures.audit.max_chi2, 0.1, 1e6,
       "chi^2 above which a closure disagrees with the map"},
      {"audit.tolerance_m", &o.mapping.closures.audit.tolerance_m, 0, 10,
       "m by which a closure may be off and not be wrong"},
      {"audit.tolerance_deg", &o.mapping.closures.audit.tolerance_deg, 0, 180, "deg; the same"},

      {"grid.resolution_m", &o.grid.resolution_m, 0.01, 1, "m; side of a cell of the grid"},
      {"grid.max_usable_range_m", &o.grid.max_usable_range_m, 0.5, kFar,
       "m; beams are drawn up to here"},
      {"grid.free_range_without_return_m", &o.grid.free_range_without_return_m, 0, kFar,
       "m that a beam clears which met nothing; 0: it does not"},
      {"grid.occupied_ratio", &o.grid.occupied_ratio, 0, 1,
       "share of hits among visits from which a cell is a wall"},
      {"grid.min_hits", &o.grid.min_hits, 1, 1000, "hits that a wall cell has at least"},

      {"octree.wall_height_m", &o.octree.wall_height_m, 0.01, 100,
       "m; walls reach from the floor's elevation up to here"},
      {"octree.free_height_m", &o.octree.free_height_m, 0.01, 100,
       "m of free space, rounded to a power of two of voxels"},
  };
}

std::string ValueText(const OptionEntry& entry) {
  struct {
    std::string operator()(const bool* field) const { return *field ? "true" : "false"; }
    std::string operator()(const double* field) const { return NumberText(*field); }
    std::string operator()(const std::string* field) const { return *field; }
    std::string operator()(const int* field) const { return std::to_string(*field); }
    std::string operator()(const std::size_t* field) const { return std::to_string(*field); }
    std::string operator()(const Choice& choice) const { return choice.names.at(choice.get()); }
  } text;
  return std::visit(text, entry.field);
}

std::string RangeText(const OptionEntry& entry) {
  if (std::holds_alternative<bool*>(entry.field)) return "true or false";
  if (std::holds_alternative<std::string*>(entry.field)) return "a name";
  const auto* choice = std::get_if<Choice>(&entry.field);
  if (choice == nullptr) return NumberText(entry.min) + " to " + NumberText(entry.max);
  std::string names;
  for (std::size_t i = 0; i < choice->names.size(); ++i) {
    if (i > 0) names += i + 1 < choice->names.size() ? ", " : " or ";
    names += choice->names[i];
  }
  return names;
}

void SetOption(const std::string& where, const std::string& key, const std::string& value,
               Options& options) {
  const std::vector<OptionEntry> table = OptionTable(options);
  const auto entry = std::find_if(table.begin(), table.end(),
                                  [&](const OptionEntry& known) { return known.key == key; });
  if (entry == table.end()) {
    throw InputError(where + ": unknown option " + Quoted(key) + NearestKey(key, table));
  }
  const auto fail = [&](const std::string& expected) {
    throw InputError(where + ": " + key + " must be " + expected + ", not " + Quoted(value));
  };
  if (const auto* choice = std::get_if<Choice>(&entry->field)) {
    const auto name = std::find(choice->names.begin(), choice->names.end(), value);
    if (name == choice->names.end()) fail(RangeText(*entry));
    choice->set(static_cast<std::size_t>(name - choice->names.begin()));
    return;
  }
  std::visit(
      [&](auto field) {
        if constexpr (!std::is_same_v<decltype(field), Choice>) {
          using Value = std::remove_pointer_t<decltype(field)>;
          Value parsed{};
          if (!ParseValue(value, parsed)) fail(TypeName<Value>());
          if constexpr (!std::is_same_v<Value, std::string>) {
            const auto number = static_cast<double>(parsed);
            if (!std::is_same_v<Value, bool> && (number < entry->min || number > entry->max)) {
              fail(RangeText(*entry));
            }
          }
          *field = parsed;
        }
      },
      entry->field);
}

void SetOption(const std::string& assignment, Options& options) {
  const std::size_t equals = assignment.find('=');
  if (equals == std::string::npos) {
    throw InputError("--set " + Quoted(assignment) + ": expected key=value");
  }
  SetOption("--set", assignment.substr(0, equals), assignment.substr(equals + 1), options);
}

void CheckOptions(const Options& options) {
  struct Order {
    const char* least_key;
    double least;
    const char* most_key;
    double most;
  };
  const NodeOptions& nodes = options.mapping.nodes;
  const MatcherOptions& matcher = options.mapping.closures.matcher;
  const OpeningsMaskOptions& openings = options.mapping.masks.openings;
  const EccentricityMaskOptions& eccentricity = options.mapping.masks.eccentricity;
  for (const Order& order : {
           Order{"nodes.min_edge_length_m", nodes.min_edge_length_m, "nodes.max_edge_length_m",
                 nodes.max_edge_length_m},
           Order{"matcher.min_window_m", matcher.min_window_m, "matcher.max_window_m",
                 matcher.max_window_m},
           Order{"matcher.min_window_deg", matcher.min_window_deg, "matcher.max_window_deg",
                 matcher.max_window_deg},
           Order{"masks.openings.min_turn_deg", openings.min_turn_deg,
                 "masks.openings.max_turn_deg", openings.max_turn_deg},
           Order{"masks.openings.min_views", static_cast<double>(openings.min_views),
                 "masks.openings.max_views", static_cast<double>(openings.max_views)},
           Order{"masks.eccentricity.open_below", eccentricity.open_below,
                 "masks.eccentricity.corridor_above", eccentricity.corridor_above},
       }) {
    if (order.least > order.most) {
      throw InputError(std::string(order.least_key) + " (" + NumberText(order.least) +
                       ") must not be above " + order.most_key + " (" + NumberText(order.most) +
                       ")");
    }
  }
  if (options.mapping.log.max_range > 0.0 &&
      options.mapping.log.min_range >= options.mapping.log.max_range) {
    throw InputError("log.min_range (" + NumberText(options.mapping.log.min_range) +
                     ") must be below log.max_range (" + NumberText(options.mapping.log.max_range) +
                     ")");
  }
  const LocalMapOptions& local_map = options.mapping.motion.scans.map;
  constexpr double kMostCells = 5000.0;  // from the middle: the map then takes 400 MB
  if (local_map.reach_m > kMostCells * local_map.cell_m) {
    throw InputError("motion.scans.map.reach_m (" + NumberText(local_map.reach_m) +
                     ") must not be above " + NumberText(kMostCells) +
                     " times motion.scans.map.cell_m (" + NumberText(local_map.cell_m) + ")");
  }
  const FloorSource source = options.mapping.floors.source;
  if (!options.mapping.floors.file.empty() && source != FloorSource::kAuto &&
      source != FloorSource::kLabels) {
    throw InputError("a file of floors needs floors.source auto or labels");
  }
}

std::vector<std::pair<std::string, OptionValue>> OptionValues(const Options& options) {
  struct {
    OptionValue operator()(const bool* field) const { return *field; }
    OptionValue operator()(const double* field) const { return *field; }
    OptionValue operator()(const int* field) const { return std::int64_t{*field}; }
    OptionValue operator()(const std::size_t* field) const {
      return static_cast<std::int64_t>(*field);
    }
    OptionValue operator()(const std::string* field) const { return *field; }
    OptionValue operator()(const Choice& choice) const { return choice.names.at(choice.get()); }
  } value;
  Options copy = options;
  std::vector<std::pair<std::string, OptionValue>> values;
  for (const OptionEntry& entry : OptionTable(copy)) {
    if (entry.key != "threads") values.emplace_back(entry.key, std::visit(value, entry.field));
  }
  return values;
}

}  // namespace masked_mapper
