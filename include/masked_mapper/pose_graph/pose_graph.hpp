// SPDX-License-Identifier: BSD-3-Clause
// The masked pose graph (Section III-B): nodes, edges and floors of a whole building. Measurements
// are immutable; the optimised pose of a node is the one thing that moves.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "masked_mapper/geometry/uncertain_pose2.hpp"
#include "masked_mapper/sensor/laser_scan.hpp"

namespace masked_mapper {

using NodeId = std::int32_t;   ///< place in PoseGraph::nodes()
using EdgeId = std::int32_t;   ///< place in PoseGraph::edges()
using FloorId = std::int32_t;  ///< place in PoseGraph::floors(), in order of first visit

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
  Pose2 T_odom_robot;                    ///< where motion put the robot
  ScanPoints::ConstPtr points_in_robot;  ///< null for an odometry-only node
  Pose2 T_world_robot;                   ///< optimised

  bool HasScan() const { return points_in_robot != nullptr; }
};

enum class EdgeKind { kOdometry, kFloorChange, kClosure };

struct Edge {
  NodeId from = 0;
  NodeId to = 0;
  UncertainPose2 T_from_to;
  EdgeKind kind = EdgeKind::kOdometry;
};

class PoseGraph {
 public:
  FloorId AddFloor(Floor floor);
  /// `node.floor` must exist.
  NodeId AddNode(Node node);
  /// Both ends must exist and differ; a closure joins nodes of one floor only. Violations are bugs.
  EdgeId AddEdge(Edge edge);
  /// Takes the edge out of nodes' edge lists and of edges(); ids of later edges shift down by one.
  void RemoveEdge(EdgeId edge);

  const std::vector<Node>& nodes() const { return nodes_; }
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

 private:
  std::vector<Node> nodes_;
  std::vector<Edge> edges_;
  std::vector<Floor> floors_;
  std::vector<std::vector<EdgeId>> edges_of_;
};

/// The view of one floor: its nodes, and the edges with both ends on it, in order of ids.
struct FloorGraph {
  std::vector<NodeId> nodes;
  std::vector<EdgeId> edges;
};
FloorGraph FloorView(const PoseGraph& graph, FloorId floor);

}  // namespace masked_mapper
