// SPDX-License-Identifier: BSD-3-Clause
// What the robot saw around a node, as a local map in the node's frame: the scans kept shortly
// before and after it, placed by the motion path. A closure is refined against it below the size of
// any cell, where a single sparse scan would leave centimetres. Ours; the paper matches single
// scans.
#pragma once

#include <cstddef>
#include <list>
#include <map>
#include <optional>
#include <vector>

#include "masked_mapper/loop_closure/loop_closure_options.hpp"
#include "masked_mapper/map/building_map.hpp"
#include "masked_mapper/map/surroundings.hpp"
#include "masked_mapper/scan_matching/local_map.hpp"

namespace masked_mapper {

/// A match refined; `inlier_share` of the scan's points agree with the submap.
struct SubmapMatch {
  UncertainPose2 T_node_robot;
  double inlier_share = 0.0;
};

class Submaps {
 public:
  /// `building` is the map in the making; it outlives this.
  Submaps(const SubmapOptions& options, const BuildingMap& building)
      : options_(options), building_(building) {}

  /// The pose of a scan in the frame of `node`, from a coarse match. Empty when the scan does not
  /// fit the node's surroundings.
  std::optional<SubmapMatch> Refine(NodeId node, const ScanPoints& points_in_robot,
                                    const UncertainPose2& T_node_robot);

  /// Builds the submap of a node, unless it is at hand: not beside Refine().
  void Prepare(NodeId node) { SubmapOf(node); }

  /// Gives back the memory of submaps; they are built again where they are asked for.
  void Forget();

  /// What was seen at `node`, in its frame: its own scan, or, of an odometry-only node, the scan
  /// kept nearest to it. Null when none was kept there.
  ScanPoints::ConstPtr PointsAt(NodeId node) const;

  /// The points of the node's submap, in its frame: what was seen from the way to it and on, so
  /// that a scan that looks the other way finds it, too. Never null; empty when none was kept.
  ScanPoints::ConstPtr PointsAround(NodeId node) const;

 private:
  const LocalMap& SubmapOf(NodeId node);
  SurroundingsOptions Surroundings() const { return {options_.half_length_m}; }
  LocalMap Build(NodeId node) const;
  bool IsComplete(NodeId node) const;

  SubmapOptions options_;
  const BuildingMap& building_;
  std::list<NodeId> recently_used_;  ///< most recent first
  struct Entry {
    LocalMap map;
    std::list<NodeId>::iterator place;
    bool is_complete = false;  ///< the drive had gone on far enough when it was built
  };
  std::map<NodeId, Entry> submaps_;
};

}  // namespace masked_mapper
