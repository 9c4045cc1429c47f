// SPDX-License-Identifier: BSD-3-Clause
// Loop validation (Section III-E): a match is a hypothesis until enough loops agree with it.
//
// The paper's rule: close the path of least error between the ends of a hypothesis into a loop with
// it; if the loop's Mahalanobis distance from the identity is small, the hypothesis and every other
// unvalidated closure on the path get a vote; take the most redundant edge of the path away and try
// again, until there are votes enough or no path is left.
//
// Alone it counts the same evidence several times (ways that share their uncertain part, closures
// of one place) and takes a vote from loops so uncertain that anything agrees. Where places look
// alike, that lets groups of wrong closures in, so four conditions of ours stand beside it;
// PaperRule() switches them off.
#pragma once

#include <limits>
#include <vector>

#include "loop_search.hpp"
#include "masked_mapper/loop_closure/loop_closure_options.hpp"
#include "masked_mapper/pose_graph/pose_graph.hpp"

namespace masked_mapper {

/// The paper's rule: none of the conditions of ours (the bounds on the number of loops stay).
ValidatorOptions PaperRule(ValidatorOptions options = {});

/// What `options.rule` comes to. The bounds on traces are worth what they say where scans lay out
/// the motion; by wheels alone an honest loop of a corridor exceeds them all, and they are left
/// out.
ValidatorOptions Settled(const ValidatorOptions& options, bool laid_out_by_scans);

class LoopValidator {
 public:
  explicit LoopValidator(const ValidatorOptions& options);

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
    archive(standings_, waiting_, ties_);
    search_.Serialize(archive, closures);
    bool holds = standings_.size() <= closures.size();
    for (const ClosureId id : waiting_) {
      holds = holds && id >= 0 && static_cast<std::size_t>(id) < standings_.size();
    }
    if (!holds) archive.Refuse("standings of closures that there are not");
  }

 private:
  // What is known of a closure beside its votes.
  struct Standing {
    int loose_votes = 0;
    std::vector<NodeId> places;  // newer ends of it and of those that agree with it, far apart
    // The last refusal, so that it is not worked out again while nothing has changed.
    std::size_t refused_with_places = 0;
    int refused_with_ties = -1;

    template <class Archive>
    void Serialize(Archive& archive) {
      archive(loose_votes, places, refused_with_places, refused_with_ties);
    }
  };

  void JudgeOne(const PoseGraph& graph, ClosureId id, std::vector<Closure>& closures);
  void CountLoop(const PoseGraph& graph, const std::vector<ClosureId>& agreeing, bool tight,
                 std::vector<Closure>& closures);
  void Admit(const PoseGraph& graph, ClosureId id, std::vector<Closure>& closures);
  bool MayEnter(const PoseGraph& graph, ClosureId id, const std::vector<Closure>& closures);
  Standing& StandingOf(ClosureId id) { return standings_[static_cast<std::size_t>(id)]; }

  ValidatorOptions options_;
  std::vector<Standing> standings_;  // of the closures, up to the last that was judged
  std::vector<ClosureId> waiting_;   // enough votes, not admitted yet
  LoopSearch search_;
  int ties_ = 0;  // closures admitted without a sure way: each makes new sure ways
  std::vector<ClosureId> newly_valid_;  // of the running call
};

}  // namespace masked_mapper
