// SPDX-License-Identifier: BSD-3-Clause
#include "masked_mapper/optimization/pose_graph_optimizer.hpp"

#include <gtest/gtest.h>

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

struct PublicGraph {
  const char* file;
  double chi2;
};

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
