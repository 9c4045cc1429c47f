// SPDX-License-Identifier: BSD-3-Clause
#include "masked_mapper/optimization/pose_graph_optimizer.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>
#include <vector>

namespace masked_mapper {
namespace {

// Rounds of a square block, a node every 2 m, with odometry and closures between rounds whose
// errors are as their covariances say.
class Block {
 public:
  Block(int side, int rounds, unsigned seed) : random_(seed) {
    graph_.AddFloor({});
    const int around = 4 * side;
    for (int i = 0; i < around * rounds; ++i) {
      truth_.push_back(i == 0 ? Pose2{}
                              : truth_.back() * Pose2{2.0, 0.0, i % side == 0 ? kPi / 2 : 0.0});
      Node node;
      Edge edge;
      if (i > 0) {
        edge = {i - 1, i, Measured(i - 1, i, {0.04, 0.02, 0.01}), EdgeKind::kOdometry};
        node.T_world_robot = graph_.nodes().back().T_world_robot * edge.T_from_to.mean;
      }
      graph_.AddNode(node);
      if (i > 0) graph_.AddEdge(edge);
    }
    for (NodeId i = around; i < static_cast<NodeId>(truth_.size()); i += 3) Close(i, i - around);
  }

  void Close(NodeId a, NodeId b, const Pose2& error = {}) {
    UncertainPose2 T_a_b = Measured(a, b, {0.03, 0.03, 0.006});
    T_a_b.mean = error * T_a_b.mean;
    graph_.AddEdge({a, b, T_a_b, EdgeKind::kClosure});
  }

  // Plants a closure that says that b is where it is not.
  void Plant(NodeId a, NodeId b, const Pose2& error) {
    planted_.push_back(static_cast<EdgeId>(graph_.edges().size()));
    Close(a, b, error);
  }

  // A wheel that slipped: an odometry edge far worse than it says.
  void Slip(EdgeId at, const Pose2& error) {
    PoseGraph slipped;
    slipped.AddFloor({});
    for (const Node& node : graph_.nodes()) slipped.AddNode(node);
    for (std::size_t i = 0; i < graph_.edges().size(); ++i) {
      Edge edge = graph_.edges()[i];
      if (static_cast<EdgeId>(i) == at) edge.T_from_to.mean = edge.T_from_to.mean * error;
      slipped.AddEdge(edge);
    }
    graph_ = slipped;
  }

  double MeanError() const {
    double sum = 0.0;
    for (std::size_t i = 0; i < truth_.size(); ++i) {
      sum += Distance(graph_.nodes()[i].T_world_robot, truth_[i]);
    }
    return sum / static_cast<double>(truth_.size());
  }

  PoseGraph& graph() { return graph_; }
  const std::vector<EdgeId>& planted() const { return planted_; }
  std::mt19937& random() { return random_; }
  NodeId nodes() const { return static_cast<NodeId>(truth_.size()); }

 private:
  UncertainPose2 Measured(NodeId a, NodeId b, const Eigen::Vector3d& sigma) {
    std::normal_distribution<double> normal;
    Pose2 T = Between(truth_[static_cast<std::size_t>(a)], truth_[static_cast<std::size_t>(b)]);
    T.x += sigma.x() * normal(random_);
    T.y += sigma.y() * normal(random_);
    T.theta = WrapAngle(T.theta + sigma.z() * normal(random_));
    return {T, sigma.cwiseAbs2().asDiagonal()};
  }

