// SPDX-License-Identifier: BSD-3-Clause
// Floors met again that nothing but the map can tell. A robot without pressure, labels or
// acceleration notices that it changed floors, not to which: every ride opens a new level. Where
// what was seen on such a level fits an older one place by place, all shifted alike, the two are
// one floor, unless it fits another as well. Choices of ours; the paper's robot knows its floor.
#pragma once

#include <string>
#include <vector>

#include "masked_mapper/joining/piece_search.hpp"
#include "masked_mapper/map/building_map.hpp"
#include "masked_mapper/motion/floor_timeline.hpp"
#include "masked_mapper/motion/floor_transit.hpp"
#include "masked_mapper/scan_matching/matcher_options.hpp"

namespace masked_mapper {

/// When two visits of floors that no sensor tells apart are one floor.
struct FloorJoinOptions {
  DriveJoinOptions places = PlacesOfOneDrive();
  PiecePrior ride;  ///< how far a ride may throw the robot's pose off

  /// Of places where motion has put the level already, fewer and nearer ones suffice, but most of
  /// them have to fit: a floor is seen whole, where drives share a part of their ways.
  static DriveJoinOptions PlacesOfOneDrive();
};

struct FloorJoining {
  FloorTimeline floors;  ///< as far as it ever will be known; levels left open say why
  bool any_joined = false;
  std::vector<std::string> notes;  ///< one line for each level that was joined
};

/// Whether a level waits to be told apart.
bool HasUnknownFloors(const FloorTimeline& floors);

/// Looks for each level of unknown identity on the older ones, near where motion puts it. It is
/// none that it was reached from, or that a measured climb tells from it; where it fits such a one,
/// too, the storeys are of one plan, and fits say nothing. Levels that climbs tie to it are known
/// with it, by their heights. `map` was made with `floors`.
FloorJoining JoinFloors(const BuildingMap& map, const FloorTimeline& floors,
                        const FloorJoinOptions& options, const StoreyOptions& storeys,
                        const MatcherOptions& matcher);

}  // namespace masked_mapper
