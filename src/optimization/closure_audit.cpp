// SPDX-License-Identifier: BSD-3-Clause
#include "masked_mapper/optimization/pose_graph_optimizer.hpp"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <numeric>

#include "masked_mapper/geometry/pose2.hpp"

namespace masked_mapper {
namespace {

// The edges of a graph with weights, and the graph solved under them. Closures are taken with the
// tolerance added, so that strain shows in them and not in the odometry about them.
class WeightedEdges {
 public:
  WeightedEdges(const AuditOptions& options, const OptimizerOptions& solver,
                const std::vector<EdgeId>& trusted, PoseGraph& graph)
      : solver_(solver),
        graph_(graph),
        weights_(graph.edges().size(), 1.0),
        is_trusted_(graph.edges().size(), false) {
    for (const EdgeId edge : trusted) is_trusted_[static_cast<std::size_t>(edge)] = true;
    const double radians = DegToRad(options.tolerance_deg);
    const Eigen::Vector3d tolerance(options.tolerance_m, options.tolerance_m, radians);
    for (const Edge& edge : graph.edges()) {
      edges_.push_back(edge);
      if (edge.kind != EdgeKind::kClosure) continue;
      edges_.back().T_from_to.covariance.diagonal() += tolerance.cwiseAbs2();
    }
  }

  std::size_t size() const { return edges_.size(); }
  const Edge& edge(std::size_t i) const { return edges_[i]; }
  /// A closure that may go.
  bool IsQuestioned(std::size_t i) const {
    return edges_[i].kind == EdgeKind::kClosure && !is_trusted_[i];
  }
  bool IsTrusted(std::size_t i) const {
    return edges_[i].kind == EdgeKind::kFloorChange || is_trusted_[i];
  }
  double weight(std::size_t i) const { return weights_[i]; }
  void SetWeight(std::size_t i, double weight) { weights_[i] = weight; }
  double Chi2(std::size_t i) const { return EdgeChi2(graph_, edges_[i]); }

  /// Moves the poses of the graph to the weighted solution. A closure without weight is left out;
  /// other edges keep a little, so that nothing comes apart.
  void Solve() {
    constexpr double kLeastWeight = 1e-3;
    PoseGraph weighted;
    for (const Floor& floor : graph_.floors()) weighted.AddFloor(floor);
    for (const Node& node : graph_.nodes()) weighted.AddNode(node);
    for (std::size_t i = 0; i < edges_.size(); ++i) {
      if (edges_[i].kind == EdgeKind::kClosure && weights_[i] < kLeastWeight) continue;
      Edge edge = edges_[i];
      edge.T_from_to.covariance /= std::max(kLeastWeight, weights_[i]);
      weighted.AddEdge(edge);
    }
    Optimize(solver_, weighted);
    for (std::size_t i = 0; i < weighted.nodes().size(); ++i) {
      graph_.SetPose(static_cast<NodeId>(i), weighted.nodes()[i].T_world_robot);
    }
  }

