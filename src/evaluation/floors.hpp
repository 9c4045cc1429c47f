// SPDX-License-Identifier: BSD-3-Clause
// Does the map know on which floor each scan was taken?
#pragma once

#include <cstddef>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "masked_mapper/evaluation/evaluation.hpp"
#include "result_folder.hpp"
#include "truth.hpp"

namespace masked_mapper {

/// The map names floors by their place unless the log gives labels, and the truth may name them in
/// another way: labels are matched one to one, the pair that most scans agree on first (of equals,
/// the pair of the same text, then in order of labels).
/// Nothing when no scan outside transit has a true floor, or the map has no floors.
std::optional<FloorIdentity> CompareFloors(const std::vector<StampedPose>& trajectory,
                                           const std::vector<MappedFloor>& floors,
                                           const std::vector<FloorLabel>& truth);

}  // namespace masked_mapper
