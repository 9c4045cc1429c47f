// SPDX-License-Identifier: BSD-3-Clause
// Dijkstra over covariances (Section III-C). Relaxing an edge needs only the trace of the composed
// covariance, which has a closed form; the composition itself (Eq. 3-6) is done once per settled
// node.
#include "masked_mapper/pose_graph/dijkstra_projection.hpp"

#include "masked_mapper/geometry/uncertain_pose2.hpp"
#include "masked_mapper/text/check.hpp"

namespace masked_mapper {

ProjectionSearch::ProjectionSearch(const PoseGraph& graph, NodeId source)
    : graph_(graph), reached_at_(graph.nodes().size(), -1) {
  Check(source >= 0 && static_cast<std::size_t>(source) < graph.nodes().size(),
        "the source is a node of the graph");
  At(source).cost = 0.0;
  queue_.emplace(0.0, source);
}

ProjectionSearch::Reached& ProjectionSearch::At(NodeId node) {
  std::int32_t& place = reached_at_[static_cast<std::size_t>(node)];
  if (place < 0) {
    place = static_cast<std::int32_t>(reached_.size());
    reached_.emplace_back();
  }
  return reached_[static_cast<std::size_t>(place)];
}

void ProjectionSearch::SettleNext() {
  const NodeId node = queue_.top().second;
  queue_.pop();
  const Reached here = At(node);
  if (here.place >= 0) return;
  At(node).place = static_cast<std::int32_t>(settled_.size());
  ProjectedNode projected{node, {}, 0.0};
  if (here.by >= 0) {
    const Edge& edge = graph_.edge(here.by);
    projected.T_source_node = settled_[here.parent].T_source_node *
                              (edge.to == node ? edge.T_from_to : Inverse(edge.T_from_to));
    projected.cost = projected.T_source_node.covariance.trace();
  }
  const ComposedTrace trace(projected.T_source_node);
  for (const EdgeId id : graph_.EdgesOf(node)) {
    const Edge& edge = graph_.edge(id);
    const bool forward = edge.from == node;
    const NodeId neighbour = forward ? edge.to : edge.from;
    Reached& there = At(neighbour);
    if (there.place >= 0) continue;
    const double cost_there =
        forward ? trace.With(edge.T_from_to) : trace.WithInverse(edge.T_from_to);
    if (!(cost_there < there.cost)) continue;
    there.cost = cost_there;
    there.by = id;
    there.parent = settled_.size();
    queue_.emplace(cost_there, neighbour);
  }
  settled_.push_back(std::move(projected));
}

const ProjectedNode* ProjectionSearch::Find(NodeId node, double max_cost) {
  const auto of_node = static_cast<std::size_t>(node);
  const auto is_settled = [&] {
    return reached_at_[of_node] >= 0 &&
           reached_[static_cast<std::size_t>(reached_at_[of_node])].place >= 0;
  };
  while (!is_settled()) {
    if (queue_.empty() || queue_.top().first > max_cost) return nullptr;
    SettleNext();
  }
  const Reached& reached = reached_[static_cast<std::size_t>(reached_at_[of_node])];
  if (reached.cost > max_cost) return nullptr;
  return &settled_[static_cast<std::size_t>(reached.place)];
}

std::vector<ProjectedNode> ProjectionSearch::All() && {
  while (!queue_.empty()) SettleNext();
  return std::move(settled_);
}

std::vector<ProjectedNode> DijkstraProjection(const PoseGraph& graph, NodeId source) {
  return ProjectionSearch(graph, source).All();
}

}  // namespace masked_mapper
