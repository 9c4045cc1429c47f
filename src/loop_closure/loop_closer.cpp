// SPDX-License-Identifier: BSD-3-Clause
#include "masked_mapper/loop_closure/loop_closer.hpp"

#include <Eigen/Eigenvalues>
#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>

#include "masked_mapper/geometry/mahalanobis.hpp"
#include "masked_mapper/map/stage_timer.hpp"
#include "masked_mapper/optimization/closure_audit.hpp"

namespace masked_mapper {
namespace {

constexpr const char* kBelowMinScore = "score below the minimum";
constexpr const char* kDoesNotFit = "does not fit the surroundings of the older node";
constexpr const char* kAlikeAlongALine = "the place looks alike along a line";
constexpr const char* kTooFewVotes = "too few votes";
constexpr const char* kDisagrees = "disagrees with the optimised map";
constexpr const char* kFitsTheMap = "fits the optimised map";

/// Whether a match leaves its least certain direction open.
bool IsAmbiguous(const Eigen::Matrix3d& covariance, const AmbiguityOptions& options) {
  const double largest = Eigen::SelfAdjointEigenSolver<Eigen::Matrix2d>(
                             covariance.topLeftCorner<2, 2>(), Eigen::EigenvaluesOnly)
                             .eigenvalues()
                             .maxCoeff();
  return std::sqrt(largest) > options.max_sigma_m ||
         std::sqrt(covariance(2, 2)) > DegToRad(options.max_sigma_deg);
}

}  // namespace

LoopCloser::LoopCloser(const LoopClosureOptions& options, MappingResult& map,
                       ReferencePoints reference)
    : options_(options),
      map_(map),
      reference_(std::move(reference)),
      matcher_(options.matcher),
      late_matcher_(options.matcher),
      submaps_(options.submaps, map),
      validator_(options.validator),
      optimizer_(options.optimizer) {
  // The closures of a pair stand among the edges in the order of their attempts.
  std::map<std::pair<NodeId, NodeId>, std::vector<std::size_t>> attempts;
  for (std::size_t i = map.attempts.size(); i-- > 0;) {
    const ClosureAttempt& attempt = map.attempts[i];
    if (attempt.state == ClosureState::kValidated) attempts[{attempt.a, attempt.b}].push_back(i);
  }
  for (std::size_t i = 0; i < map.graph.edges().size(); ++i) {
    const Edge& edge = map.graph.edges()[i];
    if (edge.kind != EdgeKind::kClosure) continue;
    std::vector<std::size_t>& left = attempts[{edge.from, edge.to}];
    if (left.empty()) continue;
    attempt_of_edge_[static_cast<EdgeId>(i)] = left.back();
    left.pop_back();
  }
}

std::size_t LoopCloser::Close(NodeId new_node, const std::vector<Candidate>& candidates) {
  const std::vector<Hypothesis> matches = MatchScans(new_node, candidates);
  std::vector<HypothesisId> validated;
  {
    const StageTimer timer(map_.seconds.validation);
    validated = validator_.Judge(map_.graph, matches);
  }
  if (validated.empty()) return 0;
  AddValidated(validated);
  const StageTimer timer(map_.seconds.optimisation);
  optimizer_.Update(map_.graph);
  return validated.size();
}

std::vector<Hypothesis> LoopCloser::MatchScans(NodeId new_node,
                                               const std::vector<Candidate>& candidates) {
  const StageTimer timer(map_.seconds.matching);
  const std::vector<Node>& nodes = map_.graph.nodes();
  std::vector<MatchPair> pairs;
  for (const Candidate& candidate : candidates) {
    const Node& old_node = nodes[static_cast<std::size_t>(candidate.node)];
    pairs.push_back(
        {candidate.node, reference_ ? reference_(candidate.node) : old_node.points_in_robot,
         nodes[static_cast<std::size_t>(new_node)].points_in_robot, Inverse(candidate.T_new_node)});
  }
  const std::vector<MatchResult> results = matcher_.Match(pairs);
  std::vector<Hypothesis> matches;
  for (std::size_t i = 0; i < candidates.size(); ++i) {
    ClosureAttempt attempt;
    attempt.a = new_node;
    attempt.b = candidates[i].node;
    attempt.T_a_b = Inverse(results[i].T_reference_query);
    attempt.score = results[i].score;
    attempt.mahalanobis = candidates[i].mahalanobis;
    if (results[i].outcome != MatchOutcome::kMatched) {
      attempt.reason = kBelowMinScore;
    } else {
      attempt.state = ClosureState::kHypothesis;
      if (options_.refine && !RefineMatch(attempt)) {
        attempt.reason = kDoesNotFit;
      } else if (IsAmbiguous(attempt.T_a_b.covariance, options_.ambiguity)) {
        attempt.reason = kAlikeAlongALine;
      } else {
        attempt.reason = kTooFewVotes;
        attempt_of_hypothesis_.push_back(map_.attempts.size());
        Hypothesis hypothesis;
        hypothesis.a = attempt.a;
        hypothesis.b = attempt.b;
        hypothesis.T_a_b = attempt.T_a_b;
        matches.push_back(hypothesis);
      }
    }
    map_.attempts.push_back(std::move(attempt));
  }
  return matches;
}

bool LoopCloser::RefineMatch(ClosureAttempt& attempt) {
  const Node& a = map_.graph.nodes()[static_cast<std::size_t>(attempt.a)];
  const std::optional<SubmapMatch> refined =
      submaps_.Refine(attempt.b, *a.points_in_robot, Inverse(attempt.T_a_b));
  if (!refined) return false;
  attempt.T_a_b = Inverse(refined->T_node_robot);
  attempt.agreement = refined->inlier_share;
  return true;
}

void LoopCloser::AddValidated(const std::vector<HypothesisId>& validated) {
  for (const HypothesisId id : validated) {
    const Hypothesis& hypothesis = validator_.hypotheses()[static_cast<std::size_t>(id)];
    const EdgeId edge =
        map_.graph.AddEdge({hypothesis.a, hypothesis.b, hypothesis.T_a_b, EdgeKind::kClosure});
    attempt_of_edge_[edge] = attempt_of_hypothesis_[static_cast<std::size_t>(id)];
    ClosureAttempt& attempt = map_.attempts[attempt_of_edge_[edge]];
    attempt.state = ClosureState::kValidated;
    attempt.reason = "enough votes";
  }
}

// What too few loops spoke for while the map was being made is looked at once more in the map that
// came of it: the pair is matched again from its optimised poses, and enters where that moves it by
// next to nothing.
void LoopCloser::Polish() {
  std::vector<std::size_t> open;
  for (std::size_t i = 0; i < map_.attempts.size(); ++i) {
    if (map_.attempts[i].reason == kTooFewVotes) open.push_back(i);
  }
  // By the older node: its submap is built once.
  std::stable_sort(open.begin(), open.end(), [&](std::size_t one, std::size_t other) {
    return map_.attempts[one].b < map_.attempts[other].b;
  });
  const double most_m = options_.polish.most_m;
  const double most_rad = DegToRad(options_.polish.most_deg);
  for (const std::size_t i : open) {
    ClosureAttempt& attempt = map_.attempts[i];
    // Drives that do not hang together may have been tried, too: what they have in common by chance
    // says nothing, and their floors are not one.
    if (!CanBeOne(attempt) || !FitsTheMap(attempt)) continue;
    if (IsForbidden(attempt.a, attempt.b)) continue;
    const ScanPoints::ConstPtr points_at_a = submaps_.PointsAt(attempt.a);
    if (!points_at_a) continue;
    UncertainPose2 guess;
    guess.mean = MapBetween(attempt.b, attempt.a);
    guess.covariance.diagonal() << most_m * most_m, most_m * most_m, most_rad * most_rad;
    const std::optional<SubmapMatch> again = submaps_.Refine(attempt.b, *points_at_a, guess);
    if (!again) continue;
    ClosureAttempt late = attempt;
    late.T_a_b = Inverse(again->T_node_robot);
    late.agreement = again->inlier_share;
    if (!FitsTheMap(late) || IsAmbiguous(late.T_a_b.covariance, options_.ambiguity)) continue;
    EnterLate(i, late);
    attempt = late;
  }
}

bool LoopCloser::CanBeOne(const ClosureAttempt& attempt) const {
  const std::vector<Node>& nodes = map_.graph.nodes();
  return attempt.a != attempt.b && nodes[static_cast<std::size_t>(attempt.a)].floor ==
                                       nodes[static_cast<std::size_t>(attempt.b)].floor;
}

bool LoopCloser::IsForbidden(NodeId one, NodeId other) const {
  return std::any_of(map_.attempts.begin(), map_.attempts.end(),
                     [&](const ClosureAttempt& attempt) {
                       return attempt.reason == kForbiddenByHand &&
                              std::minmax(attempt.a, attempt.b) == std::minmax(one, other);
                     });
}

bool LoopCloser::FitsTheMap(const ClosureAttempt& attempt) const {
  const Pose2 T_map_a_b = MapBetween(attempt.a, attempt.b);
  return Distance(attempt.T_a_b.mean, T_map_a_b) <= options_.polish.most_m &&
         std::abs(WrapAngle(attempt.T_a_b.mean.theta - T_map_a_b.theta)) <=
             DegToRad(options_.polish.most_deg);
}

Pose2 LoopCloser::MapBetween(NodeId from, NodeId to) const {
  const std::vector<Node>& nodes = map_.graph.nodes();
  return Between(nodes[static_cast<std::size_t>(from)].T_world_robot,
                 nodes[static_cast<std::size_t>(to)].T_world_robot);
}

// From the map, and as sure as the surest way through the graph; none where that cannot vouch for a
// closure.
std::optional<UncertainPose2> LoopCloser::SureWay(NodeId from, NodeId to) const {
  for (const ProjectedNode& projected :
       DijkstraProjection(map_.graph, from, {options_.validator.sure_loop_trace})) {
    if (projected.node != to) continue;
    return UncertainPose2{MapBetween(from, to), projected.T_source_node.covariance};
  }
  return std::nullopt;
}

void LoopCloser::EnterLate(std::size_t place, ClosureAttempt& attempt) {
  attempt.state = ClosureState::kValidated;
  attempt.reason = kFitsTheMap;
  attempt_of_edge_[map_.graph.AddEdge({attempt.a, attempt.b, attempt.T_a_b, EdgeKind::kClosure})] =
      place;
}

// Corridors between masked places, passed again: what no mask offered is offered now, where the map
// has two nodes at one place and no walk along the graph says so. A sure way through the graph has
// to vouch for it, as in the validator; it may also say how far along where a place looks alike
// along a line, but is not counted again in the closure.
void LoopCloser::CloseOpenRevisits() {
  const std::vector<Edge>& edges = map_.graph.edges();
  const bool any_closed = std::any_of(
      edges.begin(), edges.end(), [](const Edge& edge) { return edge.kind == EdgeKind::kClosure; });
  if (!any_closed) return;  // dead reckoning stays what it is
  const OpenRevisits revisits(map_.graph, options_.polish.revisits);
  for (NodeId a = 0; static_cast<std::size_t>(a) < map_.graph.nodes().size(); ++a) {
    std::vector<NodeId> open = revisits.Of(a);
    while (!open.empty()) {
      const NodeId b = open.front();
      open.erase(open.begin());
      if (!CloseRevisit(a, b)) continue;
      // What closed here may have joined the others, too.
      const std::vector<NodeId> still_open = revisits.Of(a);
      const auto is_joined = [&](NodeId node) {
        return std::find(still_open.begin(), still_open.end(), node) == still_open.end();
      };
      open.erase(std::remove_if(open.begin(), open.end(), is_joined), open.end());
    }
  }
}

bool LoopCloser::CloseRevisit(NodeId a, NodeId b) {
  const std::optional<UncertainPose2> sure_way = SureWay(b, a);
  if (!sure_way || IsForbidden(a, b)) return false;
  const UncertainPose2& T_b_a = *sure_way;
  const ScanPoints::ConstPtr points_at_a = submaps_.PointsAt(a);
  if (!points_at_a) return false;
  // The robot may have come the other way: its scan then shows what lies behind that of the older.
  const MatchPair pair{b, submaps_.PointsAround(b), points_at_a, T_b_a};
  const MatchResult match = late_matcher_.Match({pair}).front();
  ClosureAttempt attempt;
  attempt.a = a;
  attempt.b = b;
  attempt.T_a_b = Inverse(T_b_a);
  attempt.score = match.score;
  attempt.mahalanobis =
      MahalanobisDistance(T_b_a.mean.Translation(), T_b_a.covariance.topLeftCorner<2, 2>(),
                          options_.candidates.match_range_m);
  if (match.outcome != MatchOutcome::kMatched) {
    attempt.reason = kBelowMinScore;
  } else if (const auto refined = submaps_.Refine(b, *points_at_a, T_b_a)) {
    attempt.state = ClosureState::kHypothesis;
    attempt.T_a_b = Inverse(refined->T_node_robot);
    attempt.agreement = refined->inlier_share;
    const Eigen::Matrix3d both =
        (refined->T_node_robot.covariance.inverse() + T_b_a.covariance.inverse()).inverse();
    if (!FitsTheMap(attempt)) {
      attempt.reason = kDisagrees;
    } else if (IsAmbiguous(both, options_.ambiguity)) {
      attempt.reason = kAlikeAlongALine;
    } else {
      EnterLate(map_.attempts.size(), attempt);
    }
  } else {
    attempt.state = ClosureState::kHypothesis;
    attempt.reason = kDoesNotFit;
  }
  const bool closed = attempt.state == ClosureState::kValidated;
  map_.attempts.push_back(std::move(attempt));
  return closed;
}

// With all closures in, those that disagree with the rest go before the map is written.
void LoopCloser::Audit() {
  const StageTimer timer(map_.seconds.optimisation);
  Optimize(options_.optimizer.solver, map_.graph);
  if (options_.refine) {
    Polish();
    CloseOpenRevisits();
    Optimize(options_.optimizer.solver, map_.graph);
  }
  // What somebody added by hand is not for the audit to take away.
  std::vector<EdgeId> by_hand;
  for (const auto& [edge, attempt] : attempt_of_edge_) {
    if (map_.attempts[attempt].reason == kAddedByHand) by_hand.push_back(edge);
  }
  const std::vector<EdgeId> wrong =
      AuditClosures(options_.audit, options_.optimizer.solver, map_.graph, by_hand);
  if (wrong.empty()) return;
  for (auto edge = wrong.rbegin(); edge != wrong.rend(); ++edge) {
    // A saved map may hold closures that no attempt tells of.
    const auto known = attempt_of_edge_.find(*edge);
    if (known != attempt_of_edge_.end()) {
      ClosureAttempt& attempt = map_.attempts[known->second];
      attempt.state = ClosureState::kAuditedOut;
      attempt.reason = kDisagrees;
    }
    map_.graph.RemoveEdge(*edge);
  }
  Optimize(options_.optimizer.solver, map_.graph);
}

void LoopCloser::NoteVotes() {
  const std::vector<Hypothesis>& hypotheses = validator_.hypotheses();
  for (std::size_t i = 0; i < hypotheses.size(); ++i) {
    map_.attempts[attempt_of_hypothesis_[i]].votes = hypotheses[i].votes;
  }
}

void LoopCloser::Finish() {
  NoteVotes();
  Audit();
}

bool LoopCloser::HoldsTogether() const {
  const std::size_t nodes = map_.graph.nodes().size();
  const std::size_t attempts = map_.attempts.size();
  const auto exists = [](std::int32_t id, std::size_t count) {
    return id >= 0 && static_cast<std::size_t>(id) < count;
  };
  bool holds = attempt_of_hypothesis_.size() == validator_.hypotheses().size();
  for (const Hypothesis& hypothesis : validator_.hypotheses()) {
    holds = holds && exists(hypothesis.a, nodes) && exists(hypothesis.b, nodes);
  }
  for (const std::size_t attempt : attempt_of_hypothesis_) holds = holds && attempt < attempts;
  for (const auto& [edge, attempt] : attempt_of_edge_) {
    holds = holds && exists(edge, map_.graph.edges().size()) && attempt < attempts;
  }
  return holds;
}

}  // namespace masked_mapper
