// SPDX-License-Identifier: BSD-3-Clause
// Dijkstra projection (Section III-C, Eq. 2-6): where every other node lies as seen from one node,
// by the path whose covariance has the smallest trace. The trace mixes m^2 and rad^2 and is not
// additive over a composed path, so this is the paper's approximation: a node is settled with the
// first (least-trace) composition that reaches it.
#pragma once

#include <limits>
#include <vector>

#include "masked_mapper/geometry/uncertain_pose2.hpp"
#include "masked_mapper/pose_graph/pose_graph.hpp"

namespace masked_mapper {

struct ProjectedNode {
  NodeId node = 0;
  UncertainPose2 T_source_node;  ///< along the path, not from the optimised poses
  double cost = 0.0;             ///< trace of the covariance, Eq. 2
};

struct ProjectionLimits {
  double max_cost =
      std::numeric_limits<double>::infinity();  ///< trace beyond which nothing follows
};

/// Nodes reachable from `source` (itself first, with zero covariance), in order of settling: cost,
/// then id. Crosses floors.
std::vector<ProjectedNode> DijkstraProjection(const PoseGraph& graph, NodeId source,
                                              const ProjectionLimits& limits = {});

}  // namespace masked_mapper
