// SPDX-License-Identifier: BSD-3-Clause
// Loop validation (Section III-E): a match is a hypothesis until enough loops agree with it.
#pragma once

#include <vector>

#include "masked_mapper/loop_closure/loop_search.hpp"
#include "masked_mapper/pose_graph/pose_graph.hpp"

namespace masked_mapper {

struct ValidatorOptions {
  int votes_needed = 6;  ///< paper: 6
  double max_loop_error =
      2.0;  ///< Mahalanobis distance from identity of an agreeing loop; paper: 2
  /// Trace (m^2 and rad^2) of the covariance beyond which a loop agrees with anything and is no
  /// evidence; the search ends there. Ours.
  double max_loop_trace = 2.0;
  /// Trace up to which a loop is so sure that every one is evidence; a looser one votes once per
  /// set of unvalidated closures on it, since ways that share their uncertain part repeat each
  /// other. Ours.
  double tight_loop_trace = 0.125;
  /// Mahalanobis distance beyond which the best validated way forbids a closure for now. Ours.
  double max_contradiction = 5.0;
  int max_loops = 40;  ///< loops looked at for one hypothesis. Ours.
};

class LoopValidator {
 public:
  explicit LoopValidator(const ValidatorOptions& options);

  /// Adds matches as hypotheses and judges each, over the graph's odometry, floor-change and
  /// validated closure edges and over the other hypotheses. Returns the hypotheses that became
  /// valid by this call (the new ones or older ones that got their last vote), in order of ids. The
  /// caller adds their edges to the graph before the next call.
  std::vector<HypothesisId> Judge(const PoseGraph& graph, const std::vector<Hypothesis>& matches);

  const std::vector<Hypothesis>& hypotheses() const { return hypotheses_; }

 private:
  void JudgeOne(const PoseGraph& graph, HypothesisId id);
  void Vote(const PoseGraph& graph, HypothesisId id);
  bool Contradicted(const PoseGraph& graph, const Hypothesis& hypothesis);

  ValidatorOptions options_;
  std::vector<Hypothesis> hypotheses_;
  LoopSearch search_;
  std::vector<HypothesisId> newly_valid_;  // of the running call
};

}  // namespace masked_mapper
