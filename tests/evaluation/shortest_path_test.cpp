// SPDX-License-Identifier: BSD-3-Clause
#include "evaluation/shortest_path.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>

namespace masked_mapper {
namespace {

// Against Bellman and Ford, which looks at every edge again and again.
TEST(LengthGraph, IsAsShortAsRepeatedRelaxationFinds) {
  std::mt19937 random(3);
  for (int trial = 0; trial < 30; ++trial) {
    const std::size_t nodes = 2 + random() % 12;
    struct Edge {
      std::size_t a, b;
      double length;
    };
    std::vector<Edge> edges;
    LengthGraph graph(nodes);
    for (std::size_t i = 0; i < nodes + random() % 10; ++i) {
      edges.push_back(
          {random() % nodes, random() % nodes, 0.1 * static_cast<double>(random() % 90)});
      graph.AddEdge(edges.back().a, edges.back().b, edges.back().length);
    }
    std::vector<double> naive(nodes, std::numeric_limits<double>::infinity());
    naive[0] = 0.5;
    for (std::size_t round = 0; round < nodes; ++round) {
      for (const Edge& edge : edges) {
        naive[edge.b] = std::min(naive[edge.b], naive[edge.a] + edge.length);
        naive[edge.a] = std::min(naive[edge.a], naive[edge.b] + edge.length);
      }
    }
    const std::vector<double> lengths = graph.LengthsFrom({{0, 0.5}});
    for (std::size_t i = 0; i < nodes; ++i) {
      if (std::isinf(naive[i])) {
        EXPECT_TRUE(std::isinf(lengths[i]));
      } else {
        EXPECT_NEAR(lengths[i], naive[i], 1e-9) << "m";
      }
    }
  }
}

}  // namespace
}  // namespace masked_mapper
