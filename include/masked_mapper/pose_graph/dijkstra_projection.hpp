// SPDX-License-Identifier: BSD-3-Clause
// Dijkstra projection (Section III-C, Eq. 2-6): where every other node lies as seen from one node,
// by the path whose covariance has the smallest trace. The trace mixes m^2 and rad^2 and is not
// additive over a composed path, so this is the paper's approximation: a node is settled with the
// first (least-trace) composition that reaches it.
#pragma once

#include <cstdint>
#include <functional>
#include <limits>
#include <queue>
#include <utility>
#include <vector>

#include "masked_mapper/geometry/uncertain_pose2.hpp"
#include "masked_mapper/pose_graph/pose_graph.hpp"

namespace masked_mapper {

struct ProjectedNode {
  NodeId node = 0;
  UncertainPose2 T_source_node;  ///< along the path, not from the optimised poses
  double cost = 0.0;             ///< trace of the covariance, Eq. 2
};

constexpr double kHoweverUnsure = std::numeric_limits<double>::infinity();

/// The projection from one node, which goes on only as far as is asked. The graph must outlive it
/// and keep its nodes, and its edges while anything is asked.
class ProjectionSearch {
 public:
  ProjectionSearch(const PoseGraph& graph, NodeId source);

  /// Null: beyond reach, or at more than `max_cost` (a trace, Eq. 2). Valid until the next call.
  const ProjectedNode* Find(NodeId node, double max_cost = kHoweverUnsure);
  /// Every node within reach, in order of settling: cost, then id.
  std::vector<ProjectedNode> All() &&;
  /// Those that have been settled so far.
  const std::vector<ProjectedNode>& settled() const { return settled_; }

 private:
  struct Reached {
    double cost = std::numeric_limits<double>::infinity();
    EdgeId by = -1;           // the edge by which `cost` is reached
    std::size_t parent = 0;   // its other end, a place among the settled ones
    std::int32_t place = -1;  // among the settled ones; -1: not settled
  };
  using Entry = std::pair<double, NodeId>;

  Reached& At(NodeId node);
  void SettleNext();

  const PoseGraph& graph_;
  std::vector<std::int32_t> reached_at_;  // by node: a place in `reached_`; -1: none
  std::vector<Reached> reached_;
  std::vector<ProjectedNode> settled_;
  std::priority_queue<Entry, std::vector<Entry>, std::greater<>> queue_;
};

/// Nodes reachable from `source` (itself first, with zero covariance), in order of settling.
/// Crosses floors.
std::vector<ProjectedNode> DijkstraProjection(const PoseGraph& graph, NodeId source);

}  // namespace masked_mapper
