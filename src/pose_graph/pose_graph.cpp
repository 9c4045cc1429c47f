// SPDX-License-Identifier: BSD-3-Clause
#include "masked_mapper/pose_graph/pose_graph.hpp"

#include <algorithm>
#include <cstdlib>
#include <utility>

namespace masked_mapper {
namespace {

// A graph with a dangling end would be found out only in a wrong map, so this holds in release
// builds too.
void Require(bool holds) {
  if (!holds) std::abort();
}

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
  Require(Exists(floors_, node.floor));
  nodes_.push_back(std::move(node));
  edges_of_.emplace_back();
  return static_cast<NodeId>(nodes_.size() - 1);
}

EdgeId PoseGraph::AddEdge(Edge edge) {
  Require(Exists(nodes_, edge.from) && Exists(nodes_, edge.to) && edge.from != edge.to);
  const auto from = static_cast<std::size_t>(edge.from);
  const auto to = static_cast<std::size_t>(edge.to);
  Require(edge.kind != EdgeKind::kClosure || nodes_[from].floor == nodes_[to].floor);
  const auto id = static_cast<EdgeId>(edges_.size());
  edges_.push_back(std::move(edge));
  edges_of_[from].push_back(id);
  edges_of_[to].push_back(id);
  return id;
}

void PoseGraph::RemoveEdge(EdgeId edge) {
  Require(Exists(edges_, edge));
  edges_.erase(edges_.begin() + edge);
  for (std::vector<EdgeId>& touching : edges_of_) {
    touching.erase(std::remove(touching.begin(), touching.end(), edge), touching.end());
    for (EdgeId& id : touching) id -= id > edge ? 1 : 0;
  }
}

void PoseGraph::SetElevation(FloorId floor, double elevation, double sigma, bool measured) {
  Require(Exists(floors_, floor));
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
