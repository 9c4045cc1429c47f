// SPDX-License-Identifier: BSD-3-Clause
#include "masked_mapper/map/closure.hpp"

#include <gtest/gtest.h>

namespace masked_mapper {
namespace {

TEST(Closure, NamesReadBack) {
  for (int i = 0; i < 4; ++i) {
    const auto state = static_cast<ClosureState>(i);
    EXPECT_EQ(ClosureStateOf(Name(state)), state);
  }
  for (int i = 0; i <= static_cast<int>(ClosureReason::kForbiddenByHand); ++i) {
    const auto reason = static_cast<ClosureReason>(i);
    EXPECT_EQ(ClosureReasonOf(Name(reason)), reason) << Name(reason);
  }
  EXPECT_FALSE(ClosureStateOf("sure"));
  EXPECT_FALSE(ClosureReasonOf(""));
}

TEST(Closure, ItsEdgeNamesIt) {
  PoseGraph graph;
  graph.AddFloor({});
  graph.AddNode({});
  graph.AddNode({});
  std::vector<Closure> closures(2);
  closures[1].newer = 1;
  closures[1].T_older_newer.mean = {1.0, 2.0, 0.5};
  const EdgeId edge = AddClosureEdge(closures, 1, graph);
  EXPECT_EQ(graph.edge(edge).closure, 1);
  EXPECT_EQ(graph.edge(edge).from, 0);
  EXPECT_EQ(graph.edge(edge).to, 1);
  EXPECT_EQ(graph.edge(edge).kind, EdgeKind::kClosure);
  EXPECT_EQ(graph.edge(edge).T_from_to.mean.y, 2.0);
}

}  // namespace
}  // namespace masked_mapper
