// SPDX-License-Identifier: BSD-3-Clause
// Floors met again that nothing but the map can tell. A robot without pressure, labels or
// acceleration notices that it changed floors, not to which: every ride opens a new level. Where
// what was seen on such a level fits an older one place by place, all shifted alike, the two are
// one floor, unless it fits another as well. Choices of ours; the paper's robot knows its floor.
#pragma once

#include <string>
#include <vector>

#include "masked_mapper/joining/joining_options.hpp"
#include "masked_mapper/loop_closure/loop_closure_options.hpp"
#include "masked_mapper/map/building_map.hpp"
#include "masked_mapper/motion/floor_timeline.hpp"
#include "masked_mapper/optimization/pose_graph_optimizer.hpp"
#include "masked_mapper/scan_matching/matcher_options.hpp"

namespace masked_mapper {

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

/// Visits of one floor in one drive. A mask keeps few scans, and a scanner looks ahead: where the
/// robot comes back to a floor by another way round, hardly two of them see the same. So what was
/// not tied to an older visit is matched once more, against all that was seen around the older
/// nodes. A visit that even this ties nowhere is looked for on the floor as the older ones saw it.
/// Closures enter as all do, by the validator. The map is solved and its path bent anew if
/// there are any. `map` is that of one drive, finished, with `drives` set.
void TieVisits(const LoopClosureOptions& options, const FloorJoinOptions& joins, BuildingMap& map);

/// Walls of one building have few directions, on all its storeys. Where a long way bends a floor by
/// a tenth of a degree, or a ride turns one, its far end lies decimetres off, and so does every
/// floor that is reached from there. Of a map of several floors, ties parts of them by their
/// headings where walls tell these better than the way between the parts does, and agree with it.
/// What stands at another angle than most says nothing. Ours; robust, since not all walls are
/// parallel. The map is solved and its path bent anew if there are such parts. `map` is that of one
/// drive, finished. Same result at any number of threads.
void TieParallelWalls(const OptimizerOptions& solver, int threads, BuildingMap& map);

}  // namespace masked_mapper
