// SPDX-License-Identifier: BSD-3-Clause
// What mapping one log takes, by composition of the rooms' own options.
#pragma once

#include "masked_mapper/joining/joining_options.hpp"
#include "masked_mapper/log/log_reader.hpp"
#include "masked_mapper/loop_closure/loop_closure_options.hpp"
#include "masked_mapper/masks/mask_options.hpp"
#include "masked_mapper/motion/motion_options.hpp"

namespace masked_mapper {

/// Where nodes are made (Section III-B) and which scans are kept for rendering.
struct NodeOptions {
  double min_edge_length_m = 1.5;  ///< between scan nodes, straight line; paper: 1.5
  double max_edge_length_m = 9.0;  ///< to the last node of any kind; paper: 9
  double cab_m = 3.0;  ///< travel in transit above which it is no cab but stairs or a ramp
  double kept_scan_distance_m = 0.15;  ///< travel from one rendered scan to the next
  double kept_scan_angle_deg = 10.0;   ///< or turn, whichever comes first
};

struct MappingOptions {
  LogOptions log;
  MotionOptions motion;
  FloorOptions floors;
  NodeOptions nodes;
  MaskOptions masks;
  LoopClosureOptions closures;
  FloorJoinOptions floor_joins;
  int threads = 1;  ///< above 1 what can overlap does; never changes the result
};

}  // namespace masked_mapper
