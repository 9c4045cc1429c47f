// SPDX-License-Identifier: BSD-3-Clause
#include "masked_mapper/loop_closure/loop_closer.hpp"

#include <algorithm>
#include <cmath>
#include <optional>
#include <set>
#include <utility>
#include <variant>

#include "evidence_validator.hpp"
#include "loop_evidence.hpp"
#include "masked_mapper/geometry/uncertain_pose2.hpp"
#include "masked_mapper/loop_closure/closure_matcher.hpp"
#include "masked_mapper/map/building_map.hpp"
#include "masked_mapper/optimization/pose_graph_optimizer.hpp"
#include "open_revisits.hpp"
#include "submaps.hpp"
#include "vote_validator.hpp"

namespace masked_mapper {

namespace {

using Validator = std::variant<EvidenceValidator, VoteValidator>;

Validator ValidatorFor(const ValidatorOptions& options) {
  if (options.rule == ValidatorRule::kPaper) return VoteValidator(options);
  return EvidenceValidator();
}

}  // namespace

class LoopCloser::Impl {
 public:
  Impl(const LoopClosureOptions& options, BuildingMap& map, ReferencePoints reference);

  std::size_t Close(NodeId new_node, const std::vector<Candidate>& candidates);
  void Finish();

  template <class Archive>
  void Serialize(Archive& archive) {
    std::visit([&](auto& validator) { validator.Serialize(archive, map_.closures); }, validator_);
    archive(optimizer_);
  }

 private:
  using NodePairs = std::set<std::pair<NodeId, NodeId>>;  ///< older, newer

  std::vector<ClosureId> MatchScans(NodeId new_node, const std::vector<Candidate>& candidates);
  ScanPoints::ConstPtr PointsOfOlder(NodeId node) const {
    return reference_ ? reference_(node) : matcher_.submaps().PointsAt(node);
  }
  std::size_t Validate(std::vector<ClosureId> matches);
  void Solve();
  void CloseLate();
  void CloseOpenVotes();
  void CloseLateByWheels();
  /// Of pairs that are not among `tried`, which they become. Returns how many closed.
  std::size_t CloseOpenRevisits(NodePairs& tried);
  bool CloseRevisit(NodeId newer, NodeId older);
  bool CanBeOne(const Closure& closure) const;
  bool FitsTheMap(const Closure& closure) const;
  Pose2 MapBetween(NodeId from, NodeId to) const;
  std::optional<UncertainPose2> WayBetween(NodeId from, NodeId to) const;
  void EnterLate(ClosureId id);
  void Audit();

