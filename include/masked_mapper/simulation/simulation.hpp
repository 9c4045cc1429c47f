// SPDX-License-Identifier: BSD-3-Clause
// A simulated drive: what is asked of it, what spoils it, and what came of it as files: the log,
// and beside it what was true. The perfect world (options) and what spoils it (noise) are apart.
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "masked_mapper/geometry/pose2.hpp"
#include "masked_mapper/log/log_writer.hpp"
#include "masked_mapper/simulation/building.hpp"

namespace masked_mapper {

/// How the robot drives.
struct DriveOptions {
  std::uint64_t seed = 1;
  double robot_radius = 0.3;       ///< m; nothing that stands comes nearer to its centre
  double speed_min = 0.5;          ///< m/s, the pace of a stretch is drawn between these
  double speed_max = 0.7;          ///< m/s
  double stairs_speed = 0.35;      ///< m/s
  double acceleration = 0.5;       ///< m/s^2
  double turn_rate = 0.8;          ///< rad/s
  double turn_acceleration = 1.6;  ///< rad/s^2
  double wander = 0.25;            ///< m, off the middle of the way at most
  double rest_every = 25.0;        ///< m between stops, on average
  double rest_per_metre = 0.2;     ///< s of standing about per metre driven, on average
};

/// People who walk about.
struct PeopleOptions {
  double per_kilometre = 25.0;   ///< people per km of passages; 0: an empty building
  double speed = 1.2;            ///< m/s
  double aside = 0.55;           ///< m, off the middle of the way, to their right
  double leg_radius = 0.07;      ///< m
  double stand_share = 0.25;     ///< of the ways after which one stops for a while
  double keep_from_robot = 0.7;  ///< m; nearer than that they step out of the scan
};

/// The scanner itself; the defaults are those of the named buildings.
struct LidarOptions {
  double rate = 5.0;  ///< Hz
  std::size_t beams = 361;
  double field_of_view_deg = 270.0;  ///< from the first beam to the last; 360: evenly all round
  double max_range = 30.0;           ///< m
  double min_range = 0.05;           ///< m, nearer things are not seen
  Pose2 T_robot_laser{0.12, 0.0, 0.0};
};

struct LidarNoise {
  double sigma = 0.02;         ///< m
  double resolution = 0.01;    ///< m, ranges are multiples of it; 0: exact
  double glass_return = 0.75;  ///< chance that glass returns a beam that meets it squarely; at
                               ///< slant angles it falls with the square of the cosine
  double lost = 0.0005;        ///< chance that a beam does not return at all
  PeopleOptions people;

  /// Nothing but walls: every beam ends at the first thing standing, glass included.
  static LidarNoise None();
};

enum class SpaceLidarModel { kVlp16, kOs132, kMid360 };
/// By the names of the command line; empty: none of them.
std::optional<SpaceLidarModel> SpaceLidarCalled(const std::string& name);
std::vector<std::string> SpaceLidarNames();

/// What is public of such a lidar, in its usual mode.
struct SpaceLidarOptions {
  SpaceLidarModel model = SpaceLidarModel::kVlp16;
  double turn_rate = 10.0;                         ///< Hz, in which a sweep is taken
  double rate = 10.0;                              ///< Hz, of the sweeps that are recorded
  double max_range = 100.0;                        ///< m
  double min_range = 0.3;                          ///< m
  double sigma = 0.02;                             ///< m
  Eigen::Vector3d lidar_on_robot{0.12, 0.0, 0.6};  ///< m; it stands upright and looks ahead
  CloudLayout layout = CloudLayout::kVelodyne;
};
SpaceLidarOptions OptionsOf(SpaceLidarModel model);

/// Of wheels and a gyro.
struct OdometryNoise {
  double scale_error = 0.02;            ///< of the distance; its sign is drawn
  double distance_sigma = 0.01;         ///< m per square root of a metre
  double slip_forward = 0.03;           ///< m lost per radian turned while driving
  double slip_sideways = 0.02;          ///< m drifted outwards per radian turned while driving
  double turn_sigma_deg = 0.3;          ///< deg per square root of a radian turned
  double gyro_bias_deg_s = 0.003;       ///< deg/s, constant; its sign is drawn
  double gyro_wander_deg_s = 0.0008;    ///< deg/s, deviation of the part that wanders
  double gyro_wander_seconds = 1800.0;  ///< over which it forgets

  static OdometryNoise None();
};

/// A barometer.
struct PressureOptions {
  double rate = 2.0;             ///< Hz; 0: no barometer
  double sea_level = 101'325.0;  ///< Pa, on the building's height 0 on an average day
};

struct PressureNoise {
  double sigma = 0.25;                 ///< m, as height
  double weather = 1.5;                ///< m, amplitude of each of three slow waves of 2 to 8 hours
  double ventilation = 0.15;           ///< m, deviation of what ventilation adds
  double ventilation_seconds = 300.0;  ///< over which that forgets

  static PressureNoise None();
};

/// An accelerometer.
struct AccelerationOptions {
  double rate = 0.0;  ///< Hz; 0: no accelerometer
};

struct AccelerationNoise {
  double sigma = 0.03;      ///< m/s^2, at rest
  double vibration = 0.25;  ///< m/s^2 more per m/s of driving
  double bias = 0.04;       ///< m/s^2, deviation of each axis' constant error

  static AccelerationNoise None();
};

struct SimulationOptions {
  std::uint64_t seed = 1;
  /// Which drive through the building of `seed`: another start, order, noise and people. Tour 1 is
  /// the building's usual one.
  std::uint64_t tour = 1;
  double length = 0.0;              ///< m; the tour goes on until it is at least this long
  std::vector<std::size_t> visits;  ///< floors in order of visiting; empty: as is usual there
  DriveOptions drive;               ///< its seed is set from `seed`
  bool usual_rest = true;           ///< stand about as long as is usual in the building
  LidarOptions lidar;
  std::optional<SpaceLidarOptions> space_lidar;  ///< in place of the 2D scanner
  double odometry_rate = 10.0;  ///< Hz, of readings besides those in scans; 0: none
  PressureOptions pressure;
  AccelerationOptions acceleration;
  bool floor_labels = false;             ///< say which floor, as an elevator's interface would
  double first_stamp = 1'500'000'000.0;  ///< s
};

struct SimulationNoise {
  LidarNoise lidar;
  OdometryNoise odometry;
  PressureNoise pressure;
  AccelerationNoise acceleration;

  static SimulationNoise None();
};

struct SimulationSummary {
  double seconds = 0.0;  ///< of simulated time
  double length = 0.0;   ///< m driven
  std::uint64_t scans = 0;
  std::uint64_t floor_changes = 0;
  Pose2 T_building_world;   ///< where the drive began, in the building's plan
  std::string start_floor;  ///< label
};

/// For `dir/campus.log.gz`: `dir/campus.log.truth.tum` and `dir/campus.log.truth_floors.csv`.
struct SimulationPaths {
  std::string log;
  std::string truth;         ///< `t x y z qx qy qz qw` of T_world_robot, one line per scan
  std::string truth_floors;  ///< header `t,label`, one line per scan, `-` in transit
};
SimulationPaths PathsOf(const std::string& log_path);

/// Simulates and writes the three files; what stood there is replaced once all are complete.
/// Throws InputError as Simulate does, and std::runtime_error when a file cannot be written (no
/// file is left half-written then).
SimulationSummary SimulateToFiles(const Building& building, const SimulationOptions& options,
                                  const SimulationNoise& noise, const std::string& log_path,
                                  const std::function<void(double)>& progress);

}  // namespace masked_mapper
