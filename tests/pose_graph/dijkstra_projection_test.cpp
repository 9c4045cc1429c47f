// SPDX-License-Identifier: BSD-3-Clause
#include "masked_mapper/pose_graph/dijkstra_projection.hpp"

#include <gtest/gtest.h>

#include <Eigen/Core>
#include <algorithm>
#include <functional>
#include <limits>
#include <numeric>
#include <optional>
#include <random>
#include <set>
#include <vector>

namespace masked_mapper {
namespace {

Eigen::Matrix3d RandomCovariance(std::mt19937& random, double sigma_theta) {
  std::normal_distribution<double> normal;
  Eigen::Matrix3d root;
  for (int i = 0; i < 9; ++i) root(i / 3, i % 3) = normal(random);
  root.row(2) *= sigma_theta;
  return root * root.transpose();
}

PoseGraph RandomGraph(std::mt19937& random, int nodes, int edges, double sigma_theta) {
  PoseGraph graph;
  graph.AddFloor({});
  for (int i = 0; i < nodes; ++i) graph.AddNode({});
  std::uniform_int_distribution<NodeId> any(0, nodes - 1);
  std::uniform_real_distribution<double> metres(-3.0, 3.0);
  std::uniform_real_distribution<double> radians(-kPi, kPi);
  for (int i = 0; i < edges; ++i) {
    Edge edge;
    edge.from = any(random);
    do edge.to = any(random);
    while (edge.to == edge.from);
    edge.T_from_to.mean = {metres(random), metres(random), radians(random)};
    edge.T_from_to.covariance = RandomCovariance(random, sigma_theta);
    graph.AddEdge(edge);
  }
  return graph;
}

UncertainPose2 Along(const Edge& edge, NodeId from) {
  return edge.from == from ? edge.T_from_to : Inverse(edge.T_from_to);
}

// Calls `visit` for the end of every simple path from `source`, the empty one included.
void EnumeratePaths(const PoseGraph& graph, NodeId source,
                    const std::function<void(NodeId, const UncertainPose2&)>& visit) {
  std::vector<bool> on_path(graph.nodes().size(), false);
  const std::function<void(NodeId, const UncertainPose2&)> walk = [&](NodeId node,
                                                                      const UncertainPose2& T) {
    on_path[static_cast<std::size_t>(node)] = true;
    visit(node, T);
    for (const EdgeId id : graph.EdgesOf(node)) {
      const Edge& edge = graph.edges()[static_cast<std::size_t>(id)];
      const NodeId next = edge.from == node ? edge.to : edge.from;
      if (!on_path[static_cast<std::size_t>(next)]) walk(next, T * Along(edge, node));
    }
    on_path[static_cast<std::size_t>(node)] = false;
  };
  walk(source, {});
}

// The definition, word for word: settle the node whose best composition from a settled node has the
// least trace.
std::vector<ProjectedNode> ObviousProjection(const PoseGraph& graph, NodeId source) {
  std::vector<ProjectedNode> settled{{source, {}, 0.0}};
  std::set<NodeId> done{source};
  while (true) {
    std::optional<ProjectedNode> best;
    for (const ProjectedNode& from : settled) {
      for (const EdgeId id : graph.EdgesOf(from.node)) {
        const Edge& edge = graph.edges()[static_cast<std::size_t>(id)];
        const NodeId next = edge.from == from.node ? edge.to : edge.from;
        if (done.count(next) > 0) continue;
        const UncertainPose2 T = from.T_source_node * Along(edge, from.node);
        const double cost = T.covariance.trace();
        if (!best || cost < best->cost) best = ProjectedNode{next, T, cost};
      }
    }
    if (!best) return settled;
    done.insert(best->node);
    settled.push_back(*best);
  }
}

void ExpectSame(const UncertainPose2& a, const UncertainPose2& b) {
  EXPECT_NEAR(a.mean.x, b.mean.x, 1e-9) << "m";
  EXPECT_NEAR(a.mean.y, b.mean.y, 1e-9) << "m";
  EXPECT_NEAR(RadToDeg(WrapAngle(a.mean.theta - b.mean.theta)), 0.0, 1e-9) << "deg";
  EXPECT_LT((a.covariance - b.covariance).norm(), 1e-9 * (1.0 + b.covariance.norm()));
}

TEST(DijkstraProjection, LeastOfAllPathsWhereTheTraceIsAdditive) {
  std::mt19937 random(1);
  for (int trial = 0; trial < 60; ++trial) {
    // Without uncertainty of heading the traces along a path just add up.
    const PoseGraph graph = RandomGraph(random, 6, 9, 0.0);
    const std::vector<ProjectedNode> projection = DijkstraProjection(graph, 2);
    std::vector<double> least(graph.nodes().size(), std::numeric_limits<double>::infinity());
    std::vector<UncertainPose2> least_path(graph.nodes().size());
    EnumeratePaths(graph, 2, [&](NodeId node, const UncertainPose2& T) {
      const auto n = static_cast<std::size_t>(node);
      if (T.covariance.trace() >= least[n]) return;
      least[n] = T.covariance.trace();
      least_path[n] = T;
    });
    std::size_t reachable = 0;
    for (const double cost : least) reachable += std::isfinite(cost) ? 1 : 0;
    ASSERT_EQ(projection.size(), reachable);
    for (const ProjectedNode& projected : projection) {
      const auto n = static_cast<std::size_t>(projected.node);
      EXPECT_NEAR(projected.cost, least[n], 1e-9 * (1.0 + least[n]));
      ExpectSame(projected.T_source_node, least_path[n]);
    }
  }
}

TEST(DijkstraProjection, AgreesWithItsDefinitionAndComposesARealPath) {
  std::mt19937 random(2);
  for (int trial = 0; trial < 60; ++trial) {
    const PoseGraph graph = RandomGraph(random, 7, 10, 0.3);
    const std::vector<ProjectedNode> projection = DijkstraProjection(graph, 0);
    const std::vector<ProjectedNode> expected = ObviousProjection(graph, 0);
    ASSERT_EQ(projection.size(), expected.size());
    for (std::size_t i = 0; i < projection.size(); ++i) {
      ASSERT_EQ(projection[i].node, expected[i].node);
      EXPECT_NEAR(projection[i].cost, expected[i].cost, 1e-9 * (1.0 + expected[i].cost));
      ExpectSame(projection[i].T_source_node, expected[i].T_source_node);
      bool is_a_path = false;
      double least = std::numeric_limits<double>::infinity();
      EnumeratePaths(graph, 0, [&](NodeId node, const UncertainPose2& T) {
        if (node != projection[i].node) return;
        least = std::min(least, T.covariance.trace());
        is_a_path = is_a_path || (T.covariance - projection[i].T_source_node.covariance).norm() <
                                     1e-9 * (1.0 + T.covariance.norm());
      });
      EXPECT_TRUE(is_a_path);
      EXPECT_GE(projection[i].cost, least - 1e-9 * (1.0 + least));
    }
  }
}

TEST(DijkstraProjection, BackwardEdgesAreInverted) {
  PoseGraph graph;
  graph.AddFloor({});
  graph.AddNode({});
  graph.AddNode({});
  std::mt19937 random(3);
  Edge edge;
  edge.from = 1;
  edge.to = 0;
  edge.T_from_to = {{2.0, 1.0, 0.5}, RandomCovariance(random, 0.2)};
  graph.AddEdge(edge);
  const std::vector<ProjectedNode> projection = DijkstraProjection(graph, 0);
  ASSERT_EQ(projection.size(), 2u);
  ExpectSame(projection[1].T_source_node, Inverse(edge.T_from_to));
}

TEST(DijkstraProjection, StopsAtTheLimitAndLeavesOutTheUnreachable) {
  PoseGraph graph;
  graph.AddFloor({});
  for (int i = 0; i < 6; ++i) graph.AddNode({});
  Edge edge;
  edge.T_from_to = {{1.0, 0.0, 0.0}, Eigen::Vector3d(0.5, 0.5, 0.0).asDiagonal()};
  for (NodeId i = 0; i < 4; ++i) {
    edge.from = i;
    edge.to = i + 1;
    graph.AddEdge(edge);
  }
  EXPECT_EQ(DijkstraProjection(graph, 0).size(), 5u);
  EXPECT_EQ(DijkstraProjection(graph, 5).size(), 1u);
  ProjectionSearch search(graph, 0);
  EXPECT_EQ(search.Find(3, 2.0), nullptr);
  ASSERT_NE(search.Find(2, 2.0), nullptr);
  EXPECT_NEAR(search.Find(2, 2.0)->T_source_node.mean.x, 2.0, 1e-12) << "m";
  ASSERT_NE(search.Find(3), nullptr);
  EXPECT_EQ(search.Find(3, 2.0), nullptr) << "though it is settled by now";
  EXPECT_EQ(search.Find(5), nullptr);
}

TEST(DijkstraProjection, GoesAsFarAsAskedAndFindsWhatTheWholeOneFinds) {
  std::mt19937 random(7);
  for (int trial = 0; trial < 20; ++trial) {
    const PoseGraph graph = RandomGraph(random, 40, 50, 0.1);
    const std::vector<ProjectedNode> whole = DijkstraProjection(graph, 3);
    std::vector<const ProjectedNode*> by_node(graph.nodes().size(), nullptr);
    for (const ProjectedNode& projected : whole) {
      by_node[static_cast<std::size_t>(projected.node)] = &projected;
    }
    std::vector<NodeId> order(graph.nodes().size());
    std::iota(order.begin(), order.end(), 0);
    std::shuffle(order.begin(), order.end(), random);
    ProjectionSearch search(graph, 3);
    for (const NodeId node : order) {
      const ProjectedNode* expected = by_node[static_cast<std::size_t>(node)];
      const ProjectedNode* found = search.Find(node);
      ASSERT_EQ(found == nullptr, expected == nullptr);
      if (found != nullptr) ExpectSame(found->T_source_node, expected->T_source_node);
    }
  }
}

TEST(DijkstraProjection, TiesGoToTheLowerId) {
  PoseGraph graph;
  graph.AddFloor({});
  for (int i = 0; i < 4; ++i) graph.AddNode({});
  Edge edge;
  edge.T_from_to = {{1.0, 0.0, 0.0}, Eigen::Matrix3d::Identity()};
  for (const NodeId to : {3, 1, 2}) {
    edge.to = to;
    graph.AddEdge(edge);
  }
  const std::vector<ProjectedNode> projection = DijkstraProjection(graph, 0);
  ASSERT_EQ(projection.size(), 4u);
  for (std::size_t i = 0; i < 4; ++i) EXPECT_EQ(projection[i].node, static_cast<NodeId>(i));
}

}  // namespace
}  // namespace masked_mapper
