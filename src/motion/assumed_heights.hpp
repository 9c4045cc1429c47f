// SPDX-License-Identifier: BSD-3-Clause
// Elevations of levels of which no sensor tells the height.
#pragma once

#include <vector>

#include "masked_mapper/motion/floor_timeline.hpp"

namespace masked_mapper {

/// By the number on the label, from the nearest numbered level; levels without a number stand above
/// all others (ours).
std::vector<FloorLevel> WithAssumedHeights(std::vector<FloorLevel> levels,
                                           const StoreyOptions& storeys);

}  // namespace masked_mapper
