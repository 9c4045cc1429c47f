// SPDX-License-Identifier: BSD-3-Clause
// What was seen along the way before and after a node: more of a place than one scan, and from all
// sides, so that a drive the other way finds it too.
#pragma once

#include <vector>

#include "masked_mapper/map/building_map.hpp"

namespace masked_mapper {

/// By which poses the scans around a node are laid out.
enum class LaidOutBy {
  kMotion,       ///< the motion path: exact over a few metres, and never moves
  kOptimisation  ///< the optimised poses
};

struct SurroundingsOptions {
  double half_length_m = 3.0;  ///< travel before and after the node
  double spacing_m = 0.0;      ///< travel from one scan taken to the next; 0: every kept one
  LaidOutBy laid_out_by = LaidOutBy::kMotion;
};

struct ScanNearNode {
  const LaserScan* scan = nullptr;  ///< kept by the map
  Pose2 T_node_robot;
};

/// The scans kept around a node, as far as the way stays in its drive and on its floor: those after
/// it in order of driving, then those before it, the last first.
std::vector<ScanNearNode> ScansAround(const BuildingMap& map, NodeId node,
                                      const SurroundingsOptions& options);

/// Their points within `max_range_m` of each scan's robot, in the node's frame.
ScanPoints::Ptr PointsAround(const BuildingMap& map, NodeId node,
                             const SurroundingsOptions& options, double max_range_m);

/// What was seen at a node, in its frame: its own scan, or, of an odometry-only node, the scan kept
/// nearest to it, within `most_m` along the motion path, on its floor and of its drive. Null where
/// none was kept.
ScanPoints::ConstPtr PointsAt(const BuildingMap& map, NodeId node, double most_m);

}  // namespace masked_mapper
