// SPDX-License-Identifier: BSD-3-Clause
// Closures, path lengths and floors on a square of 40 m, driven one and a half times.
#include "evaluation/closures.hpp"

#include <gtest/gtest.h>

#include "evaluation/floors.hpp"
#include "evaluation/path_length.hpp"

namespace masked_mapper {
namespace {

struct Drive {
  MappedGraph graph;
  std::vector<std::optional<StampedPose>> truth;
};

/// A node every 5 m; nodes i and i + 8 are the same place.
Drive SquareDrive() {
  Drive drive;
  for (std::size_t i = 0; i < 12; ++i) {
    const double along = 5.0 * static_cast<double>(i % 8);
    const int side = static_cast<int>(along / 10.0);
    const Pose2 T_world_corner[] = {{0, 0, 0}, {10, 0, kPi / 2}, {10, 10, kPi}, {0, 10, -kPi / 2}};
    const StampedPose node{static_cast<double>(i),
                           T_world_corner[side] * Pose2{along - 10.0 * side, 0, 0}, 0.0};
    drive.graph.nodes.push_back(node);
    drive.truth.emplace_back(node);
    if (i > 0) drive.graph.edges.push_back({i - 1, i});
  }
  return drive;
}

TEST(Closures, PrecisionAndRecallByHand) {
  const Drive drive = SquareDrive();
  const auto pairs = TrueRevisits(drive.graph.nodes, drive.truth);
  ASSERT_EQ(pairs.size(), 4U);  // 0-8, 1-9, 2-10, 3-11
  EXPECT_EQ(pairs[0], (std::pair<std::size_t, std::size_t>{0, 8}));
  const std::vector<ValidatedClosure> closures = {{8, 0, {0.1, 0, 0}}, {10, 0, {0.6, 0, 0}}};
  const ClosureError error = CheckClosures(drive.graph, closures, drive.truth, {0.5, 5.0});
  EXPECT_EQ(error.checked, 2U);
  ASSERT_EQ(error.false_closures.size(), 1U);
  EXPECT_EQ(error.false_closures[0].stamp_a, 10.0);
  EXPECT_EQ(*error.Precision(), 0.5);
  // 0-8 walks 0.1 m; 1-9 walks 10.1 m, which is too far.
  EXPECT_EQ(*error.Recall(), 0.25);
  RevisitOptions patient;
  patient.walk_m = 11.0;
  EXPECT_EQ(*CheckClosures(drive.graph, closures, drive.truth, {0.5, 5.0}, patient).Recall(), 0.5);
  const ClosureError none = CheckClosures({}, {}, {}, {0.5, 5.0});
  EXPECT_FALSE(none.Precision());
  EXPECT_FALSE(none.Recall());
}

TEST(Closures, OffByTheToleranceOfTheTruth) {
  const Drive drive = SquareDrive();
  const std::vector<ValidatedClosure> turned = {{8, 0, {0, 0, DegToRad(10.0)}}};
  Truth exact;
  exact.exact = true;
  EXPECT_EQ(
      CheckClosures(drive.graph, turned, drive.truth, ToleranceOf(exact)).false_closures.size(),
      1U);
  EXPECT_TRUE(
      CheckClosures(drive.graph, turned, drive.truth, ToleranceOf({})).false_closures.empty());
}

TEST(PathLength, MissingAndFalseAreToldApart) {
  Drive drive = SquareDrive();
  const ClosureTolerance tolerance{0.5, 5.0};
  const auto pairs =
      DrawStampPairs(drive.graph.nodes.front().stamp, drive.graph.nodes.back().stamp);
  const auto open = ComparePathLengths(drive.graph, drive.truth, pairs, tolerance);
  ASSERT_TRUE(open);
  EXPECT_GT(open->missing_m, 1.0);
  EXPECT_EQ(open->false_m, 0.0);
  EXPECT_NEAR(open->error_m.mean, open->missing_m + open->false_m, 1e-9);
  EXPECT_EQ(open->error_m.count, 999U);

  Drive closed = drive;
  for (std::size_t i = 0; i < 4; ++i) closed.graph.edges.push_back({i + 8, i});
  EXPECT_NEAR(ComparePathLengths(closed.graph, closed.truth, pairs, tolerance)->error_m.max, 0.0,
              1e-9);

  Drive folded = closed;  // a false closure pulls the far corner to the start
  folded.graph.nodes[4].T_world_robot = folded.graph.nodes[0].T_world_robot;
  folded.graph.edges.push_back({4, 0});
  EXPECT_GT(ComparePathLengths(folded.graph, folded.truth, pairs, tolerance)->false_m, 0.5);

  EXPECT_FALSE(ComparePathLengths({}, {}, pairs, tolerance));
}

TEST(Floors, RightUpToARenaming) {
  const std::vector<StampedPose> trajectory = {
      {0, {}, 0.0}, {1, {}, 0.1}, {2, {}, 1.5}, {3, {}, 3.5}, {4, {}, 0.0}};
  const std::vector<MappedFloor> floors = {{"0", 0.0}, {"1", 3.5}};
  const auto identity =
      CompareFloors(trajectory, floors, {{0.0, "1"}, {2.0, "-"}, {2.5, "2"}, {4.5, "1"}});
  ASSERT_TRUE(identity);
  EXPECT_EQ(identity->scans, 4U);
  EXPECT_EQ(identity->right, 3U);  // the last is on 2 and mapped on 0
  EXPECT_EQ(identity->same_label, 0U);
  EXPECT_EQ(identity->renaming.at("0"), "1");
  EXPECT_FALSE(CompareFloors(trajectory, {}, {{0.0, "1"}}));
}

}  // namespace
}  // namespace masked_mapper
