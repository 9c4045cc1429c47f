// SPDX-License-Identifier: BSD-3-Clause
#include "validator.hpp"

#include <algorithm>
#include <cmath>

#include "masked_mapper/geometry/uncertain_pose2.hpp"
#include "masked_mapper/text/check.hpp"

namespace masked_mapper {
namespace {

constexpr double kNoLimit = std::numeric_limits<double>::infinity();

// Closures without a sure validated way to confirm them need agreement from several places, since
// what looks alike at one place rarely goes on looking alike. Ours: `places_needed` for every
// started multiple of the accepted loop error that the best validated way is off (the first is free
// where that way is sure), and one more for every doubling of its uncertainty beyond 5 m, as more
// look-alikes lie within reach. `loop` is closed by the best validated way.
int PlacesNeeded(const ValidatorOptions& options, const UncertainPose2& loop, double loop_error) {
  const bool sure = loop.covariance.trace() <= options.max_loop_trace;
  const double surprises = std::max(1.0, std::ceil(loop_error / options.max_loop_error));
  const int needed = options.places_needed * (static_cast<int>(surprises) - (sure ? 1 : 0));
  constexpr double kWideTrace = 50.0;  // 5 m each way
  const double doublings = 0.5 * std::log2(std::max(1.0, loop.covariance.trace() / kWideTrace));
  return needed + (needed > 0 ? static_cast<int>(std::ceil(doublings)) : 0);
}

}  // namespace

ValidatorOptions PaperRule(ValidatorOptions options) {
  options.rule = ValidatorRule::kPaper;
  options.max_loop_trace = kNoLimit;
  options.tight_loop_trace = kNoLimit;
  options.sure_loop_trace = 0.0;
  options.places_needed = 0;
  options.max_contradiction = kNoLimit;
  return options;
}

ValidatorOptions Settled(const ValidatorOptions& options, bool laid_out_by_scans) {
  if (options.rule == ValidatorRule::kPaper) return PaperRule(options);
  ValidatorOptions settled = options;
  if (!laid_out_by_scans) settled.max_loop_trace = settled.tight_loop_trace = kNoLimit;
  return settled;
}

LoopValidator::LoopValidator(const ValidatorOptions& options) : options_(options) {}

std::vector<ClosureId> LoopValidator::Judge(const PoseGraph& graph,
                                            const std::vector<ClosureId>& matches,
                                            std::vector<Closure>& closures) {
  newly_valid_.clear();
  standings_.resize(closures.size());
  int known_ties = ties_;
  for (const ClosureId id : matches) {
    // One after the other, so that a loop is met once: when the last of its closures is judged.
    const Closure& match = closures[static_cast<std::size_t>(id)];
    const auto nodes = static_cast<NodeId>(graph.nodes().size());
    Check(match.older >= 0 && match.newer >= 0 && match.older < nodes && match.newer < nodes &&
              match.older != match.newer,
          "the ends of a match are two nodes of the graph");
    StandingOf(id).places = {match.newer};
    JudgeOne(graph, id, closures);
    search_.Add(id, match);
  }
  // What entered without a sure way may be the sure way that others were waiting for.
  while (known_ties != ties_) {
    known_ties = ties_;
    const std::vector<ClosureId> waiting = waiting_;
    for (const ClosureId id : waiting) Admit(graph, id, closures);
  }
  for (const ClosureId id : newly_valid_) {
    search_.Drop(id, closures[static_cast<std::size_t>(id)]);
  }
  std::sort(newly_valid_.begin(), newly_valid_.end());
  return newly_valid_;
}

void LoopValidator::JudgeOne(const PoseGraph& graph, ClosureId id, std::vector<Closure>& closures) {
  Closure& judged = closures[static_cast<std::size_t>(id)];
  RemovedSteps removed;
  std::vector<std::vector<ClosureId>> heard;  // companions of loose loops
  for (int loops = 0; loops < options_.max_loops; ++loops) {
    if (judged.state == ClosureState::kValidated) return;
    if (judged.votes == 0 && loops >= options_.hopeless_loops) return;
    const std::optional<LeastErrorPath> path =
        search_.Find(graph, closures, judged.newer, judged.older, options_.max_loop_trace, removed);
    if (!path) return;
    removed.Add(MostRedundantStep(*path));

    const UncertainPose2 loop = path->T_from_to * judged.T_older_newer;
    const double trace = loop.covariance.trace();
    if (trace > options_.max_loop_trace) continue;
    if (MahalanobisFromIdentity(loop) >= options_.max_loop_error) continue;
    std::vector<ClosureId> agreeing;
    for (const PathStep& step : path->steps) {
      if (step.closure < 0) continue;
      const Closure& closure = closures[static_cast<std::size_t>(step.closure)];
      if (closure.state != ClosureState::kValidated) agreeing.push_back(step.closure);
    }
    std::sort(agreeing.begin(), agreeing.end());
    const bool tight = trace <= options_.tight_loop_trace;
    if (!tight) {
      if (std::find(heard.begin(), heard.end(), agreeing) != heard.end()) continue;
      heard.push_back(agreeing);
    }
    agreeing.push_back(id);
    // Where the way knows more than the match, there is nothing to gain by a hurry.
    if (path->unvalidated == 0 && trace <= options_.sure_loop_trace &&
        judged.T_older_newer.covariance.trace() <= path->T_from_to.covariance.trace()) {
      judged.votes = std::max(judged.votes, options_.votes_needed - 1);
    }
    CountLoop(graph, agreeing, tight, closures);
  }
}

void LoopValidator::CountLoop(const PoseGraph& graph, const std::vector<ClosureId>& agreeing,
                              bool tight, std::vector<Closure>& closures) {
  const auto position = [&](NodeId node) { return graph.node(node).T_world_robot; };
  for (const ClosureId one : agreeing) {
    std::vector<NodeId>& places = StandingOf(one).places;
    for (const ClosureId other : agreeing) {
      const NodeId place = closures[static_cast<std::size_t>(other)].newer;
      const bool far = std::all_of(places.begin(), places.end(), [&](NodeId known) {
        return Distance(position(known), position(place)) > options_.place_radius_m;
      });
      if (far) places.push_back(place);
    }
  }
  for (const ClosureId one : agreeing) {
    Standing& standing = StandingOf(one);
    if (!tight && standing.loose_votes >= options_.max_loose_votes) continue;
    if (!tight) ++standing.loose_votes;
    if (++closures[static_cast<std::size_t>(one)].votes == options_.votes_needed) {
      waiting_.push_back(one);
    }
    Admit(graph, one, closures);
  }
}

void LoopValidator::Admit(const PoseGraph& graph, ClosureId id, std::vector<Closure>& closures) {
  Closure& closure = closures[static_cast<std::size_t>(id)];
  if (closure.state == ClosureState::kValidated || closure.votes < options_.votes_needed) return;
  Standing& standing = StandingOf(id);
  if (standing.refused_with_places == standing.places.size() &&
      standing.refused_with_ties == ties_) {
    return;
  }
  if (!MayEnter(graph, id, closures)) {
    standing.refused_with_places = standing.places.size();
    standing.refused_with_ties = ties_;
    return;
  }
  closure.state = ClosureState::kValidated;
  closure.reason = ClosureReason::kEnoughVotes;
  newly_valid_.push_back(id);
  waiting_.erase(std::remove(waiting_.begin(), waiting_.end(), id), waiting_.end());
}

// Beside the votes: what the best validated way says of the closure. The sure ways are looked at
// first, since a search without limit costs as much as the map is large.
bool LoopValidator::MayEnter(const PoseGraph& graph, ClosureId id,
                             const std::vector<Closure>& closures) {
  const Closure& closure = closures[static_cast<std::size_t>(id)];
  const int places = static_cast<int>(StandingOf(id).places.size());
  for (const double max_trace : {options_.max_loop_trace, kNoLimit}) {
    if (max_trace == kNoLimit && places < options_.places_needed) return false;
    const std::optional<LeastErrorPath> path =
        search_.Find(graph, closures, closure.newer, closure.older, max_trace, RemovedSteps());
    if (!path || path->unvalidated > 0) {
      if (max_trace == kNoLimit) break;
      continue;
    }
    const UncertainPose2 loop = path->T_from_to * closure.T_older_newer;
    const double error = MahalanobisFromIdentity(loop);
    const bool enters =
        error <= options_.max_contradiction && places >= PlacesNeeded(options_, loop, error);
    ties_ += enters && max_trace == kNoLimit ? 1 : 0;
    return enters;
  }
  // No validated way at all: two maps that only unvalidated closures join.
  const bool enters = places >= 2 * options_.places_needed;
  ties_ += enters ? 1 : 0;
  return enters;
}

}  // namespace masked_mapper