 private:
  const OptimizerOptions& solver_;
  PoseGraph& graph_;
  std::vector<Edge> edges_;
  std::vector<double> weights_;
  std::vector<bool> is_trusted_;
};

// Whether two closures say the same, going by the graph from the ends of one to those of the other.
bool SayTheSame(const PoseGraph& graph, const Edge& one, const Edge& other) {
  constexpr double kSameMetres = 0.5;
  constexpr double kSameDeg = 5.0;
  const auto pose = [&](NodeId node) -> const Pose2& {
    return graph.nodes()[static_cast<std::size_t>(node)].T_world_robot;
  };
  const Pose2 T_by_other = Between(pose(one.from), pose(other.from)) * other.T_from_to.mean *
                           Between(pose(other.to), pose(one.to));
  return Distance(T_by_other, one.T_from_to.mean) < kSameMetres &&
         std::abs(WrapAngle(T_by_other.theta - one.T_from_to.mean.theta)) < DegToRad(kSameDeg);
}

// The way driven to each node, counted on from drive to drive.
std::vector<double> Travelled(const PoseGraph& graph) {
  std::vector<double> travelled(graph.nodes().size(), 0.0);
  for (const Edge& edge : graph.edges()) {
    if (edge.kind == EdgeKind::kClosure) continue;
    travelled[static_cast<std::size_t>(std::max(edge.from, edge.to))] +=
        edge.T_from_to.mean.Translation().norm();
  }
  std::partial_sum(travelled.begin(), travelled.end(), travelled.begin());
  return travelled;
}

// Closures between the same stretches of the drive that say the same stand and fall together
// (ours): the votes let wrong ones in by groups, and where such a group outnumbers the right
// closures about it, those would be given up one by one. Returns for every edge the first of its
// group; an edge that is no closure is a group of its own.
std::vector<std::size_t> Groups(const PoseGraph& graph, const WeightedEdges& edges) {
  constexpr double kSameStretch = 15.0;  // m along the drive, however dense its nodes
  const std::vector<double> travelled = Travelled(graph);
  const auto at = [&](NodeId node) { return travelled[static_cast<std::size_t>(node)]; };
  std::vector<std::size_t> group(edges.size());
  std::iota(group.begin(), group.end(), std::size_t{0});
  const auto root = [&](std::size_t i) {
    while (group[i] != i) i = group[i] = group[group[i]];
    return i;
  };
  std::vector<std::size_t> closures;
  for (std::size_t i = 0; i < edges.size(); ++i) {
    if (edges.edge(i).kind == EdgeKind::kClosure) closures.push_back(i);
  }
  std::stable_sort(closures.begin(), closures.end(), [&](std::size_t i, std::size_t j) {
    return edges.edge(i).to < edges.edge(j).to;
  });
  for (std::size_t i = 0; i < closures.size(); ++i) {
    for (std::size_t j = i; j-- > 0;) {
      const Edge& one = edges.edge(closures[i]);
      const Edge& other = edges.edge(closures[j]);
      if (at(one.to) - at(other.to) > kSameStretch) break;
      if (std::abs(at(one.from) - at(other.from)) > kSameStretch) continue;
      if (!SayTheSame(graph, one, other)) continue;
      const std::size_t root_one = root(closures[i]);
      const std::size_t root_other = root(closures[j]);
      group[std::max(root_one, root_other)] = std::min(root_one, root_other);
    }
  }
  for (std::size_t i = 0; i < group.size(); ++i) group[i] = root(i);
  return group;
}

// How far every group of edges is beyond what is allowed: the mean of chi^2 over its limit.
// Odometry may fail too, by a slip that closures agree upon; it is trusted five sigmas far (ours).
// A change of floor is not questioned, nor what the caller trusts.
std::vector<double> Excess(const WeightedEdges& edges, const std::vector<std::size_t>& group,
                           double max_closure_chi2) {
  constexpr double kMaxOdometryChi2 = 25.0;
  std::vector<double> excess(edges.size(), 0.0);
  std::vector<double> count(edges.size(), 0.0);
  for (std::size_t i = 0; i < edges.size(); ++i) {
    if (edges.IsTrusted(i)) continue;
    const double limit = edges.IsQuestioned(i) ? max_closure_chi2 : kMaxOdometryChi2;
    excess[group[i]] += edges.Chi2(i) / limit;
    count[group[i]] += 1.0;
  }
  for (std::size_t i = 0; i < excess.size(); ++i) excess[i] /= std::max(1.0, count[i]);
  return excess;
}

// Weight under the truncated square with its limit at 1, made convex by mu (Yang et al. 2020, Eq.
// 14).
double TruncatedWeight(double excess, double mu) {
  if (excess <= mu / (mu + 1.0)) return 1.0;
  if (excess >= (mu + 1.0) / mu) return 0.0;
  return std::sqrt(mu * (mu + 1.0) / excess) - mu;
}

// Lowers the convexity until every group is in or out.
void Graduate(const std::vector<std::size_t>& group, double max_closure_chi2,
              WeightedEdges& edges) {
  constexpr double kStep = 1.4;  // as Yang et al.
  constexpr int kMostSteps = 60;
  std::vector<double> excess = Excess(edges, group, max_closure_chi2);
  const double worst = *std::max_element(excess.begin(), excess.end());
  if (worst <= 1.0) return;
  double mu = 1.0 / (2.0 * worst - 1.0);
  for (int step = 0; step < kMostSteps; ++step, mu *= kStep) {
    bool decided = true;
    for (std::size_t i = 0; i < edges.size(); ++i) {
      const double weight = edges.IsTrusted(i) ? 1.0 : TruncatedWeight(excess[group[i]], mu);
      decided = decided && (weight == 0.0 || weight == 1.0);
      edges.SetWeight(i, weight);
    }
    edges.Solve();
    if (decided) return;
    excess = Excess(edges, group, max_closure_chi2);
  }
  for (std::size_t i = 0; i < edges.size(); ++i) {
    edges.SetWeight(i, edges.weight(i) < 0.5 ? 0.0 : 1.0);
  }
}

// One by one now: what went with wrong ones but fits without them comes back, what still disagrees
// goes.
void Settle(double max_closure_chi2, WeightedEdges& edges) {
  constexpr int kMostRounds = 10;
  for (int round = 0; round < kMostRounds; ++round) {
    edges.Solve();
    bool changed = false;
    for (std::size_t i = 0; i < edges.size(); ++i) {
      if (!edges.IsQuestioned(i)) continue;
      const double weight = edges.Chi2(i) > max_closure_chi2 ? 0.0 : 1.0;
      // From the middle on nothing comes back, so that no closure goes in and out for ever.
      if (weight == edges.weight(i) || (weight == 1.0 && 2 * round >= kMostRounds)) continue;
      edges.SetWeight(i, weight);
      changed = true;
    }
    if (!changed) return;
  }
}

}  // namespace

std::vector<EdgeId> AuditClosures(const AuditOptions& options, const OptimizerOptions& solver,
                                  PoseGraph& graph, const std::vector<EdgeId>& trusted) {
  Optimize(solver, graph);
  const PoseGraph solved = graph;
  WeightedEdges edges(options, solver, trusted, graph);
  edges.Solve();
  bool all_agree = true;
  for (std::size_t i = 0; i < edges.size(); ++i) {
    if (!edges.IsQuestioned(i)) continue;
    all_agree = all_agree && edges.Chi2(i) <= options.max_chi2;
  }
  std::vector<EdgeId> wrong;
  if (!all_agree) {
    Graduate(Groups(graph, edges), options.max_chi2, edges);
    Settle(options.max_chi2, edges);
    for (std::size_t i = 0; i < edges.size(); ++i) {
      if (!edges.IsQuestioned(i) || edges.weight(i) > 0.0) continue;
      wrong.push_back(static_cast<EdgeId>(i));
    }
  }
  // The tolerance was for the question; the poses are those of the measurements as they are.
  PoseGraph kept = solved;
  for (auto id = wrong.rbegin(); id != wrong.rend(); ++id) kept.RemoveEdge(*id);
  if (!wrong.empty()) {
    for (std::size_t i = 0; i < graph.nodes().size(); ++i) {
      kept.SetPose(static_cast<NodeId>(i), graph.nodes()[i].T_world_robot);
    }
    Optimize(solver, kept);
  }
  for (std::size_t i = 0; i < kept.nodes().size(); ++i) {
    graph.SetPose(static_cast<NodeId>(i), kept.nodes()[i].T_world_robot);
  }
  return wrong;
}

}  // namespace masked_mapper
