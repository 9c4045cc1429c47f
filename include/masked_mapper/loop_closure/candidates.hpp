// SPDX-License-Identifier: BSD-3-Clause
// Which earlier nodes are worth matching with a new one (Algorithm 1; Section III-C, Eq. 7).
#pragma once

#include <vector>

#include "masked_mapper/pose_graph/dijkstra_projection.hpp"
#include "masked_mapper/pose_graph/pose_graph.hpp"

namespace masked_mapper {

struct CandidateOptions {
  double max_mahalanobis = 5.0;  ///< MaxMaha of the paper
  int max_matches = 5;           ///< MaxMatches of the paper
  double match_range_m = 2.0;    ///< R of Eq. 7
};

struct Candidate {
  NodeId node = 0;
  double mahalanobis = 0.0;
  UncertainPose2 T_new_node;  ///< mean from the optimised map, covariance from the projection
};

/// Nodes with a scan on the floor of `new_node`, below MaxMaha, at most MaxMatches, nearest first
/// (ties: the older node).
std::vector<Candidate> FindCandidates(const PoseGraph& graph, NodeId new_node,
                                      const std::vector<ProjectedNode>& projection,
                                      const CandidateOptions& options);

}  // namespace masked_mapper
