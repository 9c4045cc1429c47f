// SPDX-License-Identifier: BSD-3-Clause
// Algorithm 1, to be read beside the paper: ObserveScan is its loop, CloseLoops its body.
#include "masked_mapper/mapping/masked_mapper.hpp"

#include <Eigen/Eigenvalues>
#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <utility>

#include "masked_mapper/geometry/mahalanobis.hpp"
#include "masked_mapper/mapping/stage_timer.hpp"
#include "masked_mapper/mapping/trajectory.hpp"
#include "masked_mapper/optimization/closure_audit.hpp"

namespace masked_mapper {
namespace {

constexpr const char* kBelowMinScore = "score below the minimum";
constexpr const char* kDoesNotFit = "does not fit the surroundings of the older node";
constexpr const char* kAlikeAlongALine = "the place looks alike along a line";
constexpr const char* kTooFewVotes = "too few votes";
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

MaskedMapper::MaskedMapper(const std::string& mask, const Options& options,
                           const FloorTimeline& floors)
    : options_(options),
      floors_(floors),
      motion_(options.motion),
      mask_(MakeMask(mask, options.masks)),
      matcher_(options.matcher),
      submaps_(options.submaps, options.motion.scans.map, result_),
      validator_(options.validator),
      optimizer_(options.optimizer) {
  const std::vector<std::string> names = FloorNames(floors.levels);
  for (std::size_t i = 0; i < floors.levels.size(); ++i) {
    const FloorLevel& level = floors.levels[i];
    result_.graph.AddFloor(
        {names[i], level.elevation, level.elevation_sigma, level.elevation_measured});
  }
}

void MaskedMapper::Observe(const Observation& observation) {
  if (const auto* odometry = std::get_if<OdometryReading>(&observation)) {
    const StageTimer timer(result_.seconds.motion);
    motion_.Observe(*odometry);
  } else if (const auto* scan = std::get_if<LaserScan>(&observation)) {
    ObserveScan(*scan);
  }
}

void MaskedMapper::ObserveScan(const LaserScan& scan) {
  const FloorInterval& interval = floors_.At(scan.stamp);
  {
    const StageTimer timer(result_.seconds.motion);
    motion_.Observe(scan, interval.in_transit != in_transit_);
  }
  const auto floor = static_cast<FloorId>(interval.level);
  if (result_.graph.nodes().empty()) {
    // Node 0 is a scan-matching node at the start (III-B); a drive that starts in transit has none.
    in_transit_ = interval.in_transit;
    AddNode(scan.stamp, floor, in_transit_ ? nullptr : PointsInRobot(scan), EdgeKind::kOdometry);
  } else {
    ChangeFloor(interval, scan.stamp);
  }
  if (!in_transit_) {
    {
      const StageTimer timer(result_.seconds.mask);
      mask_->Observe({scan, motion_.T_odom_robot()});
    }
    const Pose2& T_odom_robot = motion_.T_odom_robot();
    const auto distance_from = [&](NodeId node) {
      return Distance(result_.graph.nodes()[static_cast<std::size_t>(node)].T_odom_robot,
                      T_odom_robot);
    };
    const auto last_node = static_cast<NodeId>(result_.graph.nodes().size() - 1);
    const bool far_from_scan_node =
        !last_scan_node_ || distance_from(*last_scan_node_) > options_.nodes.min_edge_length_m;
    if (far_from_scan_node && mask_->Fires()) {
      CloseLoops(AddNode(scan.stamp, floor, PointsInRobot(scan), EdgeKind::kOdometry));
    } else if (distance_from(last_node) > options_.nodes.max_edge_length_m) {
      AddNode(scan.stamp, floor, nullptr, EdgeKind::kOdometry);
    }
  }
  RecordScan(scan, interval);
}

// Exit on the old floor, entry on the new one, both odometry-only (III-B): what lies between them
// is one edge, and the mask starts afresh.
void MaskedMapper::ChangeFloor(const FloorInterval& interval, double stamp) {
  const FloorId old_floor = result_.graph.nodes().back().floor;
  const auto floor = static_cast<FloorId>(interval.level);
  const bool other_floor = floor != old_floor;
  if (!in_transit_ && (interval.in_transit || other_floor)) {
    AddNode(stamp, old_floor, nullptr, EdgeKind::kOdometry);
    in_transit_ = true;
    // On stairs the scene changes step by step, and its far walls hold the way along a flight; a
    // cab's door opens on another floor at once.
    on_stairs_ = interval.in_transit && interval.travelled_m > options_.nodes.cab_m;
    if (!on_stairs_) motion_.EnterTransit();
  }
  if (in_transit_ && !interval.in_transit) {
    AddNode(stamp, floor, nullptr, other_floor ? EdgeKind::kFloorChange : EdgeKind::kOdometry);
    in_transit_ = false;
    last_scan_node_.reset();
    mask_->Restart();
    if (!on_stairs_) motion_.RestartScans();
  }
}

UncertainPose2 MaskedMapper::RideInCab(const UncertainPose2& motion) const {
  if (options_.motion.source == MotionSource::kOdometry) return motion;
  UncertainPose2 ride = motion;
  const auto at_most = [&](double most, double variance) {
    return std::min(1.0, most / std::sqrt(std::max(variance, 1e-18)));
  };
  const double position =
      at_most(options_.nodes.ride_sigma_m, motion.covariance.topLeftCorner<2, 2>().trace());
  const double heading = at_most(DegToRad(options_.nodes.ride_sigma_deg), motion.covariance(2, 2));
  const Eigen::DiagonalMatrix<double, 3> scale(position, position, heading);
  ride.covariance = scale * motion.covariance * scale;
  return ride;
}

NodeId MaskedMapper::AddNode(double stamp, FloorId floor, ScanPoints::ConstPtr points_in_robot,
                             EdgeKind kind) {
  PoseGraph& graph = result_.graph;
  Node node;
  node.stamp = stamp;
  node.floor = floor;
  node.T_odom_robot = motion_.T_odom_robot();
  node.points_in_robot = std::move(points_in_robot);
  const bool has_scan = node.HasScan();
  const bool is_first = graph.nodes().empty();
  if (!is_first) {
    node.T_world_robot = graph.nodes().back().T_world_robot * motion_.T_node_robot().mean;
  }
  const NodeId id = graph.AddNode(std::move(node));
  if (!is_first) {
    UncertainPose2 motion = motion_.T_node_robot();
    if (kind == EdgeKind::kFloorChange && !on_stairs_) motion = RideInCab(motion);
    graph.AddEdge({id - 1, id, motion, kind});
  }
  motion_.StartNode();
  if (has_scan) {
    last_scan_node_ = id;
    mask_->OnNode();
  }
  return id;
}

void MaskedMapper::CloseLoops(NodeId new_node) {
  std::vector<Candidate> candidates;
  {
    const StageTimer timer(result_.seconds.projection);
    candidates = FindCandidates(result_.graph, new_node,
                                DijkstraProjection(result_.graph, new_node), options_.candidates);
  }
  const std::vector<Hypothesis> matches = MatchScans(new_node, candidates);
  std::vector<HypothesisId> validated;
  {
    const StageTimer timer(result_.seconds.validation);
    validated = validator_.Judge(result_.graph, matches);
  }
  if (validated.empty()) return;
  AddValidated(validated);
  const StageTimer timer(result_.seconds.optimisation);
  optimizer_.Update(result_.graph);
}

std::vector<Hypothesis> MaskedMapper::MatchScans(NodeId new_node,
                                                 const std::vector<Candidate>& candidates) {
  const StageTimer timer(result_.seconds.matching);
  const std::vector<Node>& nodes = result_.graph.nodes();
  std::vector<MatchPair> pairs;
  for (const Candidate& candidate : candidates) {
    const Node& old_node = nodes[static_cast<std::size_t>(candidate.node)];
    pairs.push_back({candidate.node, old_node.points_in_robot,
                     nodes[static_cast<std::size_t>(new_node)].points_in_robot,
                     Inverse(candidate.T_new_node)});
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
      if (options_.motion.source != MotionSource::kOdometry && !RefineMatch(attempt)) {
        attempt.reason = kDoesNotFit;
      } else if (IsAmbiguous(attempt.T_a_b.covariance, options_.ambiguity)) {
        attempt.reason = kAlikeAlongALine;
      } else {
        attempt.reason = kTooFewVotes;
        attempt_of_hypothesis_.push_back(result_.attempts.size());
        Hypothesis hypothesis;
        hypothesis.a = attempt.a;
        hypothesis.b = attempt.b;
        hypothesis.T_a_b = attempt.T_a_b;
        matches.push_back(hypothesis);
      }
    }
    result_.attempts.push_back(std::move(attempt));
  }
  return matches;
}

bool MaskedMapper::RefineMatch(ClosureAttempt& attempt) {
  const Node& a = result_.graph.nodes()[static_cast<std::size_t>(attempt.a)];
  const std::optional<SubmapMatch> refined =
      submaps_.Refine(attempt.b, *a.points_in_robot, Inverse(attempt.T_a_b));
  if (!refined) return false;
  attempt.T_a_b = Inverse(refined->T_node_robot);
  attempt.agreement = refined->inlier_share;
  return true;
}

void MaskedMapper::AddValidated(const std::vector<HypothesisId>& validated) {
  for (const HypothesisId id : validated) {
    const Hypothesis& hypothesis = validator_.hypotheses()[static_cast<std::size_t>(id)];
    const EdgeId edge =
        result_.graph.AddEdge({hypothesis.a, hypothesis.b, hypothesis.T_a_b, EdgeKind::kClosure});
    attempt_of_edge_[edge] = attempt_of_hypothesis_[static_cast<std::size_t>(id)];
    ClosureAttempt& attempt = result_.attempts[attempt_of_edge_[edge]];
    attempt.state = ClosureState::kValidated;
    attempt.reason = "enough votes";
  }
}

void MaskedMapper::RecordScan(const LaserScan& scan, const FloorInterval& interval) {
  const Pose2& T_odom_robot = motion_.T_odom_robot();
  const bool is_first = result_.trajectory.empty();
  if (!is_first) {
    travelled_since_kept_m_ += Distance(result_.trajectory.back().T_odom_robot, T_odom_robot);
  }
  TrajectoryPose pose;
  pose.stamp = scan.stamp;
  pose.node_before = static_cast<NodeId>(result_.graph.nodes().size() - 1);
  pose.floor = static_cast<FloorId>(interval.level);
  pose.in_transit = interval.in_transit;
  pose.T_odom_robot = T_odom_robot;
  result_.trajectory.push_back(pose);
  if (interval.in_transit) return;
  const bool turned =
      !result_.kept_scans.empty() &&
      std::abs(WrapAngle(
          T_odom_robot.theta -
          result_.trajectory[result_.kept_scans.back().trajectory_index].T_odom_robot.theta)) >=
          DegToRad(options_.nodes.kept_scan_angle_deg);
  if (result_.kept_scans.empty() || turned ||
      travelled_since_kept_m_ >= options_.nodes.kept_scan_distance_m) {
    result_.kept_scans.push_back({result_.trajectory.size() - 1, scan});
    travelled_since_kept_m_ = 0.0;
  }
}

// What too few loops spoke for while the map was being made is looked at once more in the map that
// came of it: the pair is matched again from its optimised poses, and enters where that moves it by
// next to nothing.
void MaskedMapper::Polish() {
  std::vector<std::size_t> open;
  for (std::size_t i = 0; i < result_.attempts.size(); ++i) {
    if (result_.attempts[i].reason == kTooFewVotes) open.push_back(i);
  }
  // By the older node: its submap is built once.
  std::stable_sort(open.begin(), open.end(), [&](std::size_t one, std::size_t other) {
    return result_.attempts[one].b < result_.attempts[other].b;
  });
  const double most_m = options_.polish.most_m;
  const double most_rad = DegToRad(options_.polish.most_deg);
  for (const std::size_t i : open) {
    ClosureAttempt& attempt = result_.attempts[i];
    if (!FitsTheMap(attempt)) continue;
    UncertainPose2 guess;
    guess.mean = MapBetween(attempt.b, attempt.a);
    guess.covariance.diagonal() << most_m * most_m, most_m * most_m, most_rad * most_rad;
    const std::optional<SubmapMatch> again =
        submaps_.Refine(attempt.b, *submaps_.PointsAt(attempt.a), guess);
    if (!again) continue;
    ClosureAttempt late = attempt;
    late.T_a_b = Inverse(again->T_node_robot);
    late.agreement = again->inlier_share;
    if (!FitsTheMap(late) || IsAmbiguous(late.T_a_b.covariance, options_.ambiguity)) continue;
    EnterLate(i, late);
    attempt = late;
  }
}

bool MaskedMapper::FitsTheMap(const ClosureAttempt& attempt) const {
  const Pose2 T_map_a_b = MapBetween(attempt.a, attempt.b);
  return Distance(attempt.T_a_b.mean, T_map_a_b) <= options_.polish.most_m &&
         std::abs(WrapAngle(attempt.T_a_b.mean.theta - T_map_a_b.theta)) <=
             DegToRad(options_.polish.most_deg);
}

Pose2 MaskedMapper::MapBetween(NodeId from, NodeId to) const {
  const std::vector<Node>& nodes = result_.graph.nodes();
  return Between(nodes[static_cast<std::size_t>(from)].T_world_robot,
                 nodes[static_cast<std::size_t>(to)].T_world_robot);
}

// From the map, and as sure as the surest way through the graph; none where that cannot vouch for a
// closure.
std::optional<UncertainPose2> MaskedMapper::SureWay(NodeId from, NodeId to) const {
  for (const ProjectedNode& projected :
       DijkstraProjection(result_.graph, from, {options_.validator.sure_loop_trace})) {
    if (projected.node != to) continue;
    return UncertainPose2{MapBetween(from, to), projected.T_source_node.covariance};
  }
  return std::nullopt;
}

void MaskedMapper::EnterLate(std::size_t place, ClosureAttempt& attempt) {
  attempt.state = ClosureState::kValidated;
  attempt.reason = kFitsTheMap;
  attempt_of_edge_[result_.graph.AddEdge(
      {attempt.a, attempt.b, attempt.T_a_b, EdgeKind::kClosure})] = place;
}

// Corridors between masked places, passed again: what no mask offered is offered now, where the map
// has two nodes at one place and no walk along the graph says so. A sure way through the graph has
// to vouch for it, as in the validator; it may also say how far along where a place looks alike
// along a line, but is not counted again in the closure.
void MaskedMapper::CloseOpenRevisits() {
  const std::vector<Edge>& edges = result_.graph.edges();
  const bool any_closed = std::any_of(
      edges.begin(), edges.end(), [](const Edge& edge) { return edge.kind == EdgeKind::kClosure; });
  if (!any_closed) return;  // dead reckoning stays what it is
  const OpenRevisits revisits(result_.graph, options_.polish.revisits);
  for (NodeId a = 0; static_cast<std::size_t>(a) < result_.graph.nodes().size(); ++a) {
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

bool MaskedMapper::CloseRevisit(NodeId a, NodeId b) {
  const std::optional<UncertainPose2> sure_way = SureWay(b, a);
  if (!sure_way) return false;
  const UncertainPose2& T_b_a = *sure_way;
  const MatchPair pair{b, submaps_.PointsAt(b), submaps_.PointsAt(a), T_b_a};
  if (!pair.points_in_reference || !pair.points_in_query) return false;
  const MatchResult match = matcher_.Match({pair}).front();
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
  } else if (const auto refined = submaps_.Refine(b, *pair.points_in_query, T_b_a)) {
    attempt.state = ClosureState::kHypothesis;
    attempt.T_a_b = Inverse(refined->T_node_robot);
    attempt.agreement = refined->inlier_share;
    const Eigen::Matrix3d both =
        (refined->T_node_robot.covariance.inverse() + T_b_a.covariance.inverse()).inverse();
    if (!FitsTheMap(attempt)) {
      attempt.reason = "disagrees with the optimised map";
    } else if (IsAmbiguous(both, options_.ambiguity)) {
      attempt.reason = kAlikeAlongALine;
    } else {
      EnterLate(result_.attempts.size(), attempt);
    }
  } else {
    attempt.state = ClosureState::kHypothesis;
    attempt.reason = kDoesNotFit;
  }
  const bool closed = attempt.state == ClosureState::kValidated;
  result_.attempts.push_back(std::move(attempt));
  return closed;
}

// With all closures in, those that disagree with the rest go before the map is written.
void MaskedMapper::Audit() {
  const StageTimer timer(result_.seconds.optimisation);
  Optimize(options_.optimizer.solver, result_.graph);
  if (options_.motion.source != MotionSource::kOdometry) {
    Polish();
    CloseOpenRevisits();
    Optimize(options_.optimizer.solver, result_.graph);
  }
  const std::vector<EdgeId> wrong =
      AuditClosures(options_.audit, options_.optimizer.solver, result_.graph);
  if (wrong.empty()) return;
  for (auto edge = wrong.rbegin(); edge != wrong.rend(); ++edge) {
    ClosureAttempt& attempt = result_.attempts[attempt_of_edge_.at(*edge)];
    attempt.state = ClosureState::kAuditedOut;
    attempt.reason = "disagrees with the optimised map";
    result_.graph.RemoveEdge(*edge);
  }
  Optimize(options_.optimizer.solver, result_.graph);
}

MappingResult MaskedMapper::Finish() {
  const std::vector<Hypothesis>& hypotheses = validator_.hypotheses();
  for (std::size_t i = 0; i < hypotheses.size(); ++i) {
    result_.attempts[attempt_of_hypothesis_[i]].votes = hypotheses[i].votes;
  }
  Audit();
  BendTrajectory(result_.graph, result_.trajectory);
  return std::move(result_);
}

}  // namespace masked_mapper
