// SPDX-License-Identifier: BSD-3-Clause
#include "loop_closure/validator.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>
#include <vector>

namespace masked_mapper {
namespace {

// A validator, and the closures that it was given.
class Judging {
 public:
  explicit Judging(const ValidatorOptions& options) : validator_(options) {}

  std::vector<ClosureId> Judge(const PoseGraph& graph, const std::vector<Closure>& matches) {
    std::vector<ClosureId> ids;
    for (const Closure& match : matches) {
      ids.push_back(static_cast<ClosureId>(closures_.size()));
      closures_.push_back(match);
    }
    return validator_.Judge(graph, ids, closures_);
  }

  const std::vector<Closure>& closures() const { return closures_; }

 private:
  LoopValidator validator_;
  std::vector<Closure> closures_;
};

// A drive whose true poses are known, with odometry that drifts by `sigma` per square root of a
// metre and matches that are exact to a few centimetres.
class Drive {
 public:
  Drive(double sigma_m, double sigma_rad, unsigned seed)
      : sigma_m_(sigma_m), sigma_rad_(sigma_rad), random_(seed) {
    graph_.AddFloor({});
  }

  NodeId Go(const Pose2& T_world_robot) {
    Node node;
    node.T_world_robot = T_world_robot;
    const NodeId id = graph_.AddNode(node);
    truth_.push_back(T_world_robot);
    if (id == 0) return id;
    const Pose2 step = Between(truth_[truth_.size() - 2], T_world_robot);
    const double length = std::sqrt(std::hypot(step.x, step.y) + 0.01);
    const Eigen::Vector3d sigma(sigma_m_ * length, sigma_m_ * length, sigma_rad_ * length);
    const Eigen::Matrix3d covariance = sigma.cwiseAbs2().asDiagonal();
    graph_.AddEdge({id - 1, id, {Disturbed(step, sigma), covariance}, EdgeKind::kOdometry});
    return id;
  }

  // A straight corridor from (x, y), a node every 4 m.
  std::vector<NodeId> Corridor(double x, double y, int nodes) {
    std::vector<NodeId> ids;
    for (int i = 0; i < nodes; ++i) ids.push_back(Go({x + 4.0 * i, y, 0.0}));
    return ids;
  }

  // A match of two places, off the truth by `error` (seen in a).
  Closure Match(NodeId newer, NodeId older, const Pose2& error = {}) {
    const Eigen::Vector3d sigma(0.03, 0.03, 0.006);
    const Pose2 T_newer_older = error * Between(Truth(newer), Truth(older));
    Closure match;
    match.older = older;
    match.newer = newer;
    match.T_older_newer =
        Inverse(UncertainPose2{Disturbed(T_newer_older, sigma), sigma.cwiseAbs2().asDiagonal()});
    match.state = ClosureState::kHypothesis;
    match.reason = ClosureReason::kTooFewVotes;
    return match;
  }

  // Judges, and adds what became valid to the graph, as mapping does.
  std::vector<ClosureId> Judge(Judging& validator, const std::vector<Closure>& matches) {
    const std::vector<ClosureId> valid = validator.Judge(graph_, matches);
    for (const ClosureId id : valid) {
      const Closure& h = validator.closures()[static_cast<std::size_t>(id)];
      graph_.AddEdge({h.older, h.newer, h.T_older_newer, EdgeKind::kClosure});
    }
    return valid;
  }

  bool IsFalse(const Closure& h) const {
    const Pose2 error = Between(h.T_older_newer.mean, Between(Truth(h.older), Truth(h.newer)));
    return std::hypot(error.x, error.y) > 0.5 || std::abs(error.theta) > DegToRad(5.0);
  }

  const Pose2& Truth(NodeId node) const { return truth_[static_cast<std::size_t>(node)]; }
  const PoseGraph& graph() const { return graph_; }
  std::mt19937& random() { return random_; }

