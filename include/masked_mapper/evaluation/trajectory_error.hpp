// SPDX-License-Identifier: BSD-3-Clause
// How far a trajectory is from the truth: absolute, as it stands and after the best rigid
// alignment, over all and per floor; and relative, over stretches of the way.
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "masked_mapper/evaluation/error_statistics.hpp"
#include "masked_mapper/evaluation/result_folder.hpp"
#include "masked_mapper/evaluation/truth.hpp"

namespace masked_mapper {

struct AbsoluteError {
  ErrorStatistics position_m;  ///< in the plane
  ErrorStatistics heading_deg;
};

struct FloorError {
  std::string label;
  AbsoluteError as_it_stands;
  AbsoluteError aligned;  ///< each floor by itself
};

struct TrajectoryError {
  std::size_t scans = 0;
  std::size_t paired = 0;  ///< scans whose true pose is known (`TruePoseAt`)
  AbsoluteError as_it_stands;
  AbsoluteError aligned;
  ErrorStatistics elevation_m;
  double relative_over_m = 10.0;  ///< length of the stretches along the true way
  ErrorStatistics relative_translation_m;
  ErrorStatistics relative_rotation_deg;
  std::vector<FloorError> floors;  ///< the map's floors that have paired scans
};

/// Nothing when no scan is paired. `floors` may be empty.
std::optional<TrajectoryError> CompareWithTruth(const std::vector<StampedPose>& trajectory,
                                                const Truth& truth,
                                                const std::vector<MappedFloor>& floors);

}  // namespace masked_mapper
