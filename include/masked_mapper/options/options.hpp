// SPDX-License-Identifier: BSD-3-Clause
// Every option of a run, by composition of the rooms' own structs.
#pragma once

#include "masked_mapper/joining/joining_options.hpp"
#include "masked_mapper/mapping/mapping_options.hpp"
#include "masked_mapper/rendering/occupancy_grid.hpp"
#include "masked_mapper/rendering/octree.hpp"

namespace masked_mapper {

struct Options {
  MappingOptions mapping;
  DriveJoinOptions drive_joins;
  GridOptions grid;
  OctreeOptions octree;
  int threads = 0;  ///< 0: as many as the machine has
};

/// Settles `threads`, here and in each room that works on several.
void SettleThreads(Options& options);

}  // namespace masked_mapper
