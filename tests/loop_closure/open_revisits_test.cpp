// SPDX-License-Identifier: BSD-3-Clause
#include "loop_closure/open_revisits.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <random>

namespace masked_mapper {
namespace {

NodeId AddNode(PoseGraph& graph, const Pose2& T_world_robot, FloorId floor = 0) {
  Node node;
  node.floor = floor;
  node.T_world_robot = T_world_robot;
  const NodeId id = graph.AddNode(node);
  if (id == 0) return id;
  const Node& before = graph.nodes()[static_cast<std::size_t>(id - 1)];
  const EdgeKind kind = before.floor == floor ? EdgeKind::kOdometry : EdgeKind::kFloorChange;
  UncertainPose2 step;
  step.mean = Between(before.T_world_robot, T_world_robot);
  graph.AddEdge({id - 1, id, step, kind});
  return id;
}

void AddClosure(PoseGraph& graph, NodeId a, NodeId b) {
  graph.AddEdge({a, b, UncertainPose2(), EdgeKind::kClosure});
}

// Twice along a corridor of 40 m, back far away: nodes 0 to 4, then 5 and 6, then 7 to 11.
PoseGraph CorridorTwice() {
  PoseGraph graph;
  graph.AddFloor({});
  for (int i = 0; i <= 4; ++i) AddNode(graph, {10.0 * i, 0.0, 0.0});
  AddNode(graph, {40.0, 30.0, kPi});
  AddNode(graph, {0.0, 30.0, kPi});
  for (int i = 0; i <= 4; ++i) AddNode(graph, {10.0 * i, 0.5, 0.1});
  return graph;
}

TEST(OpenRevisits, AreThePlacesPassedTwiceThatNoShortWalkJoins) {
  PoseGraph graph = CorridorTwice();
  AddClosure(graph, 7, 0);
  AddClosure(graph, 11, 4);
  const OpenRevisits revisits(graph, {});
  EXPECT_TRUE(revisits.Of(4).empty()) << "nothing earlier is near";
  EXPECT_TRUE(revisits.Of(7).empty()) << "closed already";
  EXPECT_EQ(revisits.Of(8), std::vector<NodeId>{1}) << "20.5 m round by the closed end";
  EXPECT_EQ(revisits.Of(9), std::vector<NodeId>{2});
  AddClosure(graph, 9, 2);
  EXPECT_TRUE(revisits.Of(9).empty()) << "edges may be added";
  EXPECT_EQ(revisits.Of(8), std::vector<NodeId>{1}) << "10 m to either side is too far";
}

TEST(OpenRevisits, AnotherFloorIsNoRevisitAndAnotherHeadingIs) {
  PoseGraph graph;
  graph.AddFloor({});
  graph.AddFloor({});
  AddNode(graph, {0.0, 0.0, 0.0});
  AddNode(graph, {30.0, 0.0, 0.0});
  AddNode(graph, {0.0, 1.0, kPi});
  AddNode(graph, {30.0, 40.0, 0.0});     // a lift, out of
  AddNode(graph, {30.0, 40.0, 0.0}, 1);  // and into
  AddNode(graph, {0.0, 0.0, 0.0}, 1);
  AddNode(graph, {30.0, 40.0, 0.0}, 1);  // back to the lift's door
  const OpenRevisits revisits(graph, {});
  EXPECT_EQ(revisits.Of(2), std::vector<NodeId>{0}) << "the opposite heading";
  EXPECT_TRUE(revisits.Of(5).empty()) << "another floor";
  EXPECT_TRUE(revisits.Of(4).empty());
  EXPECT_TRUE(revisits.Of(6).empty()) << "what stands beside a change of floor holds no scan";
}

// All pairs by Floyd and Warshall against the search.
TEST(OpenRevisits, AgreeWithAllPairsOnRandomGraphs) {
  std::mt19937 random(7);
  const auto draw = [&](double low, double high) {
    return std::uniform_real_distribution<double>(low, high)(random);
  };
  for (int round = 0; round < 20; ++round) {
    PoseGraph graph;
    graph.AddFloor({});
    graph.AddFloor({});
    constexpr NodeId kNodes = 60;
    for (NodeId i = 0; i < kNodes; ++i) {
      AddNode(graph, {draw(0.0, 25.0), draw(0.0, 25.0), draw(-kPi, kPi)}, i < 30 ? 0 : 1);
    }
    for (int i = 0; i < 15; ++i) {
      const auto a = static_cast<NodeId>(draw(1.0, 29.9));
      AddClosure(graph, a, static_cast<NodeId>(draw(0.0, a - 0.1)));
    }
    OpenRevisitOptions options;
    options.distance_m = 5.0;
    options.walk_m = 20.0;
    std::vector<std::vector<double>> walk(
        kNodes, std::vector<double>(kNodes, std::numeric_limits<double>::infinity()));
    const auto pose = [&](NodeId id) {
      return graph.nodes()[static_cast<std::size_t>(id)].T_world_robot;
    };
    for (const Edge& edge : graph.edges()) {
      const auto a = static_cast<std::size_t>(edge.from);
      const auto b = static_cast<std::size_t>(edge.to);
      walk[a][b] = walk[b][a] = Distance(pose(edge.from), pose(edge.to));
    }
    for (std::size_t k = 0; k < kNodes; ++k) {
      for (std::size_t i = 0; i < kNodes; ++i) {
        for (std::size_t j = 0; j < kNodes; ++j) {
          walk[i][j] = std::min(walk[i][j], walk[i][k] + walk[k][j]);
        }
      }
    }
    const OpenRevisits revisits(graph, options);
    for (NodeId a = 0; a < kNodes; ++a) {
      std::vector<NodeId> expected;
      for (NodeId b = 0; b < a; ++b) {
        const bool beside_change = a == 29 || a == 30 || b == 29 || b == 30;
        if (beside_change || (a < 30) != (b < 30)) continue;
        if (Distance(pose(a), pose(b)) > 5.0) continue;
        if (walk[static_cast<std::size_t>(a)][static_cast<std::size_t>(b)] > 20.0) {
          expected.push_back(b);
        }
      }
      std::sort(expected.begin(), expected.end(), [&](NodeId one, NodeId other) {
        return Distance(pose(a), pose(one)) < Distance(pose(a), pose(other));
      });
      EXPECT_EQ(revisits.Of(a), expected) << "round " << round << ", node " << a;
    }
  }
}

TEST(OpenRevisits, AnEmptyGraphAndALoneNodeHaveNone) {
  PoseGraph graph;
  const OpenRevisits none(graph, {});
  graph.AddFloor({});
  AddNode(graph, {});
  EXPECT_TRUE(OpenRevisits(graph, {}).Of(0).empty());
}

}  // namespace
}  // namespace masked_mapper
