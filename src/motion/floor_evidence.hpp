// SPDX-License-Identifier: BSD-3-Clause
// Changes of floor from all sensors at once. Each says what it noticed and when it was listening: a
// barometer that stopped says nothing of what came after, and what is left then decides.
#pragma once

#include <vector>

#include "masked_mapper/motion/floor_timeline.hpp"
#include "wheel_track.hpp"

namespace masked_mapper {

/// What one sensor says.
struct FloorEvidence {
  std::vector<FloorTransit> transits;  ///< in order, not overlapping
  std::vector<TimeSpan> heard;         ///< in order: it would have noticed a change within
};

/// The spans of readings at these stamps, in order, that no gap longer than `longest_gap_s` parts.
std::vector<TimeSpan> SpansOf(const std::vector<double>& stamps, double longest_gap_s);

/// `evidence` from the best sensor to the least. A transit of a lesser one counts where no better
/// one listened; where two noticed the same, their climbs are weighed by their variances.
std::vector<FloorTransit> Fused(const std::vector<FloorEvidence>& evidence);

}  // namespace masked_mapper
