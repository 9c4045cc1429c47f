// SPDX-License-Identifier: BSD-3-Clause
// Loop validation as in the paper (Section III-E): a match is a hypothesis until enough loops agree
// with it. Close the path of least error between the ends of a hypothesis into a loop with it; if
// the loop's Mahalanobis distance from the identity is small, the hypothesis and every other
// unvalidated closure on the path get a vote; take the most redundant edge of the path away and try
// again, until there are votes enough or no path is left.
//
// It counts the same evidence several times (ways that share their uncertain part, closures of one
// place) and takes a vote from loops so uncertain that anything agrees; where places look alike,
// that lets groups of wrong closures in. evidence_validator.hpp is what we do instead.
#pragma once

#include <vector>

#include "loop_search.hpp"
#include "masked_mapper/loop_closure/loop_closure_options.hpp"
#include "masked_mapper/pose_graph/pose_graph.hpp"

namespace masked_mapper {

class VoteValidator {
 public:
  explicit VoteValidator(const ValidatorOptions& options);

  /// Judges matches, ids of `closures` that are hypotheses there, over the graph's odometry,
  /// floor-change and validated closure edges and over the hypotheses judged before. Counts votes;
  /// closures that became valid by this call (of `matches`, or older ones that got their last vote)
  /// are so in `closures`, and returned in order of ids. The caller adds their edges to the graph
  /// before the next call.
  std::vector<ClosureId> Judge(const PoseGraph& graph, const std::vector<ClosureId>& matches,
                               std::vector<Closure>& closures);

  /// The state, for a checkpoint (sensor/state_archive.hpp); `closures` as given to Judge().
  template <class Archive>
  void Serialize(Archive& archive, const std::vector<Closure>& closures) {
    search_.Serialize(archive, closures);
  }

 private:
  void JudgeOne(const PoseGraph& graph, ClosureId id, std::vector<Closure>& closures);
  void Vote(ClosureId id, std::vector<Closure>& closures);

  ValidatorOptions options_;
  LoopSearch search_;
  std::vector<ClosureId> newly_valid_;  // of the running call
};

}  // namespace masked_mapper