 private:
  Pose2 Disturbed(const Pose2& T, const Eigen::Vector3d& sigma) {
    std::normal_distribution<double> normal;
    return {T.x + sigma.x() * normal(random_), T.y + sigma.y() * normal(random_),
            WrapAngle(T.theta + sigma.z() * normal(random_))};
  }

  double sigma_m_;
  double sigma_rad_;
  std::mt19937 random_;
  PoseGraph graph_;
  std::vector<Pose2> truth_;
};

struct Count {
  int right = 0;
  int right_validated = 0;
  int wrong = 0;
  int wrong_validated = 0;
};

Count CountOf(const Drive& drive, const Judging& validator) {
  Count count;
  for (const Closure& h : validator.closures()) {
    const bool wrong = drive.IsFalse(h);
    ++(wrong ? count.wrong : count.right);
    if (h.state == ClosureState::kValidated)
      ++(wrong ? count.wrong_validated : count.right_validated);
  }
  return count;
}

// Out along a corridor, round a block of `detour` metres, and along the corridor again.
struct Revisit {
  std::vector<NodeId> first;
  std::vector<NodeId> second;
};

Revisit TwicePast(Drive& drive, int nodes, double detour) {
  Revisit revisit;
  revisit.first = drive.Corridor(0.0, 0.0, nodes);
  const double end = 4.0 * nodes;
  for (double y = 0.0; y < detour; y += 8.0) drive.Go({end, y, kPi / 2});
  for (double x = end; x > 0.0; x -= 8.0) drive.Go({x, detour, kPi});
  for (double y = detour; y > 0.0; y -= 8.0) drive.Go({0.0, y, -kPi / 2});
  revisit.second = drive.Corridor(0.5, 0.3, nodes);
  return revisit;
}

TEST(LoopValidator, ARevisitedCorridorIsClosed) {
  for (const ValidatorOptions& options : {ValidatorOptions(), PaperRule()}) {
    for (unsigned seed = 1; seed <= 20; ++seed) {
      Drive drive(0.02, 0.002, seed);
      const Revisit revisit = TwicePast(drive, 10, 40.0);
      Judging validator(options);
      for (std::size_t i = 0; i < revisit.second.size(); ++i) {
        std::vector<Closure> matches{drive.Match(revisit.second[i], revisit.first[i])};
        if (i > 0) matches.push_back(drive.Match(revisit.second[i], revisit.first[i - 1]));
        drive.Judge(validator, matches);
      }
      const Count count = CountOf(drive, validator);
      EXPECT_EQ(count.wrong_validated, 0);
      EXPECT_GE(count.right_validated, 9) << "of " << count.right << ", seed " << seed;
    }
  }
}

TEST(LoopValidator, ALoneMatchIsNotEnough) {
  Drive drive(0.02, 0.002, 1);
  const Revisit revisit = TwicePast(drive, 5, 20.0);
  for (const ValidatorOptions& options : {ValidatorOptions(), PaperRule()}) {
    Judging validator(options);
    // One way round alone, over odometry: at most one vote, right as the match may be.
    EXPECT_TRUE(drive.Judge(validator, {drive.Match(revisit.second[0], revisit.first[0])}).empty());
    EXPECT_LE(validator.closures()[0].votes, 1);
  }
}

TEST(LoopValidator, ALoneMatchThatASureWayConfirmsIsEnough) {
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
    Judging ours({});
    ours_takes_it += ours.Judge(graph, {right}).empty() ? 0 : 1;
    Judging ours_again({});
    EXPECT_TRUE(ours_again.Judge(graph, {wrong}).empty()) << "1 m off, seed " << seed;
    Judging paper(PaperRule());
    EXPECT_TRUE(paper.Judge(graph, {right}).empty()) << "six votes, seed " << seed;
  }
  EXPECT_GE(ours_takes_it, 10) << "of 20: a gate of two sigmas refuses some that are right";
}

TEST(LoopValidator, VotesAreCountedOnBothSidesAndComeLater) {
  // Two rungs of a ladder: loops of each new rung with odometry, and with every rung before it.
  Drive drive(0.001, 0.0001, 2);
  const Revisit revisit = TwicePast(drive, 8, 20.0);
  ValidatorOptions options = PaperRule();
  options.votes_needed = 3;
  Judging validator(options);
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

TEST(LoopValidator, ALoopThatAgreesWithAnythingIsNoEvidence) {
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
    Judging ours({});
    EXPECT_TRUE(ours.Judge(graph, {wrong}).empty());
    Judging paper(PaperRule());
    paper_takes_it += paper.Judge(graph, {wrong}).empty() ? 0 : 1;
  }
  EXPECT_GE(paper_takes_it, 1) << "the scene is meant to be one that the votes alone do not settle";
}

TEST(LoopValidator, APairThatAgreesByAliasingStaysOut) {
  for (unsigned seed = 1; seed <= 20; ++seed) {
    Drive drive(0.03, 0.004, seed);
    const Revisit revisit = TwicePast(drive, 12, 60.0);
    Judging validator({});
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

TEST(LoopValidator, AliasesThatOdometryRefutesStayOutHoweverMany) {
  for (unsigned seed = 1; seed <= 10; ++seed) {
    Drive drive(0.01, 0.0005, seed);
    const Revisit revisit = TwicePast(drive, 16, 20.0);
    Judging validator({});
    // The whole corridor, taken for its parallel neighbour 8 m away.
    for (std::size_t i = 0; i < 16; ++i) {
      drive.Judge(validator, {drive.Match(revisit.second[i], revisit.first[i], {0.0, 8.0, 0.0})});
    }
    EXPECT_EQ(CountOf(drive, validator).wrong_validated, 0) << "seed " << seed;
  }
}

TEST(LoopValidator, PlantedWrongMatchesStayOutAndRightOnesGetIn) {
  Count sum;
  for (unsigned seed = 1; seed <= 20; ++seed) {
    Drive drive(0.02, 0.003, seed);
    Judging validator({});
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
    EXPECT_EQ(count.wrong_validated, 0) << "seed " << seed;
    sum.right += count.right;
    sum.right_validated += count.right_validated;
    sum.wrong += count.wrong;
  }
  EXPECT_GT(sum.wrong, 300);
  EXPECT_GT(sum.right_validated, 0.6 * sum.right) << "of " << sum.right;
}

TEST(LoopValidator, TheOutcomeDoesNotDependOnWhatLiesBeyondTheCutOff) {
  const auto votes = [](int far_nodes) {
    Drive drive(0.03, 0.003, 5);
    const Revisit revisit = TwicePast(drive, 8, 20.0);
    Judging validator({});
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

TEST(LoopValidator, TwoPiecesAreJoinedByAgreementFromSeveralPlaces) {
  Drive drive(0.02, 0.002, 7);
  const std::vector<NodeId> one = drive.Corridor(0.0, 0.0, 12);
  const std::vector<NodeId> two = drive.Corridor(0.5, 0.2, 12);
  PoseGraph graph;  // the same without the edge between the two drives
  graph.AddFloor({});
  for (const Node& node : drive.graph().nodes()) graph.AddNode(node);
  for (const Edge& edge : drive.graph().edges()) {
    if (edge.from != one.back()) graph.AddEdge(edge);
  }
  Judging validator({});
  std::size_t valid = 0;
  for (std::size_t i = 0; i < 12; ++i) {
    for (const ClosureId id : validator.Judge(graph, {drive.Match(two[i], one[i])})) {
      const Closure& h = validator.closures()[static_cast<std::size_t>(id)];
      graph.AddEdge({h.older, h.newer, h.T_older_newer, EdgeKind::kClosure});
      ++valid;
      EXPECT_GE(i, 5u) << "too early to be sure";
    }
  }
  EXPECT_GE(valid, 6u);
}

TEST(LoopValidator, NothingToJudge) {
  Judging validator({});
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

TEST(LoopValidatorDeathTest, EndsMustBeTwoNodesOfTheGraph) {
  Judging validator({});
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
