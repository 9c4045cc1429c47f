// SPDX-License-Identifier: BSD-3-Clause
// Visits of one floor in one drive. A mask keeps few scans, and a scanner looks ahead: where the
// robot comes back to a floor by another way round, hardly two of them see the same. So what was
// not tied to an older visit is matched once more, against all that was seen around the older
// nodes. A visit that even this ties nowhere is looked for on the floor as the older ones saw it.
#pragma once

#include "masked_mapper/joining/floor_joining.hpp"
#include "masked_mapper/loop_closure/loop_closure_options.hpp"
#include "masked_mapper/map/building_map.hpp"

namespace masked_mapper {

/// Closures enter by the validator's votes, as all do. The map is solved and its path bent anew if
/// there are any. `map` is that of one drive, finished, with `drives` set.
void TieVisits(LoopClosureOptions options, const FloorJoinOptions& joins, BuildingMap& map);

}  // namespace masked_mapper
