// SPDX-License-Identifier: BSD-3-Clause
// Dijkstra over covariances (Section III-C). Relaxing an edge needs only the trace of the composed
// covariance, which has a closed form; the composition itself (Eq. 3-6) is done once per settled
// node.
#include "masked_mapper/pose_graph/dijkstra_projection.hpp"

#include <cmath>
#include <cstdlib>
#include <functional>
#include <queue>
#include <utility>

namespace masked_mapper {
namespace {

struct Reached {
  double cost = std::numeric_limits<double>::infinity();
  EdgeId by = -1;         // the edge by which `cost` is reached
  NodeId parent = -1;     // its other end, already settled
  std::size_t place = 0;  // of the settled node in the result
  bool settled = false;
};

// Where the edge leads, seen from one of its ends, together with what its own covariance adds to
// the trace: a rotation of the frame leaves a trace as it is (J2 of Eq. 6).
struct Step {
  Eigen::Vector2d translation;
  double trace;
};

Step StepAlong(const Edge& edge, bool forward) {
  const Pose2& T = edge.T_from_to.mean;
  const Eigen::Matrix3d& covariance = edge.T_from_to.covariance;
  if (forward) return {T.Translation(), covariance.trace()};
  // The trace of Inverse(T_from_to), without its matrix product.
  const double c = std::cos(T.theta);
  const double s = std::sin(T.theta);
  const Eigen::Vector2d back(-c * T.x - s * T.y, s * T.x - c * T.y);
  const Eigen::Vector2d lever(-c * back.y() - s * back.x(), c * back.x() - s * back.y());
  const double trace = covariance.trace() + lever.squaredNorm() * covariance(2, 2) +
                       2.0 * (lever.x() * covariance(0, 2) + lever.y() * covariance(1, 2));
  return {back, trace};
}

// trace(J1 Sigma J1^T) + trace(J2 Sigma_step J2^T): J1 (Eq. 5) differs from the identity by the
// lever that turns the step with the heading. cos_theta, sin_theta: of the heading where the step
// begins.
double TraceAfter(const UncertainPose2& T_source_node, double cos_theta, double sin_theta,
                  const Step& step) {
  const Eigen::Matrix3d& covariance = T_source_node.covariance;
  const double lever_x = -sin_theta * step.translation.x() - cos_theta * step.translation.y();
  const double lever_y = cos_theta * step.translation.x() - sin_theta * step.translation.y();
  return covariance.trace() + step.trace +
         (lever_x * lever_x + lever_y * lever_y) * covariance(2, 2) +
         2.0 * (lever_x * covariance(0, 2) + lever_y * covariance(1, 2));
}

}  // namespace

std::vector<ProjectedNode> DijkstraProjection(const PoseGraph& graph, NodeId source,
                                              const ProjectionLimits& limits) {
  if (source < 0 || static_cast<std::size_t>(source) >= graph.nodes().size()) std::abort();
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
    const double cos_theta = std::cos(projected.T_source_node.mean.theta);
    const double sin_theta = std::sin(projected.T_source_node.mean.theta);
    for (const EdgeId id : graph.EdgesOf(node)) {
      const Edge& edge = graph.edges()[static_cast<std::size_t>(id)];
      const bool forward = edge.from == node;
      const NodeId neighbour = forward ? edge.to : edge.from;
      Reached& there = reached[static_cast<std::size_t>(neighbour)];
      if (there.settled) continue;
      const double cost_there =
          TraceAfter(projected.T_source_node, cos_theta, sin_theta, StepAlong(edge, forward));
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