  const LoopClosureOptions& options_;
  BuildingMap& map_;
  ReferencePoints reference_;
  ClosureMatcher matcher_;
  ClosureMatcher late_matcher_;  ///< its references are other points of the same nodes
  Validator validator_;
  PoseGraphOptimizer optimizer_;
  NodePairs forbidden_;  ///< by hand
};

LoopCloser::Impl::Impl(const LoopClosureOptions& options, BuildingMap& map,
                       ReferencePoints reference)
    : options_(options),
      map_(map),
      reference_(std::move(reference)),
      matcher_(options.matcher, options.submaps, options.ambiguity, options.refine, map),
      late_matcher_(options.matcher, options.submaps, options.ambiguity, options.refine, map),
      validator_(ValidatorFor(options.validator)),
      optimizer_(options.optimizer) {
  for (const Closure& closure : map.closures) {
    if (closure.reason == ClosureReason::kForbiddenByHand) {
      forbidden_.emplace(closure.older, closure.newer);
    }
  }
}

std::size_t LoopCloser::Impl::Close(NodeId new_node, const std::vector<Candidate>& candidates) {
  const std::size_t validated = Validate(MatchScans(new_node, candidates));
  if (validated == 0) return 0;
  const StageTimer timer(map_.seconds.optimisation);
  optimizer_.Update(map_.graph);
  return validated;
}

// What entered is a way that others may have been waiting for.
std::size_t LoopCloser::Impl::Validate(std::vector<ClosureId> matches) {
  const StageTimer timer(map_.seconds.validation);
  std::size_t count = 0;
  while (true) {
    const std::vector<ClosureId> validated = std::visit(
        [&](auto& validator) { return validator.Judge(map_.graph, matches, map_.closures); },
        validator_);
    if (validated.empty()) return count;
    for (const ClosureId id : validated) AddClosureEdge(map_.closures, id, map_.graph);
    count += validated.size();
    matches.clear();
  }
}

std::vector<ClosureId> LoopCloser::Impl::MatchScans(NodeId new_node,
                                                    const std::vector<Candidate>& candidates) {
  const StageTimer timer(map_.seconds.matching);
  const ScanPoints::ConstPtr points_in_newer = matcher_.submaps().PointsAt(new_node);
  std::vector<ClosureOffer> offers;
  for (const Candidate& candidate : candidates) {
    offers.push_back(
        {candidate.node, new_node, Inverse(candidate.T_new_node), candidate.mahalanobis,
         matcher_.Has(candidate.node) ? nullptr : PointsOfOlder(candidate.node), points_in_newer});
  }
  std::vector<ClosureId> matches;
  for (Closure& closure : matcher_.Match(offers, GuessIs::kAWindow)) {
    if (closure.reason == ClosureReason::kTooFewVotes) {
      matches.push_back(static_cast<ClosureId>(map_.closures.size()));
    }
    map_.closures.push_back(std::move(closure));
  }
  return matches;
}

void LoopCloser::Impl::Solve() {
  const StageTimer timer(map_.seconds.optimisation);
  Optimize(options_.optimizer.solver, map_.graph);
}

void LoopCloser::Impl::CloseLate() {
  const StageTimer timer(map_.seconds.matching);
  CloseOpenVotes();
  matcher_.Forget();  // nothing is matched against single scans any more
  NodePairs tried;
  CloseOpenRevisits(tried);
}

// Wheels alone leave the map sure only about what is closed already. What closes moves the map, and
// brings others near that were not; each pair is tried once.
void LoopCloser::Impl::CloseLateByWheels() {
  constexpr int kMostRounds = 50;
  NodePairs tried;
  for (int round = 0; round < kMostRounds; ++round) {
    std::size_t entered = 0;
    {
      const StageTimer timer(map_.seconds.matching);
      entered = CloseOpenRevisits(tried);
    }
    if (entered == 0) return;
    Solve();
  }
}

// What too few loops spoke for while the map was being made is looked at once more in the map that
// came of it: the pair is matched again from its optimised poses, and enters where that moves it by
// next to nothing.
void LoopCloser::Impl::CloseOpenVotes() {
  std::vector<ClosureId> open;
  for (std::size_t i = 0; i < map_.closures.size(); ++i) {
    const Closure& closure = map_.closures[i];
    if (closure.reason == ClosureReason::kTooFewVotes) open.push_back(static_cast<ClosureId>(i));
  }
  // By the older node: its submap is built once.
  const auto older = [&](ClosureId id) {
    return map_.closures[static_cast<std::size_t>(id)].older;
  };
  std::stable_sort(open.begin(), open.end(),
                   [&](ClosureId one, ClosureId other) { return older(one) < older(other); });
  const double most_m = options_.polish.most_m;
  const double most_rad = DegToRad(options_.polish.most_deg);
  for (const ClosureId id : open) {
    Closure& closure = map_.closures[static_cast<std::size_t>(id)];
    // Drives that do not hang together may have been tried, too: what they have in common by chance
    // says nothing, and their floors are not one.
    if (!CanBeOne(closure) || !FitsTheMap(closure)) continue;
    if (forbidden_.count({closure.older, closure.newer}) != 0) continue;
    const ScanPoints::ConstPtr points_in_newer = matcher_.submaps().PointsAt(closure.newer);
    if (!points_in_newer) continue;
    Closure late = closure;
    late.T_older_newer.mean = MapBetween(closure.older, closure.newer);
    late.T_older_newer.covariance =
        Eigen::Vector3d(most_m * most_m, most_m * most_m, most_rad * most_rad).asDiagonal();
    matcher_.RefineAndBelieve(*points_in_newer, late);
    if (late.reason != ClosureReason::kTooFewVotes || !FitsTheMap(late)) continue;
    closure = late;
    EnterLate(id);
  }
}

bool LoopCloser::Impl::CanBeOne(const Closure& closure) const {
  return closure.older != closure.newer &&
         map_.graph.node(closure.older).floor == map_.graph.node(closure.newer).floor;
}

bool LoopCloser::Impl::FitsTheMap(const Closure& closure) const {
  const Pose2 T_map = MapBetween(closure.older, closure.newer);
  const Pose2& T_match = closure.T_older_newer.mean;
  return Distance(T_match, T_map) <= options_.polish.most_m &&
         std::abs(WrapAngle(T_match.theta - T_map.theta)) <= DegToRad(options_.polish.most_deg);
}

Pose2 LoopCloser::Impl::MapBetween(NodeId from, NodeId to) const {
  return Between(map_.graph.node(from).T_world_robot, map_.graph.node(to).T_world_robot);
}

// From the map, and as sure as the surest way through the graph.
std::optional<UncertainPose2> LoopCloser::Impl::WayBetween(NodeId from, NodeId to) const {
  constexpr double kMostTrace = 2.0;  // the search ends there: less sure, it vouches for nothing
  ProjectionSearch search(map_.graph, from);
  const ProjectedNode* found = search.Find(to, kMostTrace);
  if (found == nullptr) return std::nullopt;
  return UncertainPose2{MapBetween(from, to), found->T_source_node.covariance};
}

void LoopCloser::Impl::EnterLate(ClosureId id) {
  Closure& closure = map_.closures[static_cast<std::size_t>(id)];
  closure.state = ClosureState::kValidated;
  closure.reason = ClosureReason::kFitsTheMap;
  AddClosureEdge(map_.closures, id, map_.graph);
}

// Corridors between masked places, passed again: what no mask offered is offered now, where the map
// has two nodes at one place and no walk along the graph says so. A sure way through the graph has
// to vouch for it, as in the validator.
std::size_t LoopCloser::Impl::CloseOpenRevisits(NodePairs& tried) {
  const std::vector<Edge>& edges = map_.graph.edges();
  const bool any_closed = std::any_of(
      edges.begin(), edges.end(), [](const Edge& edge) { return edge.kind == EdgeKind::kClosure; });
  if (!any_closed) return 0;  // dead reckoning stays what it is
  const OpenRevisits revisits(map_.graph, options_.polish.revisits);
  std::size_t entered = 0;
  for (NodeId newer = 0; static_cast<std::size_t>(newer) < map_.graph.nodes().size(); ++newer) {
    std::vector<NodeId> open = revisits.Of(newer);
    while (!open.empty()) {
      const NodeId older = open.front();
      open.erase(open.begin());
      if (!tried.emplace(older, newer).second || !CloseRevisit(newer, older)) continue;
      ++entered;
      // What closed here may have joined the others, too.
      const std::vector<NodeId> still_open = revisits.Of(newer);
      const auto is_joined = [&](NodeId node) {
        return std::find(still_open.begin(), still_open.end(), node) == still_open.end();
      };
      open.erase(std::remove_if(open.begin(), open.end(), is_joined), open.end());
    }
  }
  return entered;
}

bool LoopCloser::Impl::CloseRevisit(NodeId newer, NodeId older) {
  const std::optional<UncertainPose2> way = WayBetween(older, newer);
  if (!way || forbidden_.count({older, newer}) != 0) return false;
  // By scans, what the map says already may enter: it is as sure as that.
  if (options_.laid_out_by_scans &&
      ChanceToBeWrong({{}, way->covariance}) > std::exp(-kEnoughNats)) {
    return false;
  }
  const ScanPoints::ConstPtr points_in_newer = late_matcher_.submaps().PointsAt(newer);
  if (!points_in_newer) return false;
  const double mahalanobis =
      MahalanobisDistance(way->mean.Translation(), way->covariance.topLeftCorner<2, 2>(),
                          options_.candidates.match_range_m);
  const GuessIs guess =
      options_.laid_out_by_scans ? GuessIs::kAsGoodAsAMatch : GuessIs::kASureWindow;
  // The robot may have come the other way: its scan then shows what lies behind that of the older.
  const ClosureOffer offer{older,
                           newer,
                           *way,
                           mahalanobis,
                           late_matcher_.Has(older) ? nullptr : late_matcher_.PointsAround(older),
                           points_in_newer};
  Closure closure = late_matcher_.Match({offer}, guess).front();
  const bool believed = closure.reason == ClosureReason::kTooFewVotes;
  const bool refined = believed || closure.reason == ClosureReason::kAlikeAlongALine;
  const bool fits = options_.laid_out_by_scans
                        ? FitsTheMap(closure)
                        : LoopEvidence(Inverse(*way) * closure.T_older_newer) >= kEnoughNats;
  if (refined && !fits) closure.reason = ClosureReason::kDisagreesWithTheMap;
  map_.closures.push_back(std::move(closure));
  if (!believed || !fits) return false;
  EnterLate(static_cast<ClosureId>(map_.closures.size() - 1));
  return true;
}

// With all closures in, those that disagree with the rest go before the map is written.
void LoopCloser::Impl::Audit() {
  const StageTimer timer(map_.seconds.optimisation);
  // What somebody added by hand is not for the audit to take away.
  const std::vector<Edge>& edges = map_.graph.edges();
  std::vector<EdgeId> by_hand;
  for (std::size_t i = 0; i < edges.size(); ++i) {
    const ClosureId id = edges[i].closure;
    if (id >= 0 &&
        map_.closures[static_cast<std::size_t>(id)].reason == ClosureReason::kAddedByHand) {
      by_hand.push_back(static_cast<EdgeId>(i));
    }
  }
  const std::vector<EdgeId> wrong =
      AuditClosures(options_.audit, options_.optimizer.solver, map_.graph, by_hand);
  if (wrong.empty()) return;
  for (const EdgeId edge : wrong) {
    const ClosureId id = map_.graph.edge(edge).closure;
    if (id < 0) continue;  // a saved map may hold closures that no record tells of
    Closure& closure = map_.closures[static_cast<std::size_t>(id)];
    closure.state = ClosureState::kAuditedOut;
    closure.reason = ClosureReason::kDisagreesWithTheMap;
  }
  map_.graph.RemoveEdges(wrong);
  Optimize(options_.optimizer.solver, map_.graph);
}

void LoopCloser::Impl::Finish() {
  Solve();
  if (options_.laid_out_by_scans) {
    CloseLate();
    Solve();
  } else {
    matcher_.Forget();
    CloseLateByWheels();
  }
  late_matcher_.Forget();  // this may live as long as what is made of the map
  Audit();
}

LoopCloser::LoopCloser(const LoopClosureOptions& options, BuildingMap& map,
                       ReferencePoints reference)
    : impl_(std::make_unique<Impl>(options, map, std::move(reference))) {}
LoopCloser::~LoopCloser() = default;

std::size_t LoopCloser::Close(NodeId new_node, const std::vector<Candidate>& candidates) {
  return impl_->Close(new_node, candidates);
}

void LoopCloser::Finish() { impl_->Finish(); }

void LoopCloser::Serialize(StateWriter& archive) { impl_->Serialize(archive); }
void LoopCloser::Serialize(StateReader& archive) { impl_->Serialize(archive); }

}  // namespace masked_mapper
