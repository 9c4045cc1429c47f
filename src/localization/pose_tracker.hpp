// SPDX-License-Identifier: BSD-3-Clause
// A robot whose place is known, held in it: a scan is matched against what the map saw around its
// nearest node, as a closure is, and weighed against where the motion put the robot.
#pragma once

#include <optional>

#include "known_map.hpp"
#include "masked_mapper/loop_closure/closure_matcher.hpp"
#include "masked_mapper/loop_closure/loop_closure_options.hpp"

namespace masked_mapper {

class PoseTracker {
 public:
  PoseTracker(const KnownMap& map, const LoopClosureOptions& options)
      : map_(map),
        options_(options),
        matcher_(options.matcher, options.submaps, options.ambiguity, options.refine, map.map()) {}

  /// The robot's pose, from where motion puts it. Nothing: the scan fits none of the map's nodes
  /// there, or only where motion does not put it and it fits the rest of the map worse.
  std::optional<UncertainPose2> Match(const LaserScan& scan, FloorId floor,
                                      const UncertainPose2& T_world_robot);

  /// Scans matched with one node each.
  int matches() const { return matches_; }

 private:
  std::optional<UncertainPose2> MatchWith(NodeId node, const ScanPoints::ConstPtr& points_in_robot,
                                          const UncertainPose2& T_world_robot);

  const KnownMap& map_;
  LoopClosureOptions options_;
  ClosureMatcher matcher_;
  int matches_ = 0;
};

}  // namespace masked_mapper
