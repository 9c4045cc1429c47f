// SPDX-License-Identifier: BSD-3-Clause
#include "masked_mapper/evaluation/path_length.hpp"

#include <gtest/gtest.h>

namespace masked_mapper {
namespace {

// Out and home along a line, 60 nodes each way, a metre apart.
MappedGraph OutAndHome() {
  MappedGraph graph;
  for (int i = 0; i < 120; ++i) {
    StampedPose node;
    node.stamp = i;
    node.T_world_robot.x = i < 60 ? i : 119 - i;
    graph.nodes.push_back(node);
    if (i > 0)
      graph.edges.push_back({static_cast<std::size_t>(i - 1), static_cast<std::size_t>(i)});
  }
  return graph;
}

std::vector<std::optional<StampedPose>> TruthOf(const MappedGraph& graph) {
  return {graph.nodes.begin(), graph.nodes.end()};
}

TEST(PathLength, WithoutItsClosuresTheWayHomeIsTooLong) {
  MappedGraph graph = OutAndHome();
  const auto truth = TruthOf(graph);
  const auto open = ComparePathLengths(graph, truth, {});
  ASSERT_TRUE(open);
  EXPECT_GT(open->missing_m, 1.0) << "m";
  EXPECT_NEAR(open->missing_m + open->false_m, open->error_m.mean, 1e-9);
  for (std::size_t i = 0; i < 60; ++i) graph.edges.push_back({i, 119 - i});
  const auto closed = ComparePathLengths(graph, truth, {});
  ASSERT_TRUE(closed);
  EXPECT_LT(closed->error_m.mean, 0.1) << "m";
}

}  // namespace
}  // namespace masked_mapper
