// SPDX-License-Identifier: BSD-3-Clause
#include "evaluation/path_length.hpp"

#include <gtest/gtest.h>

#include <algorithm>

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
  const auto pairs = DrawStampPairs(0.0, 119.0);
  const auto open = ComparePathLengths(graph, truth, pairs, {});
  ASSERT_TRUE(open);
  EXPECT_GT(open->missing_m, 1.0) << "m";
  EXPECT_NEAR(open->missing_m + open->false_m, open->error_m.mean, 1e-9);
  for (std::size_t i = 0; i < 60; ++i) graph.edges.push_back({i, 119 - i});
  const auto closed = ComparePathLengths(graph, truth, pairs, {});
  ASSERT_TRUE(closed);
  EXPECT_LT(closed->error_m.mean, 0.1) << "m";
}

TEST(PathLength, PairsAreThoseOfTheLogWhateverTheMapsNodes) {
  MappedGraph graph = OutAndHome();
  const auto pairs = DrawStampPairs(0.0, 125.0);  // the log goes on beyond the last node
  ASSERT_EQ(pairs.size(), 999U);
  bool beyond = false;
  for (const StampPair& pair : pairs) {
    EXPECT_GE(std::min(pair.from, pair.to), 0.0);
    EXPECT_LE(std::max(pair.from, pair.to), 125.0);
    beyond = beyond || pair.from > 119.0;
  }
  EXPECT_TRUE(beyond);
  const auto error = CompareWithCheckedMaps(graph, {graph}, pairs);
  ASSERT_TRUE(error);
  EXPECT_EQ(error->error_m.max, 0.0);
}

TEST(PathLength, TheShortestOfTheCheckedMapsIsTheTruth) {
  const MappedGraph open = OutAndHome();
  MappedGraph closed = open;
  for (std::size_t i = 0; i < 60; ++i) closed.edges.push_back({i, 119 - i});
  const std::vector<StampPair> pairs = {
      {10.5, 108.5}, {0.0, 119.0}, {3.0, 7.0}};  // along the drive
  const auto missing = CompareWithCheckedMaps(open, {open, closed}, pairs);
  ASSERT_TRUE(missing);
  // Open 97 m and 118 m; closed one metre, through the nearest node, and nothing.
  EXPECT_NEAR(missing->missing_m, (96.0 + 118.0) / 3.0, 1e-9) << "m";
  EXPECT_EQ(missing->false_m, 0.0);
  const auto false_closures = CompareWithCheckedMaps(closed, {open}, pairs);
  ASSERT_TRUE(false_closures);
  EXPECT_NEAR(false_closures->false_m, (96.0 + 118.0) / 3.0, 1e-9) << "m";
  EXPECT_FALSE(CompareWithCheckedMaps(open, {}, pairs));
  EXPECT_FALSE(CompareWithCheckedMaps(MappedGraph{}, {open}, pairs));
}

}  // namespace
}  // namespace masked_mapper
