// SPDX-License-Identifier: BSD-3-Clause
// Maps of several logs. Every log is mapped by itself; what comes of it is then laid into the map
// so far where its places say (piece_search.hpp), and tied to it by validated closures alone. A
// drive without one stays a piece of its own, beside the others, with floors of its own.
#pragma once

#include <vector>

#include "masked_mapper/joining/joining_options.hpp"
#include "masked_mapper/loop_closure/loop_closure_options.hpp"
#include "masked_mapper/map/building_map.hpp"
#include "masked_mapper/map/progress_sink.hpp"

namespace masked_mapper {

/// Joins maps, the first of which gives the world frame, the names of floors and the first stamps;
/// each may itself hold several drives. One map alone is given back as it is. Where stamps would
/// step back, a later drive's are shifted by whole seconds, and a warning says so; another says
/// which drive stays apart, and why. Same result at any number of threads.
BuildingMap JoinDrives(std::vector<BuildingMap> maps, const DriveJoinOptions& options,
                       const LoopClosureOptions& closures, ProgressSink& progress);

}  // namespace masked_mapper
