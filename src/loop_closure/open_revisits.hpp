// SPDX-License-Identifier: BSD-3-Clause
// Places of the optimised map where the robot passed twice and the graph does not know it: nodes
// near each other that no short walk along edges joins. Ours; the paper looks for closures only
// while it drives, and between scan nodes only, so that a corridor between two masked places stays
// open.
#pragma once

#include <vector>

#include "masked_mapper/loop_closure/loop_closure_options.hpp"
#include "masked_mapper/pose_graph/pose_graph.hpp"

namespace masked_mapper {

class OpenRevisits {
 public:
  /// `graph` outlives this. Poses stand still while this is used; edges may be added.
  OpenRevisits(const PoseGraph& graph, const OpenRevisitOptions& options);

  /// Earlier nodes on the floor of `node`, nearest first (ties: the older node). None of them, nor
  /// `node`, stands beside a change of floor.
  std::vector<NodeId> Of(NodeId node) const;

 private:
  const Pose2& PoseOf(NodeId node) const;
  bool IsBesideFloorChange(NodeId node) const;
  std::vector<NodeId> WithinWalk(NodeId from) const;  // itself too; sorted

  const PoseGraph& graph_;
  OpenRevisitOptions options_;
  std::vector<NodeId> by_x_;  ///< in order of x in the map, then of ids
};

}  // namespace masked_mapper
