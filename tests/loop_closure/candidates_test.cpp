// SPDX-License-Identifier: BSD-3-Clause
#include "masked_mapper/loop_closure/loop_closer.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <random>
#include <vector>

namespace masked_mapper {
namespace {

NodeId AddScanNode(PoseGraph& graph, const Pose2& T_world_robot, FloorId floor = 0) {
  Node node;
  node.floor = floor;
  node.T_world_robot = T_world_robot;
  node.scan = 0;
  return graph.AddNode(node);
}

// A chain of nodes along x, one metre apart, with poses that odometry has exactly.
PoseGraph Corridor(int nodes, const Eigen::Matrix3d& covariance) {
  PoseGraph graph;
  graph.AddFloor({});
  for (int i = 0; i < nodes; ++i) AddScanNode(graph, {static_cast<double>(i), 0.0, 0.0});
  for (NodeId i = 0; i + 1 < nodes; ++i) {
    graph.AddEdge({i, i + 1, {{1.0, 0.0, 0.0}, covariance}, EdgeKind::kOdometry});
  }
  return graph;
}

TEST(Candidates, DistanceIsEquation7InTheFrameOfTheNewNode) {
  const Eigen::Matrix3d covariance = Eigen::Vector3d(4.0, 0.01, 0.0).asDiagonal();
  PoseGraph graph;
  graph.AddFloor({});
  AddScanNode(graph, {10.0, 5.0, kPi / 2});
  AddScanNode(graph, {10.0, 8.0, 1.0});
  // As odometry has it the old node lies elsewhere; only the map counts for the displacement.
  graph.AddEdge({0, 1, {{7.0, 7.0, 0.0}, covariance}, EdgeKind::kOdometry});
  const auto candidates = FindCandidates(graph, 0, DijkstraProjection(graph, 0), {});
  ASSERT_EQ(candidates.size(), 1u);
  EXPECT_EQ(candidates[0].node, 1);
  EXPECT_NEAR(candidates[0].T_new_node.mean.x, 3.0, 1e-12) << "m";
  EXPECT_NEAR(candidates[0].T_new_node.mean.y, 0.0, 1e-12) << "m";
  EXPECT_NEAR(candidates[0].mahalanobis, 3.0 / std::sqrt(4.0 + 2.0 * 2.0), 1e-12);
}

TEST(Candidates, NearestFirstBelowMaxMahaAtMostMaxMatches) {
  const PoseGraph graph = Corridor(30, Eigen::Vector3d(1e-6, 1e-6, 1e-9).asDiagonal());
  const auto projection = DijkstraProjection(graph, 15);
  CandidateOptions options;
  options.max_matches = 100;
  options.max_mahalanobis = 4.9;
  const auto all = FindCandidates(graph, 15, projection, options);
  // R = 2 m and no other uncertainty to speak of: below 4.9 means nearer than 9.8 m, both ways.
  ASSERT_EQ(all.size(), 18u);
  for (std::size_t i = 1; i < all.size(); ++i) {
    EXPECT_LE(all[i - 1].mahalanobis, all[i].mahalanobis);
  }
  for (const Candidate& candidate : all) EXPECT_LT(candidate.mahalanobis, 4.9);
  options.max_matches = 5;
  const auto few = FindCandidates(graph, 15, projection, options);
  ASSERT_EQ(few.size(), 5u);
  for (std::size_t i = 0; i < few.size(); ++i) EXPECT_EQ(few[i].node, all[i].node);
  options.max_matches = 0;
  EXPECT_TRUE(FindCandidates(graph, 15, projection, options).empty());
}

TEST(Candidates, TiesGoToTheOlderNode) {
  PoseGraph graph;
  graph.AddFloor({});
  for (int i = 0; i < 4; ++i) AddScanNode(graph, {0.0, 0.0, 0.0});
  for (const NodeId from : {2, 0, 1}) {
    graph.AddEdge({from, 3, {{}, Eigen::Matrix3d::Identity()}, EdgeKind::kOdometry});
  }
  const auto candidates = FindCandidates(graph, 3, DijkstraProjection(graph, 3), {});
  ASSERT_EQ(candidates.size(), 3u);
  for (std::size_t i = 0; i < 3; ++i) EXPECT_EQ(candidates[i].node, static_cast<NodeId>(i));
}

TEST(Candidates, OtherFloorsAndNodesWithoutAScanAreNeverOffered) {
  PoseGraph graph;
  graph.AddFloor({"0", 0.0, 0.0, true});
  graph.AddFloor({"1", 4.0, 0.0, true});
  AddScanNode(graph, {});
  AddScanNode(graph, {}, 1);
  graph.AddNode({});
  AddScanNode(graph, {});
  const UncertainPose2 still{{}, 0.01 * Eigen::Matrix3d::Identity()};
  graph.AddEdge({0, 1, still, EdgeKind::kFloorChange});
  graph.AddEdge({1, 2, still, EdgeKind::kFloorChange});
  graph.AddEdge({2, 3, still, EdgeKind::kOdometry});
  const auto candidates = FindCandidates(graph, 3, DijkstraProjection(graph, 3), {});
  ASSERT_EQ(candidates.size(), 1u);
  EXPECT_EQ(candidates[0].node, 0);
}

// A drive round two rooms again and again, on two floors, whose loops close by and by.
TEST(Candidates, SearchedFromNodeToNodeAreThoseOfTheWholeProjection) {
  std::mt19937 random(11);
  std::normal_distribution<double> normal;
  PoseGraph graph;
  graph.AddFloor({});
  graph.AddFloor({});
  CandidateSearch search;
  CandidateOptions options;
  std::size_t found = 0;
  std::vector<Pose2> truths;
  for (int i = 0; i < 400; ++i) {
    const double turn = 0.13 * i;
    const bool is_far_room = i / 100 % 2 == 1;
    const Pose2 truth{12.0 * std::cos(turn) + (is_far_room ? 40.0 : 0.0), 8.0 * std::sin(turn),
                      WrapAngle(turn)};
    const Pose2 seen = truth * Pose2{0.1 * normal(random), 0.1 * normal(random), 0.0};
    const NodeId node = AddScanNode(graph, seen, i / 200);
    truths.push_back(truth);
    if (node > 0) {
      const Eigen::Vector3d sigma(0.05, 0.05, 0.01);
      graph.AddEdge({node - 1,
                     node,
                     {Between(truths[static_cast<std::size_t>(node) - 1], truth),
                      sigma.cwiseAbs2().asDiagonal()},
                     EdgeKind::kOdometry});
    }
    if (i % 3 == 2) continue;  // a mask leaves some out
    const auto expected = FindCandidates(graph, node, DijkstraProjection(graph, node), options);
    const auto candidates = search.Of(graph, node, options);
    ASSERT_EQ(candidates.size(), expected.size()) << i;
    for (std::size_t c = 0; c < candidates.size(); ++c) {
      EXPECT_EQ(candidates[c].node, expected[c].node) << i;
      EXPECT_NEAR(candidates[c].mahalanobis, expected[c].mahalanobis, 1e-9);
      EXPECT_TRUE(candidates[c].T_new_node.covariance.isApprox(expected[c].T_new_node.covariance));
    }
    found += candidates.size();
    if (i % 5 != 0 || candidates.size() < 5) continue;
    const NodeId older = candidates.back().node;
    graph.AddEdge({older,
                   node,
                   {Between(truths[static_cast<std::size_t>(older)], truth),
                    Eigen::Vector3d(0.0004, 0.0004, 0.0001).asDiagonal()},
                   EdgeKind::kClosure});
  }
  EXPECT_GT(found, 1000U);
  // Of a graph that is whole, one node after the other, and as the last poses have it.
  CandidateSearch afresh;
  for (NodeId node = 0; node < static_cast<NodeId>(graph.nodes().size()); node += 7) {
    const auto expected = FindCandidates(graph, node, DijkstraProjection(graph, node), options);
    const auto candidates = afresh.Of(graph, node, options);
    ASSERT_EQ(candidates.size(), expected.size()) << node;
    for (std::size_t c = 0; c < candidates.size(); ++c) {
      EXPECT_EQ(candidates[c].node, expected[c].node) << node;
    }
  }
}

}  // namespace
}  // namespace masked_mapper
