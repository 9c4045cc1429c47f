// SPDX-License-Identifier: BSD-3-Clause
#include "masked_mapper/pose_graph/pose_graph.hpp"

#include <gtest/gtest.h>

#include <algorithm>

namespace masked_mapper {
namespace {

PoseGraph TwoFloors() {
  PoseGraph graph;
  graph.AddFloor({"0", 0.0, 0.0, true});
  graph.AddFloor({"1", 4.0, 0.1, false});
  for (const FloorId floor : {0, 0, 1, 1, 0}) {
    Node node;
    node.floor = floor;
    graph.AddNode(node);
  }
  graph.AddEdge({0, 1, {}, EdgeKind::kOdometry});
  graph.AddEdge({1, 2, {}, EdgeKind::kFloorChange});
  graph.AddEdge({2, 3, {}, EdgeKind::kOdometry});
  graph.AddEdge({3, 4, {}, EdgeKind::kFloorChange});
  graph.AddEdge({4, 0, {}, EdgeKind::kClosure});
  return graph;
}

TEST(PoseGraph, IdsArePlacesAndEdgesAreListedAtBothEnds) {
  const PoseGraph graph = TwoFloors();
  ASSERT_EQ(graph.nodes().size(), 5u);
  ASSERT_EQ(graph.edges().size(), 5u);
  EXPECT_EQ(graph.EdgesOf(0), (std::vector<EdgeId>{0, 4}));
  EXPECT_EQ(graph.EdgesOf(1), (std::vector<EdgeId>{0, 1}));
  EXPECT_EQ(graph.EdgesOf(4), (std::vector<EdgeId>{3, 4}));
}

TEST(PoseGraph, RemovingAnEdgeShiftsLaterIds) {
  PoseGraph graph = TwoFloors();
  graph.RemoveEdge(1);
  ASSERT_EQ(graph.edges().size(), 4u);
  EXPECT_EQ(graph.edges()[1].from, 2);
  EXPECT_EQ(graph.EdgesOf(1), (std::vector<EdgeId>{0}));
  EXPECT_EQ(graph.EdgesOf(2), (std::vector<EdgeId>{1}));
  EXPECT_EQ(graph.EdgesOf(0), (std::vector<EdgeId>{0, 3}));
  for (std::size_t i = 0; i < graph.edges().size(); ++i) {
    const auto id = static_cast<EdgeId>(i);
    for (const NodeId end : {graph.edges()[i].from, graph.edges()[i].to}) {
      const std::vector<EdgeId>& touching = graph.EdgesOf(end);
      EXPECT_EQ(std::count(touching.begin(), touching.end(), id), 1);
    }
  }
}

TEST(PoseGraph, FloorViewHoldsInnerEdgesOnly) {
  const PoseGraph graph = TwoFloors();
  const FloorGraph ground = FloorView(graph, 0);
  EXPECT_EQ(ground.nodes, (std::vector<NodeId>{0, 1, 4}));
  EXPECT_EQ(ground.edges, (std::vector<EdgeId>{0, 4}));
  const FloorGraph upper = FloorView(graph, 1);
  EXPECT_EQ(upper.nodes, (std::vector<NodeId>{2, 3}));
  EXPECT_EQ(upper.edges, (std::vector<EdgeId>{2}));
  EXPECT_TRUE(FloorView(graph, 7).nodes.empty());
}

TEST(PoseGraph, ElevationIsSet) {
  PoseGraph graph = TwoFloors();
  graph.SetElevation(1, 3.5, 0.05, true);
  EXPECT_EQ(graph.floors()[1].elevation, 3.5);
  EXPECT_EQ(graph.floors()[1].elevation_sigma, 0.05);
  EXPECT_TRUE(graph.floors()[1].elevation_measured);
}

TEST(PoseGraphDeathTest, WrongUseStops) {
  PoseGraph graph = TwoFloors();
  Node nowhere;
  nowhere.floor = 2;
  EXPECT_DEATH(graph.AddNode(nowhere), "");
  EXPECT_DEATH(graph.AddEdge({0, 5, {}, EdgeKind::kOdometry}), "");
  EXPECT_DEATH(graph.AddEdge({-1, 0, {}, EdgeKind::kOdometry}), "");
  EXPECT_DEATH(graph.AddEdge({2, 2, {}, EdgeKind::kOdometry}), "");
  EXPECT_DEATH(graph.AddEdge({1, 2, {}, EdgeKind::kClosure}), "");
  EXPECT_DEATH(graph.RemoveEdge(5), "");
}

}  // namespace
}  // namespace masked_mapper
