// SPDX-License-Identifier: BSD-3-Clause
#include "masked_mapper/optimization/pose_graph_optimizer.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <optional>
#include <random>
#include <string>
#include <vector>

#include "optimization/g2o_graph.hpp"

namespace masked_mapper {
namespace {

constexpr double kSigmaM = 0.03;
constexpr double kSigmaRad = 0.005;

Eigen::Matrix3d EdgeCovariance() {
  return Eigen::Vector3d(kSigmaM * kSigmaM, kSigmaM * kSigmaM, kSigmaRad * kSigmaRad).asDiagonal();
}

Pose2 Noisy(const Pose2& T, double scale, std::mt19937& random) {
  std::normal_distribution<double> normal;
  return {T.x + scale * kSigmaM * normal(random), T.y + scale * kSigmaM * normal(random),
          WrapAngle(T.theta + scale * kSigmaRad * normal(random))};
}

// Rounds of a square of `side` nodes a side, 1 m apart; node i of every round is at the same place.
std::vector<Pose2> Rounds(int side, int rounds) {
  std::vector<Pose2> truth{{}};
  for (int i = 1; i < 4 * side * rounds; ++i) {
    const bool corner = i % side == 0;
    truth.push_back(truth.back() * Pose2{1.0, 0.0, corner ? kPi / 2 : 0.0});
  }
  return truth;
}

// Poses as dead reckoning has them; closures between rounds.
PoseGraph NoisyRounds(const std::vector<Pose2>& truth, int side, double noise, unsigned seed) {
  std::mt19937 random(seed);
  PoseGraph graph;
  graph.AddFloor({});
  Pose2 reckoned = truth[0];
  for (std::size_t i = 0; i < truth.size(); ++i) {
    Edge edge;
    if (i > 0) {
      edge.from = static_cast<NodeId>(i - 1);
      edge.to = static_cast<NodeId>(i);
      edge.T_from_to = {Noisy(Between(truth[i - 1], truth[i]), noise, random), EdgeCovariance()};
      reckoned = reckoned * edge.T_from_to.mean;
    }
    Node node;
    node.T_world_robot = reckoned;
    graph.AddNode(node);
    if (i > 0) graph.AddEdge(edge);
  }
  const auto round = static_cast<std::size_t>(4 * side);
  for (std::size_t i = round; i < truth.size(); i += 2) {
    Edge edge;
    edge.from = static_cast<NodeId>(i);
    edge.to = static_cast<NodeId>(i - round);
    edge.kind = EdgeKind::kClosure;
    edge.T_from_to = {Noisy(Between(truth[i], truth[i - round]), noise, random), EdgeCovariance()};
    graph.AddEdge(edge);
  }
  return graph;
}

double MeanError(const PoseGraph& graph, const std::vector<Pose2>& truth) {
  double sum = 0.0;
  for (std::size_t i = 0; i < truth.size(); ++i) {
    sum += Distance(graph.nodes()[i].T_world_robot, truth[i]);
  }
  return sum / static_cast<double>(truth.size());
}

TEST(Optimize, PerfectMeasurementsGiveTheTruthBack) {
  const std::vector<Pose2> truth = Rounds(8, 2);
  PoseGraph graph = NoisyRounds(truth, 8, 0.0, 1);
  std::mt19937 random(5);
  for (std::size_t i = 1; i < truth.size(); ++i) {
    graph.SetPose(static_cast<NodeId>(i), Noisy(truth[i], 10.0, random));
  }
  const OptimizationSummary summary = Optimize({}, graph);
  EXPECT_TRUE(summary.converged);
  EXPECT_GT(summary.initial_chi2, 100.0);
  EXPECT_NEAR(summary.final_chi2, 0.0, 1e-6);
  for (std::size_t i = 0; i < truth.size(); ++i) {
    EXPECT_LT(Distance(graph.nodes()[i].T_world_robot, truth[i]), 1e-5) << "m";
    EXPECT_LT(RadToDeg(std::abs(WrapAngle(graph.nodes()[i].T_world_robot.theta - truth[i].theta))),
              1e-4)
        << "deg";
  }
}

TEST(Optimize, NoisyLoopsComeNearTheTruth) {
  const std::vector<Pose2> truth = Rounds(20, 4);
  PoseGraph graph = NoisyRounds(truth, 20, 1.0, 2);
  const double before = MeanError(graph, truth);
  const OptimizationSummary summary = Optimize({}, graph);
  EXPECT_TRUE(summary.converged);
  EXPECT_LT(summary.final_chi2, summary.initial_chi2);
  // chi^2 of an honest graph: three times its redundant edges, give or take.
  const double redundant = 3.0 * static_cast<double>(graph.edges().size() + 1 - truth.size());
  EXPECT_NEAR(summary.final_chi2, redundant, 5.0 * std::sqrt(2.0 * redundant));
  EXPECT_LT(MeanError(graph, truth), 0.5 * before) << "m";
  EXPECT_LT(MeanError(graph, truth), 0.35) << "m";
  double chi2 = 0.0;
  for (const Edge& edge : graph.edges()) chi2 += EdgeChi2(graph, edge);
  EXPECT_NEAR(chi2, summary.final_chi2, 1e-6 * chi2);
}

TEST(Optimize, HeadingFarOffIsPulledIn) {
  // A gyro bias that turns the whole drive by 30 degrees per round, as in Section IV.
  const std::vector<Pose2> truth = Rounds(20, 3);
  PoseGraph graph;
  graph.AddFloor({});
  Pose2 reckoned;
  const double bias = DegToRad(30.0 / 80.0);
  for (std::size_t i = 0; i < truth.size(); ++i) {
    Edge edge;
    if (i > 0) {
      edge.from = static_cast<NodeId>(i - 1);
      edge.to = static_cast<NodeId>(i);
      edge.T_from_to = {Between(truth[i - 1], truth[i]), EdgeCovariance()};
      edge.T_from_to.mean.theta += bias;
      reckoned = reckoned * edge.T_from_to.mean;
    }
    Node node;
    node.T_world_robot = reckoned;
    graph.AddNode(node);
    if (i > 0) graph.AddEdge(edge);
    if (i >= 80 && i % 3 == 0) {
      edge.from = static_cast<NodeId>(i);
      edge.to = static_cast<NodeId>(i - 80);
      edge.kind = EdgeKind::kClosure;
      edge.T_from_to = {{}, EdgeCovariance()};
      graph.AddEdge(edge);
    }
  }
  ASSERT_GT(MeanError(graph, truth), 3.0) << "m";
  EXPECT_TRUE(Optimize({}, graph).converged);
  EXPECT_LT(MeanError(graph, truth), 0.6) << "m";
}

TEST(Optimize, AChainStaysWhereItIs) {
  const std::vector<Pose2> truth = Rounds(5, 1);
  PoseGraph graph = NoisyRounds(truth, 100, 1.0, 3);
  const PoseGraph before = graph;
  const OptimizationSummary summary = Optimize({}, graph);
  EXPECT_TRUE(summary.converged);
  EXPECT_NEAR(summary.final_chi2, 0.0, 1e-12);
  for (std::size_t i = 0; i < truth.size(); ++i) {
    EXPECT_LT(Distance(graph.nodes()[i].T_world_robot, before.nodes()[i].T_world_robot), 1e-9)
        << "m";
  }
}

TEST(Optimize, EveryComponentKeepsItsFirstNode) {
  PoseGraph graph;
  graph.AddFloor({});
  for (int i = 0; i < 7; ++i) {
    Node node;
    node.T_world_robot = {10.0 * i, 3.0, 0.5};
    graph.AddNode(node);
  }
  const UncertainPose2 step{{1.0, 0.0, 0.1}, EdgeCovariance()};
  graph.AddEdge({0, 1, step, EdgeKind::kOdometry});
  graph.AddEdge({1, 2, step, EdgeKind::kOdometry});
  graph.AddEdge({4, 3, step, EdgeKind::kOdometry});
  graph.AddEdge({4, 5, step, EdgeKind::kOdometry});
  EXPECT_TRUE(Optimize({}, graph).converged);
  for (const NodeId fixed : {0, 3, 6}) {
    EXPECT_EQ(graph.nodes()[static_cast<std::size_t>(fixed)].T_world_robot.x, 10.0 * fixed) << "m";
  }
  for (const Edge& edge : graph.edges()) EXPECT_NEAR(EdgeChi2(graph, edge), 0.0, 1e-6);
}

TEST(Optimize, NothingToDo) {
  PoseGraph graph;
  EXPECT_TRUE(Optimize({}, graph).converged);
  graph.AddFloor({});
  graph.AddNode({});
  EXPECT_TRUE(Optimize({}, graph).converged);
  EXPECT_EQ(Optimize({}, graph).final_chi2, 0.0);
}

TEST(Optimize, RigidEdgesHold) {
  PoseGraph graph;
  graph.AddFloor({});
  for (int i = 0; i < 3; ++i) graph.AddNode({});
  graph.AddEdge({0, 1, {{1.0, 0.0, 0.0}, Eigen::Matrix3d::Zero()}, EdgeKind::kFloorChange});
  graph.AddEdge({1, 2, {{1.0, 0.0, 0.0}, EdgeCovariance()}, EdgeKind::kOdometry});
  graph.AddEdge({2, 0, {{-1.8, 0.0, 0.0}, EdgeCovariance()}, EdgeKind::kClosure});
  EXPECT_TRUE(Optimize({}, graph).converged);
  EXPECT_NEAR(graph.nodes()[1].T_world_robot.x, 1.0, 1e-4) << "m";
  EXPECT_NEAR(graph.nodes()[2].T_world_robot.x, 1.9, 1e-3) << "m";
}

TEST(Optimize, RepeatsBitForBitAndIsSilent) {
  const std::vector<Pose2> truth = Rounds(20, 4);
  PoseGraph first = NoisyRounds(truth, 20, 1.0, 7);
  PoseGraph second = first;
  testing::internal::CaptureStdout();
  testing::internal::CaptureStderr();
  Optimize({}, first);
  Optimize({}, second);
  EXPECT_EQ(testing::internal::GetCapturedStderr(), "");
  EXPECT_EQ(testing::internal::GetCapturedStdout(), "");
  for (std::size_t i = 0; i < truth.size(); ++i) {
    const Pose2& a = first.nodes()[i].T_world_robot;
    const Pose2& b = second.nodes()[i].T_world_robot;
    EXPECT_EQ(std::memcmp(&a, &b, sizeof(Pose2)), 0);
  }
}

double LargestDeviation(const PoseGraph& a, const PoseGraph& b) {
  double largest = 0.0;
  for (std::size_t i = 0; i < a.nodes().size(); ++i) {
    largest = std::max(largest, Distance(a.nodes()[i].T_world_robot, b.nodes()[i].T_world_robot));
  }
  return largest;
}

// Hands the edges of `whole` to an optimizer as mapping would: node by node, each where odometry
// puts it from the node before, closures as soon as both ends are there.
template <typename AfterUpdate>
PoseGraph Grow(const PoseGraph& whole, PoseGraphOptimizer& optimizer, AfterUpdate&& after_update) {
  PoseGraph graph;
  graph.AddFloor({});
  graph.AddNode(whole.nodes()[0]);
  for (NodeId id = 1; id < static_cast<NodeId>(whole.nodes().size()); ++id) {
    Node node = whole.nodes()[static_cast<std::size_t>(id)];
    std::vector<Edge> edges;
    for (const EdgeId edge_id : whole.EdgesOf(id)) {
      const Edge& edge = whole.edges()[static_cast<std::size_t>(edge_id)];
      if (std::max(edge.from, edge.to) != id) continue;
      edges.push_back(edge);
      if (edge.kind != EdgeKind::kOdometry) continue;
      node.T_world_robot = graph.nodes().back().T_world_robot * edge.T_from_to.mean;
    }
    graph.AddNode(node);
    for (const Edge& edge : edges) graph.AddEdge(edge);
    if (edges.size() > 1) after_update(optimizer.Update(graph), graph);
  }
  return graph;
}

TEST(PoseGraphOptimizer, StaysNearTheFullSolutionOfAGrowingGraph) {
  const std::vector<Pose2> truth = Rounds(25, 6);
  const PoseGraph whole = NoisyRounds(truth, 25, 1.0, 11);
  PoseGraphOptimizer optimizer({});
  int updates = 0;
  int moved = 0;
  const PoseGraph grown =
      Grow(whole, optimizer, [&](const OptimizationSummary& summary, const PoseGraph& graph) {
        moved += summary.iterations > 0 ? 1 : 0;
        EXPECT_TRUE(summary.converged);
        if (++updates % 20 != 0) return;
        PoseGraph solved = graph;
        Optimize({}, solved);
        EXPECT_LT(LargestDeviation(graph, solved), 0.15) << "m";
      });
  EXPECT_EQ(updates, 250);
  EXPECT_GT(moved, 20);
  EXPECT_EQ(grown.edges().size(), whole.edges().size());
}

TEST(PoseGraphOptimizer, WhatFitsMovesNothing) {
  const std::vector<Pose2> truth = Rounds(6, 2);
  PoseGraph graph = NoisyRounds(truth, 6, 0.0, 1);
  const PoseGraph before = graph;
  PoseGraphOptimizer optimizer({});
  EXPECT_EQ(optimizer.Update(graph).iterations, 0);
  EXPECT_EQ(LargestDeviation(graph, before), 0.0) << "m";
}

TEST(PoseGraphOptimizer, FarNodesStayWhenASmallLoopCloses) {
  // Sure rounds, then a new node beside them that a closure pulls by 0.2 m.
  const std::vector<Pose2> truth = Rounds(150, 3);
  PoseGraph graph = NoisyRounds(truth, 150, 0.5, 3);
  PoseGraphOptimizer optimizer({});
  Optimize({}, graph);
  optimizer.Update(graph);
  const PoseGraph before = graph;
  const auto last = static_cast<NodeId>(graph.nodes().size() - 1);
  Node node;
  node.T_world_robot = graph.nodes().back().T_world_robot * Pose2{1.2, 0.0, 0.0};
  const NodeId fresh = graph.AddNode(node);
  graph.AddEdge({last, fresh, {{1.2, 0.0, 0.0}, EdgeCovariance()}, EdgeKind::kOdometry});
  const Pose2 T_fresh_old = Between(node.T_world_robot, before.nodes()[1200].T_world_robot);
  graph.AddEdge(
      {fresh, 1200, {T_fresh_old * Pose2{0.2, 0.0, 0.0}, EdgeCovariance()}, EdgeKind::kClosure});
  EXPECT_GT(optimizer.Update(graph).iterations, 0);
  EXPECT_GT(Distance(graph.nodes().back().T_world_robot, node.T_world_robot), 0.05) << "m";
  int moved = 0;
  for (std::size_t i = 0; i < before.nodes().size(); ++i) {
    moved += Distance(graph.nodes()[i].T_world_robot, before.nodes()[i].T_world_robot) > 0 ? 1 : 0;
  }
  EXPECT_GT(moved, 10);
  EXPECT_LT(moved, 600) << "of " << before.nodes().size();
  PoseGraph solved = graph;
  Optimize({}, solved);
  EXPECT_LT(LargestDeviation(graph, solved), 0.05) << "m";
}

// One round whose end lies metres beside its beginning: no part of it can take that alone.
TEST(PoseGraphOptimizer, WhatIsFarOffHasTheWholeSolved) {
  PoseGraph graph = NoisyRounds(Rounds(150, 1), 150, 1.0, 5);
  const auto last = static_cast<NodeId>(graph.nodes().size() - 1);
  PoseGraphOptimizer optimizer({});
  optimizer.Update(graph);
  ASSERT_GT(Distance(graph.node(last).T_world_robot * Pose2{1.0, 0.0, 0.0}, {}), 1.0) << "m";
  graph.AddEdge({last, 0, {{1.0, 0.0, kPi / 2}, EdgeCovariance()}, EdgeKind::kClosure});
  PoseGraph solved = graph;
  optimizer.Update(graph);
  Optimize({}, solved);
  EXPECT_EQ(LargestDeviation(graph, solved), 0.0) << "m";
}

TEST(PoseGraphOptimizer, EdgesMayBeRemovedInBetween) {
  const std::vector<Pose2> truth = Rounds(6, 3);
  PoseGraph graph = NoisyRounds(truth, 6, 1.0, 4);
  PoseGraphOptimizer optimizer({});
  optimizer.Update(graph);
  graph.RemoveEdge(static_cast<EdgeId>(graph.edges().size()) - 1);
  Optimize({}, graph);
  optimizer.Update(graph);
  graph.AddEdge({3, 40, {{}, EdgeCovariance()}, EdgeKind::kClosure});
  EXPECT_GT(optimizer.Update(graph).iterations, 0);
}

TEST(PoseGraphOptimizer, OtherComponentsKeepTheirFirstNode) {
  PoseGraph graph;
  graph.AddFloor({});
  for (int i = 0; i < 8; ++i) {
    Node node;
    node.T_world_robot = {static_cast<double>(i), 0.0, 0.0};
    graph.AddNode(node);
  }
  const UncertainPose2 step{{1.0, 0.0, 0.0}, EdgeCovariance()};
  for (const NodeId i : {0, 1, 2, 4, 5, 6}) graph.AddEdge({i, i + 1, step, EdgeKind::kOdometry});
  PoseGraphOptimizer optimizer({});
  optimizer.Update(graph);
  graph.AddEdge({7, 4, {{-2.7, 0.0, 0.0}, EdgeCovariance()}, EdgeKind::kClosure});
  EXPECT_GT(optimizer.Update(graph).iterations, 0);
  EXPECT_EQ(graph.nodes()[4].T_world_robot.x, 4.0) << "m";
  EXPECT_NEAR(graph.nodes()[7].T_world_robot.x, 6.775, 0.002) << "m";
  EXPECT_EQ(graph.nodes()[3].T_world_robot.x, 3.0) << "m";
}

TEST(PoseGraphOptimizer, RepeatsBitForBit) {
  const PoseGraph whole = NoisyRounds(Rounds(10, 4), 10, 1.0, 12);
  const auto nothing = [](const OptimizationSummary&, const PoseGraph&) {};
  PoseGraphOptimizer first({});
  PoseGraphOptimizer second({});
  EXPECT_EQ(LargestDeviation(Grow(whole, first, nothing), Grow(whole, second, nothing)), 0.0);
}

struct PublicGraph {
  const char* file;
  double chi2;
};
void PrintTo(const PublicGraph& graph, std::ostream* out) { *out << graph.file; }

class PublicGraphs : public testing::TestWithParam<PublicGraph> {};

// The least chi^2 known for these graphs, reached here from the odometry they are published with.
TEST_P(PublicGraphs, AreSolvedToTheKnownChi2) {
  std::optional<PoseGraph> graph =
      ReadG2o(std::string(MASKED_MAPPER_REAL_LOGS) + "/g2o/" + GetParam().file);
  if (!graph) GTEST_SKIP() << "the public graph " << GetParam().file << " is not at hand";
  const OptimizationSummary summary = Optimize({}, *graph);
  EXPECT_TRUE(summary.converged);
  EXPECT_NEAR(summary.final_chi2, GetParam().chi2, 0.0005 * GetParam().chi2);
  EXPECT_LE(summary.iterations, 20);
}

INSTANTIATE_TEST_SUITE_P(Optimize, PublicGraphs,
                         testing::Values(PublicGraph{"M3500.g2o", 137.913},
                                         PublicGraph{"INTEL.g2o", 214.171},
                                         PublicGraph{"MITb.g2o", 39.601}),
                         [](const testing::TestParamInfo<PublicGraph>& info) {
                           const std::string file = info.param.file;
                           return file.substr(0, file.find('.'));
                         });

}  // namespace
}  // namespace masked_mapper
