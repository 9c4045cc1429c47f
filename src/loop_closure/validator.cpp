// SPDX-License-Identifier: BSD-3-Clause
#include "masked_mapper/loop_closure/validator.hpp"

#include <algorithm>
#include <cmath>
#include <cstdlib>

#include "masked_mapper/geometry/mahalanobis.hpp"

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

ValidatorOptions PaperRule() {
  ValidatorOptions options;
  options.max_loop_trace = kNoLimit;
  options.tight_loop_trace = kNoLimit;
  options.sure_loop_trace = 0.0;
  options.places_needed = 0;
  options.max_contradiction = kNoLimit;
  return options;
}

LoopValidator::LoopValidator(const ValidatorOptions& options) : options_(options) {}

std::vector<HypothesisId> LoopValidator::Judge(const PoseGraph& graph,
                                               const std::vector<Hypothesis>& matches) {
  newly_valid_.clear();
  int known_ties = ties_;
  const auto is_node = [&](NodeId id) {
    return id >= 0 && static_cast<std::size_t>(id) < graph.nodes().size();
  };
  for (const Hypothesis& match : matches) {
    if (!is_node(match.a) || !is_node(match.b) || match.a == match.b) std::abort();
    // One after the other, so that a loop is met once: when the last of its closures is judged.
    const auto id = static_cast<HypothesisId>(hypotheses_.size());
    hypotheses_.push_back({match.a, match.b, match.T_a_b, 0, false});
    standings_.push_back({0, {match.a}});
    JudgeOne(graph, id);
    search_.Add(id, hypotheses_.back());
  }
  // What entered without a sure way may be the sure way that others were waiting for.
  while (known_ties != ties_) {
    known_ties = ties_;
    const std::vector<HypothesisId> waiting = waiting_;
    for (const HypothesisId id : waiting) Admit(graph, id);
  }
  for (const HypothesisId id : newly_valid_) {
    search_.Drop(id, hypotheses_[static_cast<std::size_t>(id)]);
  }
  std::sort(newly_valid_.begin(), newly_valid_.end());
  return newly_valid_;
}

void LoopValidator::JudgeOne(const PoseGraph& graph, HypothesisId id) {
  const Hypothesis judged = hypotheses_[static_cast<std::size_t>(id)];
  const UncertainPose2 T_b_a = Inverse(judged.T_a_b);
  RemovedSteps removed;
  std::vector<std::vector<HypothesisId>> heard;  // companions of loose loops
  for (int loops = 0; loops < options_.max_loops; ++loops) {
    const Hypothesis& now = hypotheses_[static_cast<std::size_t>(id)];
    if (now.validated || (now.votes == 0 && loops >= options_.hopeless_loops)) return;
    const std::optional<LeastErrorPath> path =
        search_.Find(graph, hypotheses_, judged.a, judged.b, options_.max_loop_trace, removed);
    if (!path) return;
    removed.Add(MostRedundantStep(*path));

    const UncertainPose2 loop = path->T_from_to * T_b_a;
    const double trace = loop.covariance.trace();
    if (trace > options_.max_loop_trace) continue;
    if (MahalanobisFromIdentity(loop) >= options_.max_loop_error) continue;
    std::vector<HypothesisId> agreeing;
    for (const PathStep& step : path->steps) {
      if (step.hypothesis < 0) continue;
      if (hypotheses_[static_cast<std::size_t>(step.hypothesis)].validated) continue;
      agreeing.push_back(step.hypothesis);
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
        judged.T_a_b.covariance.trace() <= path->T_from_to.covariance.trace()) {
      int& votes = hypotheses_[static_cast<std::size_t>(id)].votes;
      votes = std::max(votes, options_.votes_needed - 1);
    }
    CountLoop(graph, agreeing, tight);
  }
}

void LoopValidator::CountLoop(const PoseGraph& graph, const std::vector<HypothesisId>& agreeing,
                              bool tight) {
  const auto position = [&](NodeId node) {
    return graph.nodes()[static_cast<std::size_t>(node)].T_world_robot;
  };
  for (const HypothesisId one : agreeing) {
    std::vector<NodeId>& places = standings_[static_cast<std::size_t>(one)].places;
    for (const HypothesisId other : agreeing) {
      const NodeId place = hypotheses_[static_cast<std::size_t>(other)].a;
      const bool far = std::all_of(places.begin(), places.end(), [&](NodeId known) {
        return Distance(position(known), position(place)) > options_.place_radius_m;
      });
      if (far) places.push_back(place);
    }
  }
  for (const HypothesisId one : agreeing) {
    Standing& standing = standings_[static_cast<std::size_t>(one)];
    if (!tight && standing.loose_votes >= options_.max_loose_votes) continue;
    if (!tight) ++standing.loose_votes;
    if (++hypotheses_[static_cast<std::size_t>(one)].votes == options_.votes_needed) {
      waiting_.push_back(one);
    }
    Admit(graph, one);
  }
}

void LoopValidator::Admit(const PoseGraph& graph, HypothesisId id) {
  Hypothesis& hypothesis = hypotheses_[static_cast<std::size_t>(id)];
  if (hypothesis.validated || hypothesis.votes < options_.votes_needed) return;
  Standing& standing = standings_[static_cast<std::size_t>(id)];
  if (standing.refused_with_places == standing.places.size() &&
      standing.refused_with_ties == ties_) {
    return;
  }
  if (!MayEnter(graph, id)) {
    standing.refused_with_places = standing.places.size();
    standing.refused_with_ties = ties_;
    return;
  }
  hypothesis.validated = true;
  newly_valid_.push_back(id);
  waiting_.erase(std::remove(waiting_.begin(), waiting_.end(), id), waiting_.end());
}

// Beside the votes: what the best validated way says of the closure. The sure ways are looked at
// first, since a search without limit costs as much as the map is large.
bool LoopValidator::MayEnter(const PoseGraph& graph, HypothesisId id) {
  const Hypothesis& hypothesis = hypotheses_[static_cast<std::size_t>(id)];
  const int places = static_cast<int>(standings_[static_cast<std::size_t>(id)].places.size());
  for (const double max_trace : {options_.max_loop_trace, kNoLimit}) {
    if (max_trace == kNoLimit && places < options_.places_needed) return false;
    const std::optional<LeastErrorPath> path =
        search_.Find(graph, hypotheses_, hypothesis.a, hypothesis.b, max_trace, RemovedSteps());
    if (!path || path->unvalidated > 0) continue;
    const UncertainPose2 loop = path->T_from_to * Inverse(hypothesis.T_a_b);
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
