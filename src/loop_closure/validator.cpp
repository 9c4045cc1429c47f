// SPDX-License-Identifier: BSD-3-Clause
#include "masked_mapper/loop_closure/validator.hpp"

#include <algorithm>
#include <cstdlib>

#include "masked_mapper/geometry/mahalanobis.hpp"

namespace masked_mapper {

LoopValidator::LoopValidator(const ValidatorOptions& options) : options_(options) {}

std::vector<HypothesisId> LoopValidator::Judge(const PoseGraph& graph,
                                               const std::vector<Hypothesis>& matches) {
  newly_valid_.clear();
  // One after the other, so that a loop is met once: when the last of its hypotheses is judged.
  for (const Hypothesis& match : matches) {
    const auto id = static_cast<HypothesisId>(hypotheses_.size());
    hypotheses_.push_back({match.a, match.b, match.T_a_b, 0, false});
    JudgeOne(graph, id);
    search_.Add(id, hypotheses_.back());
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
  std::vector<std::vector<HypothesisId>> heard;
  for (int i = 0; i < options_.max_loops && !hypotheses_[static_cast<std::size_t>(id)].validated;
       ++i) {
    const std::optional<LeastErrorPath> path =
        search_.Find(graph, hypotheses_, judged.a, judged.b, options_.max_loop_trace, removed);
    if (!path) break;
    const UncertainPose2 loop = path->T_from_to * T_b_a;
    const double trace = loop.covariance.trace();
    if (trace <= options_.max_loop_trace &&
        MahalanobisFromIdentity(loop) < options_.max_loop_error) {
      std::vector<HypothesisId> companions;
      for (const PathStep& step : path->steps) {
        if (step.hypothesis >= 0 &&
            !hypotheses_[static_cast<std::size_t>(step.hypothesis)].validated) {
          companions.push_back(step.hypothesis);
        }
      }
      std::sort(companions.begin(), companions.end());
      const bool fresh = trace <= options_.tight_loop_trace ||
                         std::find(heard.begin(), heard.end(), companions) == heard.end();
      if (fresh) {
        heard.push_back(companions);
        Vote(graph, id);
        for (const HypothesisId companion : companions) Vote(graph, companion);
      }
    }
    removed.Add(MostRedundantStep(*path));
  }
}

void LoopValidator::Vote(const PoseGraph& graph, HypothesisId id) {
  Hypothesis& hypothesis = hypotheses_[static_cast<std::size_t>(id)];
  ++hypothesis.votes;
  if (hypothesis.validated || hypothesis.votes < options_.votes_needed) return;
  if (Contradicted(graph, hypothesis)) return;
  hypothesis.validated = true;
  newly_valid_.push_back(id);
}

bool LoopValidator::Contradicted(const PoseGraph& graph, const Hypothesis& hypothesis) {
  const std::optional<LeastErrorPath> path = search_.Find(
      graph, hypotheses_, hypothesis.a, hypothesis.b, options_.max_loop_trace, RemovedSteps());
  if (!path || path->unvalidated > 0) return false;
  return MahalanobisFromIdentity(path->T_from_to * Inverse(hypothesis.T_a_b)) >
         options_.max_contradiction;
}

}  // namespace masked_mapper
