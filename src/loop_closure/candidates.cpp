// SPDX-License-Identifier: BSD-3-Clause
#include "masked_mapper/loop_closure/loop_closer.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <tuple>
#include <utility>
#include <vector>

#include "masked_mapper/geometry/uncertain_pose2.hpp"

namespace masked_mapper {
namespace {

/// A path that is surest at every step is not always surest at its end: what is taken for the most
/// that a projection costs is so many times the cost that the last one would come to.
constexpr double kSlack = 2.0;

std::optional<Candidate> CandidateAt(const PoseGraph& graph, NodeId new_node,
                                     const ProjectedNode& projected,
                                     const CandidateOptions& options) {
  const Node& from = graph.node(new_node);
  const Node& to = graph.node(projected.node);
  if (projected.node == new_node || !to.HasScan() || to.floor != from.floor) return std::nullopt;
  Candidate candidate;
  candidate.node = projected.node;
  // Eq. 7 takes the displacement from the map as it is now known, and only the uncertainty from
  // the projection.
  candidate.T_new_node = {Between(from.T_world_robot, to.T_world_robot),
                          projected.T_source_node.covariance};
  candidate.mahalanobis = MahalanobisDistance(candidate.T_new_node.mean.Translation(),
                                              candidate.T_new_node.covariance.topLeftCorner<2, 2>(),
                                              options.match_range_m);
  if (!(candidate.mahalanobis < options.max_mahalanobis)) return std::nullopt;
  return candidate;
}

/// Nearest first, no more than may be.
void KeepNearest(const CandidateOptions& options, std::vector<Candidate>* candidates) {
  std::sort(candidates->begin(), candidates->end(), [](const Candidate& a, const Candidate& b) {
    return std::tie(a.mahalanobis, a.node) < std::tie(b.mahalanobis, b.node);
  });
  const auto most = static_cast<std::size_t>(std::max(0, options.max_matches));
  if (candidates->size() > most) candidates->resize(most);
}

}  // namespace

std::vector<Candidate> FindCandidates(const PoseGraph& graph, NodeId new_node,
                                      const std::vector<ProjectedNode>& projection,
                                      const CandidateOptions& options) {
  std::vector<Candidate> candidates;
  for (const ProjectedNode& projected : projection) {
    const std::optional<Candidate> candidate = CandidateAt(graph, new_node, projected, options);
    if (candidate) candidates.push_back(*candidate);
  }
  KeepNearest(options, &candidates);
  return candidates;
}

// The way from here to the last new node, put before its ways to all others, costs each what is
// known of it and what the heading of that step does over the distance (Eq. 5). Nodes that are new
// since may cost anything.
void CandidateSearch::GoTo(NodeId new_node, const PoseGraph& graph, ProjectionSearch& search) {
  constexpr double kAnything = std::numeric_limits<double>::infinity();
  const ProjectedNode* step = last_ < 0 ? nullptr : search.Find(last_);
  if (step == nullptr) {
    most_cost_.assign(graph.nodes().size(), kAnything);
  } else {
    const Eigen::Matrix3d& covariance = step->T_source_node.covariance;
    const double beside = covariance.topRightCorner<2, 1>().norm();
    const Pose2 T_world_last = graph.node(last_).T_world_robot;
    for (std::size_t i = 0; i < most_cost_.size(); ++i) {
      const double lever = Distance(T_world_last, graph.nodes()[i].T_world_robot);
      most_cost_[i] += step->cost + lever * (lever * covariance(2, 2) + 2.0 * beside);
    }
    most_cost_.resize(graph.nodes().size(), kAnything);
  }
  last_ = new_node;
}

std::vector<Candidate> CandidateSearch::Of(const PoseGraph& graph, NodeId new_node,
                                           const CandidateOptions& options) {
  ProjectionSearch search(graph, new_node);
  GoTo(new_node, graph, search);
  const Node& from = graph.node(new_node);
  const double range2 = options.match_range_m * options.match_range_m;
  std::vector<std::pair<double, NodeId>> open;  // the least that Eq. 7 can come to, and of which
  for (std::size_t i = 0; i < graph.nodes().size(); ++i) {
    const Node& to = graph.nodes()[i];
    if (!to.HasScan() || to.floor != from.floor) continue;
    const double least =
        Distance(from.T_world_robot, to.T_world_robot) / std::sqrt(kSlack * most_cost_[i] + range2);
    if (least < options.max_mahalanobis) open.emplace_back(least, static_cast<NodeId>(i));
  }
  std::sort(open.begin(), open.end());
  std::vector<Candidate> candidates;
  for (const auto& [least, node] : open) {
    const bool is_full =
        !candidates.empty() && static_cast<int>(candidates.size()) >= options.max_matches;
    if (is_full && least > candidates.back().mahalanobis) break;
    const ProjectedNode* projected = search.Find(node);
    if (projected == nullptr) continue;
    const std::optional<Candidate> candidate = CandidateAt(graph, new_node, *projected, options);
    if (!candidate) continue;
    candidates.push_back(*candidate);
    KeepNearest(options, &candidates);
  }
  for (const ProjectedNode& settled : search.settled()) {
    most_cost_[static_cast<std::size_t>(settled.node)] = settled.cost;
  }
  return candidates;
}

}  // namespace masked_mapper
