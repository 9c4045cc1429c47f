// SPDX-License-Identifier: BSD-3-Clause
#include "loop_closure/evidence_validator.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <iostream>
#include <limits>
#include <random>
#include <utility>
#include <vector>

#include "judged_drive.hpp"
#include "loop_closure/loop_evidence.hpp"
#include "loop_closure/vote_validator.hpp"

namespace masked_mapper {
namespace {

TEST(EvidenceValidator, ARevisitedCorridorIsClosed) {
  for (unsigned seed = 1; seed <= 20; ++seed) {
    Judging<EvidenceValidator> validator;
    const Count count = CountOfRevisit(seed, validator);
    EXPECT_EQ(count.wrong_validated, 0);
    EXPECT_GE(count.right_validated, 9) << "of " << count.right << ", seed " << seed;
  }
}

TEST(EvidenceValidator, ALoneMatchIsNotEnoughWhereTheWayIsUnsure) {
  Drive drive(0.3, 0.03, 1);
  const Revisit revisit = TwicePast(drive, 5, 20.0);
  Judging<EvidenceValidator> validator;
  EXPECT_TRUE(drive.Judge(validator, {drive.Match(revisit.second[0], revisit.first[0])}).empty());
  EXPECT_LE(validator.closures()[0].votes, 1);
}

TEST(EvidenceValidator, ALoneMatchThatASureWayConfirmsIsEnough) {
  // A corner passed twice, two nodes after a place that is closed already.
  int ours_takes_it = 0;
  for (unsigned seed = 1; seed <= 20; ++seed) {
    Drive drive(0.01, 0.0005, seed);
    const Revisit revisit = TwicePast(drive, 10, 40.0);
    PoseGraph graph = drive.graph();
    const Closure known = drive.Match(revisit.second[7], revisit.first[7]);
    graph.AddEdge({known.older, known.newer, known.T_older_newer, EdgeKind::kClosure});
    const Closure right = drive.Match(revisit.second[9], revisit.first[9]);
    const Closure wrong = drive.Match(revisit.second[9], revisit.first[9], {1.0, 0.0, 0.0});
    Judging<EvidenceValidator> ours;
    ours_takes_it += ours.Judge(graph, {right}).empty() ? 0 : 1;
    Judging<EvidenceValidator> ours_again;
    EXPECT_TRUE(ours_again.Judge(graph, {wrong}).empty()) << "1 m off, seed " << seed;
    Judging<VoteValidator> paper{ValidatorOptions()};
    EXPECT_TRUE(paper.Judge(graph, {right}).empty()) << "six votes, seed " << seed;
  }
  EXPECT_GE(ours_takes_it, 10) << "of 20: a gate of two sigmas refuses some that are right";
}

TEST(EvidenceValidator, ALoopThatAgreesWithAnythingIsNoEvidence) {
  // A sure region at the start and another, many times driven, far away over odometry that has lost
  // its way. A wrong match between the two closes dozens of loops, all over the same unsure
  // stretch.
  int paper_takes_it = 0;
  for (unsigned seed = 1; seed <= 10; ++seed) {
    Drive drive(0.15, 0.02, seed);
    const auto add_sure = [&](NodeId a, NodeId b, PoseGraph& graph) {
      const Closure h = drive.Match(a, b);
      graph.AddEdge({h.older, h.newer, h.T_older_newer, EdgeKind::kClosure});
    };
    const std::vector<NodeId> near = drive.Corridor(0.0, 0.0, 12);
    for (int i = 1; i < 30; ++i) drive.Go({44.0, 8.0 * i, kPi / 2});
    const std::vector<NodeId> far = drive.Corridor(44.0, 240.0, 12);
    PoseGraph graph = drive.graph();
    for (const std::vector<NodeId>* region : {&near, &far}) {
      for (std::size_t i = 0; i < 12; ++i) {
        for (std::size_t j = i + 2; j < 12; ++j) add_sure((*region)[j], (*region)[i], graph);
      }
    }
    Closure wrong = drive.Match(far[6], near[6], {2.0, 3.0, 0.1});
    Judging<EvidenceValidator> ours;
    EXPECT_TRUE(ours.Judge(graph, {wrong}).empty());
    Judging<VoteValidator> paper{ValidatorOptions()};
    paper_takes_it += paper.Judge(graph, {wrong}).empty() ? 0 : 1;
  }
  EXPECT_GE(paper_takes_it, 1) << "the scene is meant to be one that the votes alone do not settle";
}

TEST(EvidenceValidator, APairThatAgreesByAliasingStaysOut) {
  for (unsigned seed = 1; seed <= 20; ++seed) {
    Drive drive(0.01, 0.001, seed);
    const Revisit revisit = TwicePast(drive, 12, 60.0);
    Judging<EvidenceValidator> validator;
    // Every match of one junction is shifted by one door; its neighbours agree with each other.
    const Pose2 shift{0.0, 3.0, 0.0};
    std::vector<Closure> matches;
    for (std::size_t i = 4; i < 6; ++i) {
      for (std::size_t j = 3; j < 7; ++j) {
        matches.push_back(drive.Match(revisit.second[i], revisit.first[j], shift));
      }
    }
    EXPECT_TRUE(drive.Judge(validator, matches).empty()) << "seed " << seed;
  }
}

TEST(EvidenceValidator, AliasesThatOdometryRefutesStayOutHoweverMany) {
  for (unsigned seed = 1; seed <= 10; ++seed) {
    Drive drive(0.01, 0.0005, seed);
    const Revisit revisit = TwicePast(drive, 16, 20.0);
    Judging<EvidenceValidator> validator;
    // The whole corridor, taken for its parallel neighbour 8 m away.
    for (std::size_t i = 0; i < 16; ++i) {
      drive.Judge(validator, {drive.Match(revisit.second[i], revisit.first[i], {0.0, 8.0, 0.0})});
    }
    EXPECT_EQ(CountOf(drive, validator).wrong_validated, 0) << "seed " << seed;
  }
}

TEST(EvidenceValidator, PlantedWrongMatchesStayOutAndRightOnesGetIn) {
  Count sum;
  for (unsigned seed = 1; seed <= 20; ++seed) {
    Drive drive(0.02, 0.003, seed);
    Judging<EvidenceValidator> validator;
    std::uniform_real_distribution<double> unit(-1.0, 1.0);
    std::vector<NodeId> past;
    for (int round = 0; round < 4; ++round) {
      // Rounds of a block of 32 x 16 m, a node every 4 m.
      for (int i = 0; i < 24; ++i) {
        Pose2 T;
        if (i < 8)
          T = {4.0 * i, 0.0, 0.0};
        else if (i < 12)
          T = {32.0, 4.0 * (i - 8), kPi / 2};
        else if (i < 20)
          T = {32.0 - 4.0 * (i - 12), 16.0, kPi};
        else
          T = {0.0, 16.0 - 4.0 * (i - 20), -kPi / 2};
        const NodeId node = drive.Go(T * Pose2{0.3 * unit(drive.random()), 0.2, 0.0});
        std::vector<Closure> matches;
        for (const NodeId other : past) {
          if (Distance(drive.Truth(node), drive.Truth(other)) > 1.0) continue;
          if (unit(drive.random()) > 0.5) {
            matches.push_back(drive.Match(node, other));
          } else if (unit(drive.random()) > 0.5) {
            // Found somewhere in the search window.
            matches.push_back(drive.Match(node, other,
                                          {4.0 * unit(drive.random()), 4.0 * unit(drive.random()),
                                           0.5 * unit(drive.random())}));
          }
        }
        drive.Judge(validator, matches);
        past.push_back(node);
      }
    }
    const Count count = CountOf(drive, validator);
    sum.right += count.right;
    sum.right_validated += count.right_validated;
    sum.wrong += count.wrong;
    sum.wrong_validated += count.wrong_validated;
  }
  EXPECT_GT(sum.wrong, 300);
  // Odds of 16 to 1 let in what chance put right beside the right place.
  EXPECT_LT(sum.wrong_validated, 0.005 * sum.wrong) << "of " << sum.wrong;
  EXPECT_GT(sum.right_validated, 0.6 * sum.right) << "of " << sum.right;
}

struct Margins {
  double wrong = -std::numeric_limits<double>::infinity();  // of the wrong one that came nearest
  double right = 0.0;  // of the right one that nine in ten are surer than
};

// Nats above the threshold, of wrong matches and of right ones offered in their stead. Pairs are
// offered one after the other, older first; each wrong one is off by `shift`.
Margins MarginsOf(const std::function<std::vector<std::pair<NodeId, NodeId>>(Drive&)>& drive_it,
                  const Pose2& shift, double sigma_m, double sigma_rad) {
  Margins margins;
  std::vector<double> right;
  for (unsigned seed = 1; seed <= 10; ++seed) {
    for (const bool wrong : {true, false}) {
      Drive drive(sigma_m, sigma_rad, seed);
      Judging<EvidenceValidator> judging;
      const std::vector<std::pair<NodeId, NodeId>> pairs = drive_it(drive);
      for (const auto& [older, newer] : pairs) {
        drive.Judge(judging, {drive.Match(newer, older, wrong ? shift : Pose2())});
      }
      for (std::size_t i = 0; i < judging.closures().size(); ++i) {
        const double nats = judging.validator().EvidenceFor(static_cast<ClosureId>(i),
                                                            drive.graph(), judging.closures()) -
                            kEnoughNats;
        if (wrong) margins.wrong = std::max(margins.wrong, nats);
        if (!wrong) right.push_back(nats);
      }
    }
  }
  const auto tenth = right.begin() + static_cast<std::ptrdiff_t>(right.size() / 10);
  std::nth_element(right.begin(), tenth, right.end());
  margins.right = *tenth;
  return margins;
}

void Print(const char* scene, const Margins& margins) {
  std::cout << scene << ": wrong matches at most " << margins.wrong
            << " nats from being believed, nine in ten right ones at least " << margins.right
            << " beyond it\n";
}

TEST(EvidenceValidator, LookAlikesStayOutByAMargin) {
  // Along a corridor, back through its parallel neighbour 8 m away, which is taken for the first.
  const auto corridors = [](Drive& drive) {
    std::vector<std::pair<NodeId, NodeId>> pairs;
    const std::vector<NodeId> one = drive.Corridor(0.0, 0.0, 16);
    drive.Go({64.0, 4.0, kPi / 2});
    for (int i = 15; i >= 0; --i) {
      pairs.emplace_back(one[static_cast<std::size_t>(i)], drive.Go({4.0 * i, 0.0, 0.0}));
    }
    return pairs;
  };
  const Margins alike = MarginsOf(corridors, {0.0, 8.0, 0.0}, 0.02, 0.002);
  Print("parallel corridors", alike);
  EXPECT_LT(alike.wrong, -5.0);
  EXPECT_GT(alike.right, 0.0);

  // Rooms in a row, every 4 m a door: each is taken for its neighbour.
  const auto rooms = [](Drive& drive) {
    std::vector<std::pair<NodeId, NodeId>> pairs;
    const Revisit revisit = TwicePast(drive, 12, 24.0);
    for (std::size_t i = 0; i < 12; ++i) pairs.emplace_back(revisit.first[i], revisit.second[i]);
    return pairs;
  };
  const Margins row = MarginsOf(rooms, {4.0, 0.0, 0.0}, 0.02, 0.002);
  Print("rooms in a row", row);
  EXPECT_LT(row.wrong, -5.0);
  EXPECT_GT(row.right, 0.0);

  // Flight after flight of one staircase, each 1.5 m beside the one below: each is taken for that.
  const auto flights = [](Drive& drive) {
    std::vector<std::pair<NodeId, NodeId>> pairs;
    std::vector<NodeId> before;
    for (int flight = 0; flight < 12; ++flight) {
      std::vector<NodeId> nodes;
      for (int i = 0; i < 3; ++i) nodes.push_back(drive.Go({2.0 * i, 0.05 * flight, 0.0}));
      drive.Go({6.0, 0.5, kPi / 2});
      drive.Go({3.0, 1.0, kPi});
      drive.Go({-1.0, 0.5, -kPi / 2});
      for (std::size_t i = 0; i < before.size(); ++i) pairs.emplace_back(before[i], nodes[i]);
      before = nodes;
    }
    return pairs;
  };
  const Margins spiral = MarginsOf(flights, {0.0, 1.5, 0.0}, 0.02, 0.002);
  Print("flights of a staircase", spiral);
  EXPECT_LT(spiral.wrong, -5.0);
  EXPECT_GT(spiral.right, 0.0);
}

TEST(EvidenceValidator, TheOutcomeDoesNotDependOnWhatLiesBeyondTheCutOff) {
  const auto votes = [](int far_nodes) {
    Drive drive(0.03, 0.003, 5);
    const Revisit revisit = TwicePast(drive, 8, 20.0);
    Judging<EvidenceValidator> validator;
    std::vector<Closure> matches;
    for (std::size_t i = 0; i < 8; ++i) {
      matches.push_back(drive.Match(revisit.second[i], revisit.first[i]));
    }
    for (int i = 0; i < far_nodes; ++i) drive.Go({40.0 + 8.0 * i, 0.0, 0.0});
    drive.Judge(validator, matches);
    std::vector<int> result;
    for (const Closure& h : validator.closures()) result.push_back(h.votes);
    return result;
  };
  EXPECT_EQ(votes(0), votes(2000));
}

TEST(EvidenceValidator, TwoPiecesAreJoinedByAgreementFromSeveralPlaces) {
  Drive drive(0.02, 0.002, 7);
  const std::vector<NodeId> one = drive.Corridor(0.0, 0.0, 12);
  const std::vector<NodeId> two = drive.Corridor(0.5, 0.2, 12);
  PoseGraph graph;  // the same without the edge between the two drives
  graph.AddFloor({});
  for (const Node& node : drive.graph().nodes()) graph.AddNode(node);
  for (const Edge& edge : drive.graph().edges()) {
    if (edge.from != one.back()) graph.AddEdge(edge);
  }
  Judging<EvidenceValidator> validator;
  std::size_t valid = 0;
  for (std::size_t i = 0; i < 12; ++i) {
    for (const ClosureId id : validator.Judge(graph, {drive.Match(two[i], one[i])})) {
      const Closure& h = validator.closures()[static_cast<std::size_t>(id)];
      graph.AddEdge({h.older, h.newer, h.T_older_newer, EdgeKind::kClosure});
      ++valid;
      EXPECT_GE(i, 3u) << "12 m along: too early to be sure";
    }
  }
  EXPECT_GE(valid, 6u);
}

TEST(EvidenceValidator, NothingToJudge) {
  Judging<EvidenceValidator> validator;
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

TEST(EvidenceValidatorDeathTest, EndsMustBeTwoNodesOfTheGraph) {
  Judging<EvidenceValidator> validator;
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
