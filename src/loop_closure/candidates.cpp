// SPDX-License-Identifier: BSD-3-Clause
#include "masked_mapper/loop_closure/loop_closer.hpp"

#include <algorithm>
#include <tuple>

#include "masked_mapper/geometry/uncertain_pose2.hpp"

namespace masked_mapper {

std::vector<Candidate> FindCandidates(const PoseGraph& graph, NodeId new_node,
                                      const std::vector<ProjectedNode>& projection,
                                      const CandidateOptions& options) {
  const Node& from = graph.nodes()[static_cast<std::size_t>(new_node)];
  std::vector<Candidate> candidates;
  for (const ProjectedNode& projected : projection) {
    const Node& to = graph.nodes()[static_cast<std::size_t>(projected.node)];
    if (projected.node == new_node || !to.HasScan() || to.floor != from.floor) continue;
    Candidate candidate;
    candidate.node = projected.node;
    // Eq. 7 takes the displacement from the map as it is now known, and only the uncertainty from
    // the projection.
    candidate.T_new_node = {Between(from.T_world_robot, to.T_world_robot),
                            projected.T_source_node.covariance};
    candidate.mahalanobis = MahalanobisDistance(
        candidate.T_new_node.mean.Translation(),
        candidate.T_new_node.covariance.topLeftCorner<2, 2>(), options.match_range_m);
    if (candidate.mahalanobis < options.max_mahalanobis) candidates.push_back(candidate);
  }
  std::sort(candidates.begin(), candidates.end(), [](const Candidate& a, const Candidate& b) {
    return std::tie(a.mahalanobis, a.node) < std::tie(b.mahalanobis, b.node);
  });
  const auto most = static_cast<std::size_t>(std::max(0, options.max_matches));
  if (candidates.size() > most) candidates.resize(most);
  return candidates;
}

}  // namespace masked_mapper
