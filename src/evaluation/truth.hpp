// SPDX-License-Identifier: BSD-3-Clause
// The truth that a map is held against: exact, from the simulator, or a reference trajectory by
// another mapper, which has key poses only and is good to some centimetres.
//
// Truth and map hold poses of the robot. A reference trajectory may hold those of the laser
// instead: its errors then contain the laser's offset on the robot, a constant after alignment but
// for turns.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "masked_mapper/sensor/observation.hpp"
#include "stamped_trajectory.hpp"

namespace masked_mapper {

struct Truth {
  std::vector<StampedPose> poses;  ///< in order of stamps
  bool exact = false;
  std::vector<FloorLabel> floors;  ///< may be empty
};

/// Exact when the name ends in `.truth.tum`. Floors are read from the file beside it whose name has
/// `.truth_floors.csv` in place of `.truth.tum` (else of the last ending), when there is one.
/// Throws InputError.
Truth ReadTruth(const std::string& path);

/// The true pose at a stamp that the truth has a word for: exact truth between poses at most 1 s
/// apart; a reference at its key poses alone (within 5 ms).
std::optional<StampedPose> TruePoseAt(const Truth& truth, double stamp);

/// The true pose at any stamp. Between the key poses of a reference, straight lines would be off by
/// degrees: the nearest key pose, at most 5 s away, is carried by the map's own motion, which is
/// accurate over such a time.
std::optional<StampedPose> CarriedTruePoseAt(const Truth& truth,
                                             const std::vector<StampedPose>& trajectory,
                                             double stamp);

/// The same at each of the log's stamps of the nodes.
std::vector<std::optional<StampedPose>> TruePosesOf(const std::vector<double>& log_stamps,
                                                    const Truth& truth,
                                                    const std::vector<StampedPose>& trajectory);

/// Heights closer than this are one floor.
constexpr double kSameFloorHeight = 1.0;  // m

}  // namespace masked_mapper
