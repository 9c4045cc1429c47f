// SPDX-License-Identifier: BSD-3-Clause
#include "masked_mapper/map/trajectory.hpp"

#include <algorithm>
#include <cmath>

namespace masked_mapper {
namespace {

/// How much motion error a step may have gathered: metres, with a radian of turning counted as one.
double StepLength(const Pose2& T_odom_from, const Pose2& T_odom_to) {
  return Distance(T_odom_from, T_odom_to) +
         std::abs(WrapAngle(T_odom_to.theta - T_odom_from.theta));
}

/// Whether motion led from this node to the next one made: not from one drive to another.
bool HasNext(const PoseGraph& graph, std::size_t node) {
  const auto next = static_cast<NodeId>(node + 1);
  const std::vector<EdgeId>& edges = graph.EdgesOf(static_cast<NodeId>(node));
  return std::any_of(edges.begin(), edges.end(), [&](EdgeId id) {
    const Edge& edge = graph.edges()[static_cast<std::size_t>(id)];
    return edge.to == next &&
           (edge.kind == EdgeKind::kOdometry || edge.kind == EdgeKind::kFloorChange);
  });
}

}  // namespace

void BendTrajectory(const PoseGraph& graph, std::vector<TrajectoryPose>& trajectory) {
  const std::vector<Node>& nodes = graph.nodes();
  std::size_t begin = 0;
  while (begin < trajectory.size()) {
    const auto node = static_cast<std::size_t>(trajectory[begin].node_before);
    std::size_t end = begin;
    double length = 0.0;
    std::vector<double> travelled;
    const Pose2* previous = &nodes[node].T_odom_robot;
    for (; end < trajectory.size() && static_cast<std::size_t>(trajectory[end].node_before) == node;
         ++end) {
      length += StepLength(*previous, trajectory[end].T_odom_robot);
      previous = &trajectory[end].T_odom_robot;
      travelled.push_back(length);
    }
    const bool has_next = HasNext(graph, node);
    if (has_next) length += StepLength(*previous, nodes[node + 1].T_odom_robot);
    for (std::size_t i = begin; i < end; ++i) {
      TrajectoryPose& pose = trajectory[i];
      const auto from = [&](const Node& anchor) {
        return anchor.T_world_robot * Between(anchor.T_odom_robot, pose.T_odom_robot);
      };
      pose.T_world_robot = from(nodes[node]);
      if (has_next && length > 0.0) {
        pose.T_world_robot =
            Interpolate(pose.T_world_robot, from(nodes[node + 1]), travelled[i - begin] / length);
      }
    }
    begin = end;
  }
}

}  // namespace masked_mapper