  std::mt19937 random_;
  std::vector<Pose2> truth_;
  PoseGraph graph_;
  std::vector<EdgeId> planted_;
};

TEST(AuditClosures, RightClosuresAllStay) {
  for (unsigned seed = 1; seed <= 10; ++seed) {
    Block block(10, 3, seed);
    EXPECT_TRUE(AuditClosures({}, {}, block.graph()).empty()) << "seed " << seed;
    EXPECT_LT(block.MeanError(), 1.0) << "m";
  }
}

TEST(AuditClosures, PlantedWrongOnesGoAndAllRightOnesStay) {
  for (unsigned seed = 1; seed <= 15; ++seed) {
    Block block(10, 3, seed);
    std::uniform_int_distribution<NodeId> any(0, block.nodes() - 1);
    std::uniform_real_distribution<double> unit(-1.0, 1.0);
    for (int i = 0; i < 12; ++i) {
      const NodeId a = any(block.random());
      const NodeId b = any(block.random());
      if (std::abs(a - b) < 10) continue;
      block.Plant(a, b,
                  {2.0 + 4.0 * std::abs(unit(block.random())), 3.0 * unit(block.random()),
                   0.5 * unit(block.random())});
    }
    ASSERT_GE(block.planted().size(), 6u);
    EXPECT_EQ(AuditClosures({}, {}, block.graph()), block.planted()) << "seed " << seed;
    EXPECT_LT(block.MeanError(), 1.0) << "m";
  }
}

TEST(AuditClosures, AGroupThatAgreesWithItselfGoesToo) {
  // One side of the block taken for its neighbour, by six closures in a row.
  for (unsigned seed = 1; seed <= 10; ++seed) {
    Block block(10, 4, seed);
    for (NodeId i = 0; i < 6; ++i) block.Plant(122 + i, 42 + i, {0.0, 4.0, 0.0});
    EXPECT_EQ(AuditClosures({}, {}, block.graph()), block.planted()) << "seed " << seed;
  }
}

TEST(AuditClosures, ASlippedWheelDoesNotCostTheClosuresAcrossIt) {
  for (unsigned seed = 1; seed <= 10; ++seed) {
    Block block(10, 4, seed);
    block.Slip(60, {1.0, 0.3, DegToRad(20.0)});
    EXPECT_EQ(AuditClosures({}, {}, block.graph()), std::vector<EdgeId>()) << "seed " << seed;
    EXPECT_LT(block.MeanError(), 1.0) << "m";
  }
}

TEST(AuditClosures, ImpreciseIsNotWrong) {
  Block block(10, 3, 1);
  block.Close(100, 20, {0.2, -0.2, DegToRad(2.0)});
  EXPECT_TRUE(AuditClosures({}, {}, block.graph()).empty());
}

TEST(AuditClosures, TheEdgesAreLeftToTheCallerAndThePosesAreSolvedWithoutThem) {
  Block block(10, 3, 2);
  block.Plant(100, 25, {5.0, 1.0, 0.2});
  const std::size_t edges = block.graph().edges().size();
  const std::vector<EdgeId> wrong = AuditClosures({}, {}, block.graph());
  ASSERT_EQ(wrong, block.planted());
  EXPECT_EQ(block.graph().edges().size(), edges);
  PoseGraph without = block.graph();
  without.RemoveEdge(wrong[0]);
  Optimize({}, without);
  for (std::size_t i = 0; i < without.nodes().size(); ++i) {
    EXPECT_LT(Distance(without.nodes()[i].T_world_robot, block.graph().nodes()[i].T_world_robot),
              1e-2)
        << "m";
  }
}

TEST(AuditClosures, WhatIsTrustedStays) {
  Block block(10, 3, 2);
  block.Plant(100, 25, {5.0, 1.0, 0.2});
  block.Plant(60, 12, {-6.0, 2.0, 0.1});
  ASSERT_EQ(AuditClosures({}, {}, block.graph()), block.planted());
  const EdgeId trusted = block.planted().back();
  const std::vector<EdgeId> wrong = AuditClosures({}, {}, block.graph(), {trusted});
  EXPECT_EQ(std::count(wrong.begin(), wrong.end(), trusted), 0);
  EXPECT_EQ(std::count(wrong.begin(), wrong.end(), block.planted().front()), 1);
}

TEST(AuditClosures, NothingToAudit) {
  PoseGraph graph;
  EXPECT_TRUE(AuditClosures({}, {}, graph).empty());
  Block block(5, 1, 1);
  EXPECT_TRUE(AuditClosures({}, {}, block.graph()).empty());
}

}  // namespace
}  // namespace masked_mapper
