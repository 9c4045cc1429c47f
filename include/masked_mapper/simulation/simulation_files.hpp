// SPDX-License-Identifier: BSD-3-Clause
// A simulation as files: the log, and beside it what was true.
#pragma once

#include <functional>
#include <string>

#include "masked_mapper/simulation/building.hpp"
#include "masked_mapper/simulation/simulation.hpp"

namespace masked_mapper {

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
