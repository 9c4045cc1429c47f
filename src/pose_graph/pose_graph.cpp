// SPDX-License-Identifier: BSD-3-Clause
#include "masked_mapper/pose_graph/pose_graph.hpp"

#include <algorithm>
#include <utility>

#include "masked_mapper/text/check.hpp"

namespace masked_mapper {
namespace {

template <typename T>
bool Exists(const std::vector<T>& items, std::int32_t id) {
  return id >= 0 && static_cast<std::size_t>(id) < items.size();
}

}  // namespace

FloorId PoseGraph::AddFloor(Floor floor) {
  floors_.push_back(std::move(floor));
  return static_cast<FloorId>(floors_.size() - 1);
}

NodeId PoseGraph::AddNode(Node node) {
  Check(Exists(floors_, node.floor), "a node's floor exists");
  nodes_.push_back(node);
  edges_of_.emplace_back();
  return static_cast<NodeId>(nodes_.size() - 1);
}

EdgeId PoseGraph::AddEdge(Edge edge) {
  Check(Exists(nodes_, edge.from) && Exists(nodes_, edge.to) && edge.from != edge.to,
        "an edge joins two nodes");
  const auto from = static_cast<std::size_t>(edge.from);
  const auto to = static_cast<std::size_t>(edge.to);
  Check(edge.kind != EdgeKind::kClosure || nodes_[from].floor == nodes_[to].floor,
        "a closure joins nodes of one floor");
  const auto id = static_cast<EdgeId>(edges_.size());
  edges_.push_back(std::move(edge));
  edges_of_[from].push_back(id);
  edges_of_[to].push_back(id);
  return id;
}

void PoseGraph::RemoveEdges(const std::vector<EdgeId>& edges) {
  if (edges.empty()) return;
  constexpr EdgeId kGone = -1;
  std::vector<EdgeId> becomes(edges_.size());
  auto removed = edges.begin();
  EdgeId next = 0;
  for (std::size_t i = 0; i < edges_.size(); ++i) {
    if (removed != edges.end() && *removed == static_cast<EdgeId>(i)) {
      becomes[i] = kGone;
      ++removed;
      continue;
    }
    becomes[i] = next;
    if (static_cast<std::size_t>(next) != i) {
      edges_[static_cast<std::size_t>(next)] = std::move(edges_[i]);
    }
    ++next;
  }
  Check(removed == edges.end(), "edges to remove exist and are in order");
  edges_.resize(static_cast<std::size_t>(next));
  for (std::vector<EdgeId>& touching : edges_of_) {
    for (EdgeId& id : touching) id = becomes[static_cast<std::size_t>(id)];
    touching.erase(std::remove(touching.begin(), touching.end(), kGone), touching.end());
  }
}

void PoseGraph::Refloor(std::vector<Floor> floors, const std::vector<FloorId>& floor_of_node) {
  Check(floor_of_node.size() == nodes_.size(), "every node has a floor");
  floors_ = std::move(floors);
  for (std::size_t i = 0; i < nodes_.size(); ++i) {
    Check(Exists(floors_, floor_of_node[i]), "a node's floor exists");
    nodes_[i].floor = floor_of_node[i];
  }
  for (const Edge& edge : edges_) {
    Check(edge.kind != EdgeKind::kClosure || node(edge.from).floor == node(edge.to).floor,
          "a closure joins nodes of one floor");
  }
}

void PoseGraph::MoveNode(NodeId node, const Pose2& T_to_from) {
  Node& moved = nodes_[static_cast<std::size_t>(node)];
  moved.T_world_robot = T_to_from * moved.T_world_robot;
  moved.T_odom_robot = T_to_from * moved.T_odom_robot;
}

void PoseGraph::ShiftStamps(double seconds) {
  for (Node& node : nodes_) node.stamp += seconds;
}

void PoseGraph::SetElevation(FloorId floor, double elevation, double sigma, bool measured) {
  Check(Exists(floors_, floor), "a floor exists");
  Floor& changed = floors_[static_cast<std::size_t>(floor)];
  changed.elevation = elevation;
  changed.elevation_sigma = sigma;
  changed.elevation_measured = measured;
}

FloorGraph FloorView(const PoseGraph& graph, FloorId floor) {
  FloorGraph view;
  const auto on_floor = [&](NodeId node) {
    return graph.nodes()[static_cast<std::size_t>(node)].floor == floor;
  };
  for (std::size_t i = 0; i < graph.nodes().size(); ++i) {
    if (graph.nodes()[i].floor == floor) view.nodes.push_back(static_cast<NodeId>(i));
  }
  for (std::size_t i = 0; i < graph.edges().size(); ++i) {
    const Edge& edge = graph.edges()[i];
    if (on_floor(edge.from) && on_floor(edge.to)) view.edges.push_back(static_cast<EdgeId>(i));
  }
  return view;
}

}  // namespace masked_mapper
