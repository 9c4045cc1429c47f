// SPDX-License-Identifier: BSD-3-Clause
#include "masked_mapper/loop_closure/loop_closer.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <string>

#include "mapping/ring_logs.hpp"
#include "masked_mapper/editing/edits.hpp"

namespace masked_mapper {
namespace {

std::size_t CountClosures(const MappingResult& map) {
  return static_cast<std::size_t>(
      std::count_if(map.graph.edges().begin(), map.graph.edges().end(),
                    [](const Edge& edge) { return edge.kind == EdgeKind::kClosure; }));
}

std::size_t CountBetween(const MappingResult& map, NodeId a, NodeId b) {
  return static_cast<std::size_t>(
      std::count_if(map.graph.edges().begin(), map.graph.edges().end(), [&](const Edge& edge) {
        return edge.kind == EdgeKind::kClosure &&
               std::minmax(edge.from, edge.to) == std::minmax(a, b);
      }));
}

// A validated closure from the last node to the fourth, metres off; the place of its attempt.
std::size_t PlantWrong(MappingResult& map, const std::string& reason) {
  ClosureAttempt wrong;
  wrong.a = static_cast<NodeId>(map.graph.nodes().size() - 1);
  wrong.b = 3;
  wrong.T_a_b.mean = {7.0, -3.0, 1.0};
  wrong.T_a_b.covariance.diagonal() << 1e-4, 1e-4, 1e-5;
  wrong.state = ClosureState::kValidated;
  wrong.reason = reason;
  map.attempts.push_back(wrong);
  map.graph.AddEdge({wrong.a, wrong.b, wrong.T_a_b, EdgeKind::kClosure});
  return map.attempts.size() - 1;
}

// Closures that are in a finished map are known by their attempts: one that is wrong is audited out
// by name.
TEST(LoopCloser, AuditsWhatWasThereBefore) {
  MappingResult map = MapOf(First(), "closer.log");
  const std::size_t closures = CountClosures(map);
  ASSERT_GT(closures, 1U);
  PlantWrong(map, "");
  LoopClosureOptions options;
  LoopCloser closer(options, map);
  closer.Finish();
  EXPECT_GE(CountClosures(map), closures);
  EXPECT_EQ(map.attempts.back().state, ClosureState::kAuditedOut);
  EXPECT_EQ(map.attempts.back().reason, "disagrees with the optimised map");
}

TEST(LoopCloser, WhatWasAddedByHandIsNotAuditedOut) {
  MappingResult map = MapOf(First(), "closer.log");
  const std::size_t place = PlantWrong(map, kAddedByHand);
  LoopClosureOptions options;
  LoopCloser(options, map).Finish();
  EXPECT_EQ(map.attempts[place].state, ClosureState::kValidated);
  EXPECT_EQ(CountBetween(map, map.attempts[place].a, map.attempts[place].b), 1U);
}

// A pair that came to too few votes once more, and fits the map.
TEST(LoopCloser, WhatWasForbiddenByHandDoesNotEnterLate) {
  for (const bool forbidden : {false, true}) {
    MappingResult map = MapOf(First(), "closer.log");
    const auto closed = std::find_if(
        map.attempts.begin(), map.attempts.end(),
        [](const ClosureAttempt& attempt) { return attempt.state == ClosureState::kValidated; });
    ASSERT_NE(closed, map.attempts.end());
    const NodeId a = closed->a;
    const NodeId b = closed->b;
    for (std::size_t i = map.graph.edges().size(); i-- > 0;) {
      const Edge& edge = map.graph.edges()[i];
      if (edge.from == a && edge.to == b) map.graph.RemoveEdge(static_cast<EdgeId>(i));
    }
    ClosureAttempt again = *closed;
    again.state = ClosureState::kHypothesis;
    again.reason = "too few votes";
    closed->state = ClosureState::kAuditedOut;
    closed->reason = forbidden ? kForbiddenByHand : "disagrees with the optimised map";
    map.attempts.push_back(again);
    LoopClosureOptions options;
    LoopCloser(options, map).Finish();
    EXPECT_EQ(CountBetween(map, a, b), forbidden ? 0U : 1U);
  }
}

// Of a saved map nothing is sure: closures without an attempt, attempts that no closure may come
// of.
TEST(LoopCloser, TakesWhatDoesNotHoldTogether) {
  MappingResult map = MapOf(First(), "closer.log");
  const auto last = static_cast<NodeId>(map.graph.nodes().size() - 1);
  UncertainPose2 wrong;
  wrong.mean = {7.0, -3.0, 1.0};
  wrong.covariance.diagonal() << 1e-2, 1e-2, 1e-3;
  const NodeId middle = last / 2;
  const EdgeId edge = map.graph.AddEdge({middle, 3, wrong, EdgeKind::kClosure});
  ClosureAttempt open;
  open.a = open.b = last;
  open.T_a_b.covariance = wrong.covariance;
  open.state = ClosureState::kHypothesis;
  open.reason = "too few votes";
  map.attempts.push_back(open);
  // On another floor, of a piece that has nothing to do with the first.
  const FloorId floor = map.graph.AddFloor({"other"});
  Node elsewhere = map.graph.nodes()[3];
  elsewhere.floor = floor;
  open.a = map.graph.AddNode(elsewhere);
  open.b = 3;
  map.attempts.push_back(open);
  LoopClosureOptions options;
  LoopCloser(options, map).Finish();
  EXPECT_EQ(map.attempts.back().state, ClosureState::kHypothesis);
  const std::vector<Edge>& edges = map.graph.edges();
  EXPECT_TRUE(std::none_of(edges.begin(), edges.end(), [&](const Edge& other) {
    return other.from == middle && other.to == 3;
  })) << edge;
}

TEST(LoopCloser, MatchesAgainstTheReferenceThatItIsGiven) {
  MappingResult map = MapOf(First(), "closer.log");
  LoopClosureOptions options;
  std::vector<NodeId> asked;
  LoopCloser closer(options, map, [&](NodeId node) {
    asked.push_back(node);
    return map.graph.nodes()[static_cast<std::size_t>(node)].points_in_robot;
  });
  std::vector<NodeId> scan_nodes;
  for (std::size_t i = 0; i < map.graph.nodes().size(); ++i) {
    if (map.graph.nodes()[i].HasScan()) scan_nodes.push_back(static_cast<NodeId>(i));
  }
  const std::size_t attempts = map.attempts.size();
  Candidate candidate;
  candidate.node = scan_nodes.front();
  candidate.T_new_node.covariance.diagonal() << 0.01, 0.01, 0.001;
  closer.Close(scan_nodes.back(), {candidate});
  EXPECT_EQ(asked, std::vector<NodeId>{scan_nodes.front()});
  ASSERT_EQ(map.attempts.size(), attempts + 1);
  EXPECT_EQ(map.attempts.back().a, scan_nodes.back());
}

}  // namespace
}  // namespace masked_mapper
