// SPDX-License-Identifier: BSD-3-Clause
// Floors met again that nothing but the map can tell. A robot without pressure, labels or
// acceleration notices that it changed floors, not to which: every ride opens a new level. Where
// the scans of such a level fit an older one, node by node and all shifted alike, the two are one
// floor. Choices of ours; the paper's robot knows its floor.
#pragma once

#include <string>
#include <vector>

#include "masked_mapper/loop_closure/loop_closer.hpp"
#include "masked_mapper/map/building_map.hpp"
#include "masked_mapper/motion/floor_timeline.hpp"

namespace masked_mapper {

/// When two visits of floors that no sensor tells apart are one floor.
struct FloorJoinOptions {
  double reach_m = 4.0;    ///< from a node to its neighbours on the older floor
  double sigma_m = 1.0;    ///< of where motion through the rides puts them
  double sigma_deg = 4.0;  ///< and of the heading
  double agree_m = 0.3;    ///< between places that are shifted alike
  double agree_deg = 2.0;
  int min_places = 3;      ///< that agree
  double min_share = 0.6;  ///< of the places that have a neighbour
};

struct FloorJoining {
  FloorTimeline floors;            ///< every level's identity known, as far as it ever will be
  bool any_joined = false;         ///< else `floors` differs in nothing else
  std::vector<std::string> notes;  ///< one line for each level that was joined
};

/// Whether a level waits to be told apart.
bool HasUnknownFloors(const FloorTimeline& floors);

/// Offers the scan nodes of each level of unknown identity to those of older levels, other than the
/// one it was reached from, within `options.reach_m` of where motion puts them.
/// `map` was made with `floors`, by `closures`.
FloorJoining JoinFloors(const BuildingMap& map, const FloorTimeline& floors,
                        const FloorJoinOptions& options, const LoopClosureOptions& closures);

}  // namespace masked_mapper
