// SPDX-License-Identifier: BSD-3-Clause
// Drives whose true poses are known, and matches of them, right and wrong, to be judged.
#pragma once

#include <cmath>
#include <random>
#include <vector>

#include "masked_mapper/map/closure.hpp"
#include "masked_mapper/pose_graph/pose_graph.hpp"

namespace masked_mapper {

/// A validator, and the closures that it was given.
template <class Validator>
class Judging {
 public:
  template <class... Options>
  explicit Judging(const Options&... options) : validator_(options...) {}

  std::vector<ClosureId> Judge(const PoseGraph& graph, const std::vector<Closure>& matches) {
    std::vector<ClosureId> ids;
    for (const Closure& match : matches) {
      ids.push_back(static_cast<ClosureId>(closures_.size()));
      closures_.push_back(match);
    }
    return validator_.Judge(graph, ids, closures_);
  }

  const Validator& validator() const { return validator_; }
  const std::vector<Closure>& closures() const { return closures_; }

 private:
  Validator validator_;
  std::vector<Closure> closures_;
};

/// A drive whose true poses are known, with odometry that drifts by `sigma` per square root of a
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

  /// A straight corridor from (x, y), a node every 4 m.
  std::vector<NodeId> Corridor(double x, double y, int nodes) {
    std::vector<NodeId> ids;
    for (int i = 0; i < nodes; ++i) ids.push_back(Go({x + 4.0 * i, y, 0.0}));
    return ids;
  }

  /// A match of two places, off the truth by `error` (seen in a).
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

  /// Judges, and adds what became valid to the graph, as mapping does.
  template <class Validator>
  std::vector<ClosureId> Judge(Judging<Validator>& validator, const std::vector<Closure>& matches) {
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

template <class Validator>
Count CountOf(const Drive& drive, const Judging<Validator>& validator) {
  Count count;
  for (const Closure& h : validator.closures()) {
    const bool wrong = drive.IsFalse(h);
    ++(wrong ? count.wrong : count.right);
    if (h.state == ClosureState::kValidated)
      ++(wrong ? count.wrong_validated : count.right_validated);
  }
  return count;
}

/// Out along a corridor, round a block of `detour` metres, and along the corridor again.
struct Revisit {
  std::vector<NodeId> first;
  std::vector<NodeId> second;
};

inline Revisit TwicePast(Drive& drive, int nodes, double detour) {
  Revisit revisit;
  revisit.first = drive.Corridor(0.0, 0.0, nodes);
  const double end = 4.0 * nodes;
  for (double y = 0.0; y < detour; y += 8.0) drive.Go({end, y, kPi / 2});
  for (double x = end; x > 0.0; x -= 8.0) drive.Go({x, detour, kPi});
  for (double y = detour; y > 0.0; y -= 8.0) drive.Go({0.0, y, -kPi / 2});
  revisit.second = drive.Corridor(0.5, 0.3, nodes);
  return revisit;
}

/// A corridor passed again, every match right.
template <class Validator>
Count CountOfRevisit(unsigned seed, Judging<Validator>& validator) {
  Drive drive(0.02, 0.002, seed);
  const Revisit revisit = TwicePast(drive, 10, 40.0);
  for (std::size_t i = 0; i < revisit.second.size(); ++i) {
    std::vector<Closure> matches{drive.Match(revisit.second[i], revisit.first[i])};
    if (i > 0) matches.push_back(drive.Match(revisit.second[i], revisit.first[i - 1]));
    drive.Judge(validator, matches);
  }
  return CountOf(drive, validator);
}

}  // namespace masked_mapper
