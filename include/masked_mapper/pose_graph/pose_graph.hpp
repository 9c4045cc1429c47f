// SPDX-License-Identifier: BSD-3-Clause
// The masked pose graph (Section III-B): nodes, edges and floors of a whole building. Measurements
// are immutable; the optimised pose of a node is the one thing that moves.
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "masked_mapper/geometry/uncertain_pose2.hpp"

namespace masked_mapper {

using NodeId = std::int32_t;      ///< place in PoseGraph::nodes()
using EdgeId = std::int32_t;      ///< place in PoseGraph::edges()
using FloorId = std::int32_t;     ///< place in PoseGraph::floors(), in order of first visit
using KeptScanId = std::int32_t;  ///< place in the map's list of kept scans
using ClosureId = std::int32_t;   ///< place in the map's list of closures

struct Floor {
  std::string label;
  double elevation = 0.0;           ///< m above the first floor of the log
  double elevation_sigma = 0.0;     ///< m
  bool elevation_measured = false;  ///< false: a typical storey height was assumed
  bool label_given = false;         ///< by the log or by hand; false: its place among the others
};

struct Node {
  double stamp = 0.0;  ///< s
  FloorId floor = 0;
  Pose2 T_odom_robot;    ///< where motion put the robot
  Pose2 T_world_robot;   ///< optimised
  KeptScanId scan = -1;  ///< its scan; -1: an odometry-only node

  bool HasScan() const { return scan >= 0; }
};

/// A heading edge tells how its nodes are turned to each other and, by a sigma of 100 km, nothing
/// of where they lie: it is no way.
enum class EdgeKind { kOdometry, kFloorChange, kClosure, kHeading };
constexpr std::array<const char*, 4> NamesOf(EdgeKind /*any*/) {
  return {"odometry", "floor_change", "closure", "heading"};
}

struct Edge {
  NodeId from = 0;
  NodeId to = 0;
  UncertainPose2 T_from_to;
  EdgeKind kind = EdgeKind::kOdometry;
  ClosureId closure = -1;  ///< the record of a closure; -1: none, or no closure
};

class PoseGraph {
 public:
  FloorId AddFloor(Floor floor);
  /// `node.floor` must exist.
  NodeId AddNode(Node node);
  /// Both ends must exist and differ; a closure joins nodes of one floor only. Violations are bugs.
  EdgeId AddEdge(Edge edge);
  /// Takes edges out, given in order of their ids; those that stay close the gaps.
  void RemoveEdges(const std::vector<EdgeId>& edges);
  void RemoveEdge(EdgeId edge) { RemoveEdges({edge}); }

  const std::vector<Node>& nodes() const { return nodes_; }
  const Node& node(NodeId id) const { return nodes_[static_cast<std::size_t>(id)]; }
  const Edge& edge(EdgeId id) const { return edges_[static_cast<std::size_t>(id)]; }
  const Floor& floor(FloorId id) const { return floors_[static_cast<std::size_t>(id)]; }
  const std::vector<Edge>& edges() const { return edges_; }
  const std::vector<Floor>& floors() const { return floors_; }
  /// Edges that touch a node, in order of their ids.
  const std::vector<EdgeId>& EdgesOf(NodeId node) const {
    return edges_of_[static_cast<std::size_t>(node)];
  }

  void SetPose(NodeId node, const Pose2& T_world_robot) {
    nodes_[static_cast<std::size_t>(node)].T_world_robot = T_world_robot;
  }
  void SetElevation(FloorId floor, double elevation, double sigma, bool measured);

  // A graph whose frame, clock or floors turn out to be others; what was measured stays.
  /// The same nodes on these floors; `floor_of_node` has one for each. Ends of a closure must stay
  /// on one floor.
  void Refloor(std::vector<Floor> floors, const std::vector<FloorId>& floor_of_node);
  /// The node, and the motion path at it, in another frame.
  void MoveNode(NodeId node, const Pose2& T_to_from);
  void ShiftStamps(double seconds);

 private:
  std::vector<Node> nodes_;
  std::vector<Edge> edges_;
  std::vector<Floor> floors_;
  std::vector<std::vector<EdgeId>> edges_of_;  ///< by node
};

/// The view of one floor: its nodes, and the edges with both ends on it, in order of ids.
struct FloorGraph {
  std::vector<NodeId> nodes;
  std::vector<EdgeId> edges;
};
FloorGraph FloorView(const PoseGraph& graph, FloorId floor);

}  // namespace masked_mapper
