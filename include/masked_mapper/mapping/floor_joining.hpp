// SPDX-License-Identifier: BSD-3-Clause
// Floors met again that nothing but the map can tell. A robot without pressure, labels or
// acceleration notices that it changed floors, not to which: every ride opens a new level. Where
// the scans of such a level fit an older one, node by node and all shifted alike, the two are one
// floor. Choices of ours; the paper's robot knows its floor.
#pragma once

#include <string>
#include <vector>

#include "masked_mapper/mapping/mapping_result.hpp"
#include "masked_mapper/mapping/options.hpp"
#include "masked_mapper/motion/floor_timeline.hpp"

namespace masked_mapper {

struct FloorJoining {
  FloorTimeline floors;            ///< every level's identity known, as far as it ever will be
  bool any_joined = false;         ///< else `floors` differs in nothing else
  std::vector<std::string> notes;  ///< one line for each level that was joined
};

/// Whether a level waits to be told apart.
bool HasUnknownFloors(const FloorTimeline& floors);

/// Offers the scan nodes of each level of unknown identity to those of older levels, other than the
/// one it was reached from, within `options.floor_joins.reach_m` of where motion puts them.
/// `map` was made with `floors`, and `options.motion.source` is settled.
FloorJoining JoinFloors(const MappingResult& map, const FloorTimeline& floors,
                        const Options& options);

}  // namespace masked_mapper
