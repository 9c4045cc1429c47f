// SPDX-License-Identifier: BSD-3-Clause
#include "open_revisits.hpp"

#include <algorithm>
#include <cstddef>
#include <functional>
#include <queue>
#include <utility>

namespace masked_mapper {

OpenRevisits::OpenRevisits(const PoseGraph& graph, const OpenRevisitOptions& options)
    : graph_(graph), options_(options) {
  for (std::size_t i = 0; i < graph.nodes().size(); ++i) {
    const auto id = static_cast<NodeId>(i);
    if (!IsBesideFloorChange(id)) by_x_.push_back(id);
  }
  std::sort(by_x_.begin(), by_x_.end(), [&](NodeId one, NodeId other) {
    return std::make_pair(PoseOf(one).x, one) < std::make_pair(PoseOf(other).x, other);
  });
}

const Pose2& OpenRevisits::PoseOf(NodeId node) const {
  return graph_.nodes()[static_cast<std::size_t>(node)].T_world_robot;
}

bool OpenRevisits::IsBesideFloorChange(NodeId node) const {
  const std::vector<EdgeId>& edges = graph_.EdgesOf(node);
  return std::any_of(edges.begin(), edges.end(), [&](EdgeId id) {
    return graph_.edges()[static_cast<std::size_t>(id)].kind == EdgeKind::kFloorChange;
  });
}

std::vector<NodeId> OpenRevisits::Of(NodeId node) const {
  std::vector<std::pair<double, NodeId>> near;
  if (IsBesideFloorChange(node)) return {};
  const Pose2& pose = PoseOf(node);
  const FloorId floor = graph_.nodes()[static_cast<std::size_t>(node)].floor;
  auto candidate = std::lower_bound(by_x_.begin(), by_x_.end(), pose.x - options_.distance_m,
                                    [&](NodeId id, double x) { return PoseOf(id).x < x; });
  for (; candidate != by_x_.end(); ++candidate) {
    const Pose2& other = PoseOf(*candidate);
    if (other.x > pose.x + options_.distance_m) break;
    if (*candidate >= node) continue;
    if (graph_.nodes()[static_cast<std::size_t>(*candidate)].floor != floor) continue;
    const double distance = Distance(pose, other);
    if (distance <= options_.distance_m) near.emplace_back(distance, *candidate);
  }
  std::vector<NodeId> open;
  if (near.empty()) return open;
  std::sort(near.begin(), near.end());
  const std::vector<NodeId> joined = WithinWalk(node);
  for (const auto& [distance, id] : near) {
    if (!std::binary_search(joined.begin(), joined.end(), id)) open.push_back(id);
  }
  return open;
}

std::vector<NodeId> OpenRevisits::WithinWalk(NodeId from) const {
  std::vector<NodeId> settled;
  std::vector<char> is_settled(graph_.nodes().size(), 0);
  const auto is_done = [&](NodeId node) { return is_settled[static_cast<std::size_t>(node)] != 0; };
  std::priority_queue<std::pair<double, NodeId>, std::vector<std::pair<double, NodeId>>,
                      std::greater<>>
      queue;
  queue.emplace(0.0, from);
  while (!queue.empty()) {
    const auto [walked, node] = queue.top();
    queue.pop();
    if (is_done(node)) continue;
    is_settled[static_cast<std::size_t>(node)] = 1;
    settled.push_back(node);
    for (const EdgeId id : graph_.EdgesOf(node)) {
      const Edge& edge = graph_.edges()[static_cast<std::size_t>(id)];
      if (edge.kind == EdgeKind::kHeading) continue;
      const NodeId next = edge.from == node ? edge.to : edge.from;
      if (is_done(next)) continue;
      const double there = walked + Distance(PoseOf(node), PoseOf(next));
      if (there <= options_.walk_m) queue.emplace(there, next);
    }
  }
  std::sort(settled.begin(), settled.end());
  return settled;
}

}  // namespace masked_mapper
