// SPDX-License-Identifier: BSD-3-Clause
#include "vote_validator.hpp"

#include <algorithm>
#include <optional>

#include "masked_mapper/geometry/uncertain_pose2.hpp"
#include "masked_mapper/text/check.hpp"

namespace masked_mapper {

VoteValidator::VoteValidator(const ValidatorOptions& options) : options_(options) {}

std::vector<ClosureId> VoteValidator::Judge(const PoseGraph& graph,
                                            const std::vector<ClosureId>& matches,
                                            std::vector<Closure>& closures) {
  newly_valid_.clear();
  for (const ClosureId id : matches) {
    // One after the other, so that a loop is met once: when the last of its closures is judged.
    const Closure& match = closures[static_cast<std::size_t>(id)];
    const auto nodes = static_cast<NodeId>(graph.nodes().size());
    Check(match.older >= 0 && match.newer >= 0 && match.older < nodes && match.newer < nodes &&
              match.older != match.newer,
          "the ends of a match are two nodes of the graph");
    JudgeOne(graph, id, closures);
    search_.Add(id, match);
  }
  for (const ClosureId id : newly_valid_) {
    search_.Drop(id, closures[static_cast<std::size_t>(id)]);
  }
  std::sort(newly_valid_.begin(), newly_valid_.end());
  return newly_valid_;
}

void VoteValidator::JudgeOne(const PoseGraph& graph, ClosureId id, std::vector<Closure>& closures) {
  const Closure& judged = closures[static_cast<std::size_t>(id)];
  RemovedSteps removed;
  for (int loops = 0; loops < options_.max_loops; ++loops) {
    if (judged.state == ClosureState::kValidated) return;
    if (judged.votes == 0 && loops >= options_.hopeless_loops) return;
    const std::optional<LeastErrorPath> path =
        search_.Find(graph, closures, judged.newer, judged.older, removed);
    if (!path) return;
    removed.Add(MostRedundantStep(*path));
    const UncertainPose2 loop = path->T_from_to * judged.T_older_newer;
    if (MahalanobisFromIdentity(loop) >= options_.max_loop_error) continue;
    for (const PathStep& step : path->steps) {
      if (step.closure >= 0) Vote(step.closure, closures);
    }
    Vote(id, closures);
  }
}

void VoteValidator::Vote(ClosureId id, std::vector<Closure>& closures) {
  Closure& closure = closures[static_cast<std::size_t>(id)];
  if (closure.state == ClosureState::kValidated || ++closure.votes < options_.votes_needed) return;
  closure.state = ClosureState::kValidated;
  closure.reason = ClosureReason::kEnoughVotes;
  newly_valid_.push_back(id);
}

}  // namespace masked_mapper
