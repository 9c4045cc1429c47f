// SPDX-License-Identifier: BSD-3-Clause
// Dijkstra over covariances (Section III-C). Relaxing an edge needs only the trace of the composed
// covariance, which has a closed form; the composition itself (Eq. 3-6) is done once per settled
// node.
#include "masked_mapper/pose_graph/dijkstra_projection.hpp"

#include <functional>
#include <queue>
#include <utility>

#include "masked_mapper/geometry/uncertain_pose2.hpp"
#include "masked_mapper/text/check.hpp"

namespace masked_mapper {
namespace {

struct Reached {
  double cost = std::numeric_limits<double>::infinity();
  EdgeId by = -1;         // the edge by which `cost` is reached
  NodeId parent = -1;     // its other end, already settled
  std::size_t place = 0;  // of the settled node in the result
  bool settled = false;
};

}  // namespace

std::vector<ProjectedNode> DijkstraProjection(const PoseGraph& graph, NodeId source,
                                              const ProjectionLimits& limits) {
  Check(source >= 0 && static_cast<std::size_t>(source) < graph.nodes().size(),
        "the source is a node of the graph");
  std::vector<Reached> reached(graph.nodes().size());
  std::vector<ProjectedNode> settled;
  using Entry = std::pair<double, NodeId>;
  std::priority_queue<Entry, std::vector<Entry>, std::greater<>> queue;
  reached[static_cast<std::size_t>(source)].cost = 0.0;
  queue.emplace(0.0, source);
  while (!queue.empty()) {
    const auto [cost, node] = queue.top();
    queue.pop();
    Reached& here = reached[static_cast<std::size_t>(node)];
    if (here.settled) continue;
    if (cost > limits.max_cost) break;
    here.settled = true;
    here.place = settled.size();
    ProjectedNode projected{node, {}, 0.0};
    if (node != source) {
      const Edge& edge = graph.edges()[static_cast<std::size_t>(here.by)];
      const std::size_t parent = reached[static_cast<std::size_t>(here.parent)].place;
      projected.T_source_node = settled[parent].T_source_node *
                                (edge.to == node ? edge.T_from_to : Inverse(edge.T_from_to));
      projected.cost = projected.T_source_node.covariance.trace();
    }
    const ComposedTrace trace(projected.T_source_node);
    for (const EdgeId id : graph.EdgesOf(node)) {
      const Edge& edge = graph.edges()[static_cast<std::size_t>(id)];
      const bool forward = edge.from == node;
      const NodeId neighbour = forward ? edge.to : edge.from;
      Reached& there = reached[static_cast<std::size_t>(neighbour)];
      if (there.settled) continue;
      const double cost_there =
          forward ? trace.With(edge.T_from_to) : trace.WithInverse(edge.T_from_to);
      if (!(cost_there < there.cost)) continue;
      there.cost = cost_there;
      there.by = id;
      there.parent = node;
      queue.emplace(cost_there, neighbour);
    }
    settled.push_back(std::move(projected));
  }
  return settled;
}

}  // namespace masked_mapper
