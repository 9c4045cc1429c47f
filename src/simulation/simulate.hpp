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

#include "masked_mapper/log/log_writer.hpp"
#include "masked_mapper/sensor/observation.hpp"
#include "masked_mapper/simulation/building.hpp"
#include "masked_mapper/simulation/simulation.hpp"

namespace masked_mapper {

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

/// Throws InputError when the building cannot be driven or an option is out of range.
SimulationSummary Simulate(const Building& building, const SimulationOptions& options,
                           const SimulationNoise& noise, const SimulationSink& sink);

}  // namespace masked_mapper
