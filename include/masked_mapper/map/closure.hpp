// SPDX-License-Identifier: BSD-3-Clause
// A pair of nodes that may be one place: from the offer to the solve the one record of it.
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "masked_mapper/geometry/uncertain_pose2.hpp"
#include "masked_mapper/pose_graph/pose_graph.hpp"

namespace masked_mapper {

enum class ClosureState { kRejectedScore, kHypothesis, kValidated, kAuditedOut };

/// Why a closure is in the state that it is in.
enum class ClosureReason {
  kBelowMinScore,    ///< no match
  kDoesNotFit,       ///< a match that the surroundings of the older node contradict
  kAlikeAlongALine,  ///< a match that leaves a direction open
  kTooFewVotes,      ///< so far
  kEnoughVotes,
  kFitsTheMap,  ///< entered late: the optimised map says the same
  kDisagreesWithTheMap,
  kTooFewTies,  ///< between drives that stay apart
  kAddedByHand,
  kForbiddenByHand,
};

struct Closure {
  NodeId older = 0;
  NodeId newer = 0;
  UncertainPose2 T_older_newer;  ///< the match; the guess if there is none
  ClosureState state = ClosureState::kRejectedScore;
  ClosureReason reason = ClosureReason::kBelowMinScore;
  double score = 0.0;        ///< of the match, 0-1
  double mahalanobis = 0.0;  ///< of the candidate, Eq. 7
  double agreement = 0.0;    ///< share of the newer scan's points that fit the older node's submap,
                             ///< 0-1; 0: not looked at
  int votes = 0;
};

/// As closures.csv and the saved map have it: `rejected_score`.
const char* Name(ClosureState state);
std::optional<ClosureState> ClosureStateOf(std::string_view name);
/// For people, and in the saved map: "too few votes".
const char* Name(ClosureReason reason);
std::optional<ClosureReason> ClosureReasonOf(std::string_view name);

/// Makes an edge of the closure.
EdgeId AddClosureEdge(const std::vector<Closure>& closures, ClosureId id, PoseGraph& graph);

}  // namespace masked_mapper
