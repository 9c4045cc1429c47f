// SPDX-License-Identifier: BSD-3-Clause
// How far a trajectory is from the truth: absolute, as it stands and after the best rigid
// alignment, over all and per floor; and relative, over stretches of the way.
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "masked_mapper/evaluation/evaluation.hpp"
#include "result_folder.hpp"
#include "truth.hpp"

namespace masked_mapper {

/// Nothing when no scan is paired. `floors` may be empty.
std::optional<TrajectoryError> CompareWithTruth(const std::vector<StampedPose>& trajectory,
                                                const Truth& truth,
                                                const std::vector<MappedFloor>& floors);

}  // namespace masked_mapper
