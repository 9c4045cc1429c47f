// SPDX-License-Identifier: BSD-3-Clause
// Every option of a mapping run, by composition of the rooms' own structs.
#pragma once

#include "masked_mapper/log/log_reader.hpp"
#include "masked_mapper/loop_closure/candidates.hpp"
#include "masked_mapper/loop_closure/open_revisits.hpp"
#include "masked_mapper/loop_closure/validator.hpp"
#include "masked_mapper/mapping/submap_options.hpp"
#include "masked_mapper/masks/mask_registry.hpp"
#include "masked_mapper/motion/floor_tracker.hpp"
#include "masked_mapper/motion/motion_estimator.hpp"
#include "masked_mapper/optimization/closure_audit.hpp"
#include "masked_mapper/optimization/pose_graph_optimizer.hpp"
#include "masked_mapper/rendering/occupancy_grid.hpp"
#include "masked_mapper/rendering/octree.hpp"
#include "masked_mapper/scan_matching/floor_search.hpp"
#include "masked_mapper/scan_matching/joint_matcher.hpp"

namespace masked_mapper {

/// Where nodes are made (Section III-B) and which scans are kept for rendering.
struct NodeOptions {
  double min_edge_length_m = 1.5;  ///< between scan nodes, straight line; paper: 1.5
  double max_edge_length_m = 9.0;  ///< to the last node of any kind; paper: 9
  double cab_m = 3.0;          ///< travel in transit above which it is no cab but stairs or a ramp
  double ride_sigma_m = 0.03;  ///< at most, of a ride in a cab whose walls were seen
  double ride_sigma_deg = 0.15;        ///< the same of its heading
  double kept_scan_distance_m = 0.15;  ///< travel from one rendered scan to the next
  double kept_scan_angle_deg = 10.0;   ///< or turn, whichever comes first
};

/// When a match is not sure enough to be a closure. A blank corridor matches itself anywhere along
/// it, and loops of such matches agree with each other. Ours: the paper leaves it to MinScore.
struct AmbiguityOptions {
  double max_sigma_m = 0.2;  ///< in the least certain direction
  double max_sigma_deg = 3.0;
};

/// Which pairs enter once the whole map is known, matched again from their optimised poses.
struct PolishOptions {
  double most_m = 0.2;  ///< that the match may be away from the map, before and after
  double most_deg = 2.0;
  OpenRevisitOptions revisits;  ///< which pairs are offered late, as no mask offered them
};

/// When two visits of floors that no sensor tells apart are one floor (mapping/floor_joining.hpp).
struct FloorJoinOptions {
  double reach_m = 4.0;    ///< from a node to its neighbours on the older floor
  double sigma_m = 1.0;    ///< of where motion through the rides puts them
  double sigma_deg = 4.0;  ///< and of the heading
  double agree_m = 0.3;    ///< between places that are shifted alike
  double agree_deg = 2.0;
  int min_places = 3;      ///< that agree
  double min_share = 0.6;  ///< of the places that have a neighbour
};

/// When drives of several logs are of one building (mapping/piece_search.hpp, drive_joining.hpp).
struct DriveJoinOptions {
  FloorSearchOptions search;
  double stretch_m = 12.0;       ///< travel before and after a node that makes it a place
  double place_spacing_m = 3.0;  ///< between places
  int searched_places = 24;      ///< looked for everywhere; the others only where those say
  double min_score = 0.7;        ///< 0-1, of a place that fits
  double agree_m = 1.0;          ///< between a place and where all of them together put it
  int min_places = 4;            ///< that fit and agree
  double min_share = 0.4;        ///< of the places that lie within the older map
  double min_spread_m = 8.0;     ///< between the two places farthest apart
  double clear_lead = 0.05;      ///< of score, by which a place speaks against another way to join
  int places_needed = 2;   ///< stands for the validator's: where the drive lies is known already
  double reach_m = 4.0;    ///< from a node to those that it is offered to
  double sigma_m = 0.5;    ///< of where the places put it
  double sigma_deg = 2.0;  ///< and of the heading
};

struct Options {
  LogOptions log;
  MotionOptions motion;
  FloorOptions floors;
  NodeOptions nodes;
  MaskOptions masks;
  CandidateOptions candidates;
  MatcherOptions matcher;
  SubmapOptions submaps;
  AmbiguityOptions ambiguity;
  FloorJoinOptions floor_joins;
  DriveJoinOptions drive_joins;
  PolishOptions polish;
  ValidatorOptions validator;
  UpdateOptions optimizer;
  AuditOptions audit;
  GridOptions grid;
  OctreeOptions octree;
  int threads = 0;  ///< 0: as many as the machine has
};

}  // namespace masked_mapper
