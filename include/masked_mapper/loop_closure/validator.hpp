// SPDX-License-Identifier: BSD-3-Clause
// Loop validation (Section III-E): a match is a hypothesis until enough loops agree with it.
#pragma once

#include <vector>

#include "masked_mapper/pose_graph/pose_graph.hpp"

namespace masked_mapper {

struct ValidatorOptions {
  int votes_needed = 6;  ///< paper: 6
  double max_loop_error =
      2.0;  ///< Mahalanobis distance from identity of an agreeing loop; paper: 2
};

using HypothesisId = std::int32_t;

struct Hypothesis {
  NodeId a = 0;  ///< the newer node
  NodeId b = 0;
  UncertainPose2 T_a_b;
  int votes = 0;
  bool validated = false;
};

class LoopValidator {
 public:
  explicit LoopValidator(const ValidatorOptions& options);

  /// Adds matches as hypotheses and judges each, over the graph's odometry, floor-change and
  /// validated closure edges and over the other hypotheses. Returns the hypotheses that became
  /// valid by this call (the new ones or older ones that got their last vote), in order of ids. The
  /// caller adds their edges to the graph.
  std::vector<HypothesisId> Judge(const PoseGraph& graph, const std::vector<Hypothesis>& matches);

  const std::vector<Hypothesis>& hypotheses() const { return hypotheses_; }

 private:
  ValidatorOptions options_;
  std::vector<Hypothesis> hypotheses_;
};

}  // namespace masked_mapper
