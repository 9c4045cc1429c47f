// SPDX-License-Identifier: BSD-3-Clause
#include "masked_mapper/loop_closure/loop_closer.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <string>

#include "mapping/ring_logs.hpp"
#include "masked_mapper/editing/edits.hpp"
#include "masked_mapper/map/surroundings.hpp"

namespace masked_mapper {
namespace {

std::size_t CountClosures(const BuildingMap& map) {
  return static_cast<std::size_t>(
      std::count_if(map.graph.edges().begin(), map.graph.edges().end(),
                    [](const Edge& edge) { return edge.kind == EdgeKind::kClosure; }));
}

std::size_t CountBetween(const BuildingMap& map, NodeId a, NodeId b) {
  return static_cast<std::size_t>(
      std::count_if(map.graph.edges().begin(), map.graph.edges().end(), [&](const Edge& edge) {
        return edge.kind == EdgeKind::kClosure &&
               std::minmax(edge.from, edge.to) == std::minmax(a, b);
      }));
}

// A validated closure from the fourth node to the last, metres off; its id.
ClosureId PlantWrong(BuildingMap& map, ClosureReason reason) {
  Closure wrong;
  wrong.older = 3;
  wrong.newer = static_cast<NodeId>(map.graph.nodes().size() - 1);
  wrong.T_older_newer.mean = {-7.0, 3.0, -1.0};
  wrong.T_older_newer.covariance.diagonal() << 1e-4, 1e-4, 1e-5;
  wrong.state = ClosureState::kValidated;
  wrong.reason = reason;
  map.closures.push_back(wrong);
  const auto id = static_cast<ClosureId>(map.closures.size() - 1);
  AddClosureEdge(map.closures, id, map.graph);
  return id;
}

// Closures that are in a finished map are known by their attempts: one that is wrong is audited out
// by name.
TEST(LoopCloser, AuditsWhatWasThereBefore) {
  BuildingMap map = MapOf(First(), "closer.log");
  const std::size_t closures = CountClosures(map);
  ASSERT_GT(closures, 1U);
  PlantWrong(map, ClosureReason::kEnoughVotes);
  LoopClosureOptions options;
  LoopCloser closer(options, map);
  closer.Finish();
  EXPECT_GE(CountClosures(map), closures);
  EXPECT_EQ(map.closures.back().state, ClosureState::kAuditedOut);
  EXPECT_EQ(map.closures.back().reason, ClosureReason::kDisagreesWithTheMap);
}

TEST(LoopCloser, WhatWasAddedByHandIsNotAuditedOut) {
  BuildingMap map = MapOf(First(), "closer.log");
  const std::size_t place = static_cast<std::size_t>(PlantWrong(map, ClosureReason::kAddedByHand));
  LoopClosureOptions options;
  LoopCloser(options, map).Finish();
  EXPECT_EQ(map.closures[place].state, ClosureState::kValidated);
  EXPECT_EQ(CountBetween(map, map.closures[place].older, map.closures[place].newer), 1U);
}

// A pair that came to too few votes once more, and fits the map.
TEST(LoopCloser, WhatWasForbiddenByHandDoesNotEnterLate) {
  for (const bool forbidden : {false, true}) {
    BuildingMap map = MapOf(First(), "closer.log");
    const auto closed = std::find_if(
        map.closures.begin(), map.closures.end(),
        [](const Closure& closure) { return closure.state == ClosureState::kValidated; });
    ASSERT_NE(closed, map.closures.end());
    const NodeId older = closed->older;
    const NodeId newer = closed->newer;
    for (std::size_t i = map.graph.edges().size(); i-- > 0;) {
      const Edge& edge = map.graph.edges()[i];
      if (edge.from == older && edge.to == newer) map.graph.RemoveEdge(static_cast<EdgeId>(i));
    }
    Closure again = *closed;
    again.state = ClosureState::kHypothesis;
    again.reason = ClosureReason::kTooFewVotes;
    closed->state = ClosureState::kAuditedOut;
    closed->reason =
        forbidden ? ClosureReason::kForbiddenByHand : ClosureReason::kDisagreesWithTheMap;
    map.closures.push_back(again);
    LoopClosureOptions options;
    LoopCloser(options, map).Finish();
    EXPECT_EQ(CountBetween(map, older, newer), forbidden ? 0U : 1U);
  }
}

// Of a saved map nothing is sure: closures without an attempt, attempts that no closure may come
// of.
TEST(LoopCloser, TakesWhatDoesNotHoldTogether) {
  BuildingMap map = MapOf(First(), "closer.log");
  const auto last = static_cast<NodeId>(map.graph.nodes().size() - 1);
  UncertainPose2 wrong;
  wrong.mean = {7.0, -3.0, 1.0};
  wrong.covariance.diagonal() << 1e-2, 1e-2, 1e-3;
  const NodeId middle = last / 2;
  const EdgeId edge = map.graph.AddEdge({middle, 3, wrong, EdgeKind::kClosure});
  Closure open;
  open.older = open.newer = last;
  open.T_older_newer.covariance = wrong.covariance;
  open.state = ClosureState::kHypothesis;
  open.reason = ClosureReason::kTooFewVotes;
  map.closures.push_back(open);
  // On another floor, of a piece that has nothing to do with the first.
  const FloorId floor = map.graph.AddFloor({"other"});
  Node elsewhere = map.graph.nodes()[3];
  elsewhere.floor = floor;
  open.newer = map.graph.AddNode(elsewhere);
  open.older = 3;
  map.closures.push_back(open);
  LoopClosureOptions options;
  LoopCloser(options, map).Finish();
  EXPECT_EQ(map.closures.back().state, ClosureState::kHypothesis);
  const std::vector<Edge>& edges = map.graph.edges();
  EXPECT_TRUE(std::none_of(edges.begin(), edges.end(), [&](const Edge& other) {
    return other.from == middle && other.to == 3;
  })) << edge;
}

TEST(LoopCloser, MatchesAgainstTheReferenceThatItIsGiven) {
  BuildingMap map = MapOf(First(), "closer.log");
  LoopClosureOptions options;
  std::vector<NodeId> asked;
  LoopCloser closer(options, map, [&](NodeId node) {
    asked.push_back(node);
    return PointsAt(map, node, 0.0);
  });
  std::vector<NodeId> scan_nodes;
  for (std::size_t i = 0; i < map.graph.nodes().size(); ++i) {
    if (map.graph.nodes()[i].HasScan()) scan_nodes.push_back(static_cast<NodeId>(i));
  }
  const std::size_t closures = map.closures.size();
  Candidate candidate;
  candidate.node = scan_nodes.front();
  candidate.T_new_node.covariance.diagonal() << 0.01, 0.01, 0.001;
  closer.Close(scan_nodes.back(), {candidate});
  EXPECT_EQ(asked, std::vector<NodeId>{scan_nodes.front()});
  ASSERT_EQ(map.closures.size(), closures + 1);
  EXPECT_EQ(map.closures.back().newer, scan_nodes.back());
}

}  // namespace
}  // namespace masked_mapper
