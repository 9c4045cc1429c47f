// SPDX-License-Identifier: BSD-3-Clause
// A robot's drive through a simulated building: what its log would say, and what was true.
// The perfect world (options) and what spoils it (noise) are apart; every random number comes from
// the seed, so the same input gives the same observations everywhere.
#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "masked_mapper/sensor/observation.hpp"
#include "masked_mapper/simulation/acceleration.hpp"
#include "masked_mapper/simulation/building.hpp"
#include "masked_mapper/simulation/lidar_simulation.hpp"
#include "masked_mapper/simulation/odometry_simulation.hpp"
#include "masked_mapper/simulation/pressure.hpp"
#include "masked_mapper/simulation/robot_drive.hpp"
#include "masked_mapper/simulation/space_lidar.hpp"

namespace masked_mapper {

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

/// The truth at the stamp of a scan. `world` is the robot's first pose.
struct TruthPose {
  double stamp = 0.0;
  Pose2 T_world_robot;
  double elevation = 0.0;  ///< m above the floor of the start
  std::string floor;       ///< label; `-` in transit
};

/// Where a simulation goes; all may be empty.
struct SimulationSink {
  std::function<void(const Observation&)> observation;  ///< in order of stamps
  std::function<void(const CloudReading&)> cloud;       ///< among them
  std::function<void(const TruthPose&)> truth;          ///< one per scan, just before it
  std::function<void(double)> progress;                 ///< share done, 0 to 1
};

struct SimulationSummary {
  double seconds = 0.0;  ///< of simulated time
  double length = 0.0;   ///< m driven
  std::uint64_t scans = 0;
  std::uint64_t floor_changes = 0;
  Pose2 T_building_world;   ///< where the drive began, in the building's plan
  std::string start_floor;  ///< label
};

/// Throws InputError when the building cannot be driven or an option is out of range.
SimulationSummary Simulate(const Building& building, const SimulationOptions& options,
                           const SimulationNoise& noise, const SimulationSink& sink);

}  // namespace masked_mapper
