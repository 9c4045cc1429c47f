// SPDX-License-Identifier: BSD-3-Clause
// Walls of one building have few directions, on all its storeys. Where a long way bends a floor by
// a tenth of a degree, or a ride turns one, its far end lies decimetres off, and so does every
// floor that is reached from there; walls of a part of a floor tell its heading to some hundredths.
// Ours; robust, since not all walls are parallel.
#pragma once

#include "masked_mapper/map/building_map.hpp"
#include "masked_mapper/optimization/pose_graph_optimizer.hpp"

namespace masked_mapper {

/// Of a map of several floors: ties parts of them by their headings where walls tell these better
/// than the way between the parts does, and agree with it. What stands at another angle than most
/// says nothing. The map is solved and its path bent anew if there are such parts. `map` is that of
/// one drive, finished. Same result at any number of threads.
void TieParallelWalls(const OptimizerOptions& solver, int threads, BuildingMap& map);

}  // namespace masked_mapper
