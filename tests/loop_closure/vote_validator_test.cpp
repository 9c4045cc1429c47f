// SPDX-License-Identifier: BSD-3-Clause
#include "loop_closure/vote_validator.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>
#include <vector>

#include "judged_drive.hpp"

namespace masked_mapper {
namespace {

TEST(VoteValidator, ARevisitedCorridorIsClosed) {
  for (unsigned seed = 1; seed <= 20; ++seed) {
    Judging<VoteValidator> validator{ValidatorOptions()};
    const Count count = CountOfRevisit(seed, validator);
    EXPECT_EQ(count.wrong_validated, 0);
    EXPECT_GE(count.right_validated, 9) << "of " << count.right << ", seed " << seed;
  }
}

TEST(VoteValidator, ALoneMatchIsNotEnough) {
  Drive drive(0.02, 0.002, 1);
  const Revisit revisit = TwicePast(drive, 5, 20.0);
  Judging<VoteValidator> validator{ValidatorOptions()};
  // One way round alone, over odometry: at most one vote, right as the match may be.
  EXPECT_TRUE(drive.Judge(validator, {drive.Match(revisit.second[0], revisit.first[0])}).empty());
  EXPECT_LE(validator.closures()[0].votes, 1);
}

TEST(VoteValidator, VotesAreCountedOnBothSidesAndComeLater) {
  // Two rungs of a ladder: loops of each new rung with odometry, and with every rung before it.
  Drive drive(0.001, 0.0001, 2);
  const Revisit revisit = TwicePast(drive, 8, 20.0);
  ValidatorOptions options;
  options.votes_needed = 3;
  Judging<VoteValidator> validator(options);
  std::vector<int> newly_valid;
  for (std::size_t i = 0; i < 4; ++i) {
    newly_valid.push_back(static_cast<int>(
        drive.Judge(validator, {drive.Match(revisit.second[i], revisit.first[i])}).size()));
  }
  // The first has odometry alone. The second gives it a vote and gets one, and so on: the earliest
  // gets its last vote while a later one is judged.
  const std::vector<Closure>& all = validator.closures();
  EXPECT_TRUE(all[0].state == ClosureState::kValidated);
  EXPECT_EQ(newly_valid[0] + newly_valid[1], 0);
  EXPECT_GE(newly_valid[2], 1);
  EXPECT_GE(all[0].votes, 3);
}

TEST(VoteValidator, NothingToJudge) {
  Judging<VoteValidator> validator{ValidatorOptions()};
  PoseGraph graph;
  EXPECT_TRUE(validator.Judge(graph, {}).empty());
  graph.AddFloor({});
  graph.AddNode({});
  graph.AddNode({});
  Closure match;
  match.newer = 1;
  match.older = 0;
  match.T_older_newer.covariance = Eigen::Matrix3d::Identity();
  EXPECT_TRUE(validator.Judge(graph, {match}).empty());
  EXPECT_EQ(validator.closures()[0].votes, 0);
}

TEST(VoteValidatorDeathTest, EndsMustBeTwoNodesOfTheGraph) {
  Judging<VoteValidator> validator{ValidatorOptions()};
  PoseGraph graph;
  graph.AddFloor({});
  graph.AddNode({});
  Closure match;
  EXPECT_DEATH(validator.Judge(graph, {match}), "");
  match.newer = 3;
  EXPECT_DEATH(validator.Judge(graph, {match}), "");
}

}  // namespace
}  // namespace masked_mapper
