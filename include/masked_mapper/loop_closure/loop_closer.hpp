// SPDX-License-Identifier: BSD-3-Clause
// From candidates to closures, as in the body of Algorithm 1: joint scan matching, refinement
// against submaps, votes, optimisation; and what is done once all are in: late closures, the last
// audit. Serves a drive that is being mapped and drives that are being joined alike.
#pragma once

#include <cstddef>
#include <functional>
#include <map>
#include <optional>
#include <vector>

#include "masked_mapper/loop_closure/candidates.hpp"
#include "masked_mapper/loop_closure/open_revisits.hpp"
#include "masked_mapper/loop_closure/submaps.hpp"
#include "masked_mapper/loop_closure/validator.hpp"
#include "masked_mapper/map/building_map.hpp"
#include "masked_mapper/optimization/closure_audit.hpp"
#include "masked_mapper/optimization/pose_graph_optimizer.hpp"
#include "masked_mapper/scan_matching/joint_matcher.hpp"

namespace masked_mapper {

/// When a match is not sure enough to be a closure. A blank corridor matches itself anywhere along
/// it, and loops of such matches agree with each other. Ours: the paper leaves it to MinScore.
struct AmbiguityOptions {
  double max_sigma_m = 0.2;  ///< in the least certain direction
  double max_sigma_deg = 3.0;
};

/// Which pairs enter once the whole map is known, matched again from their optimised poses.
struct PolishOptions {
  double most_m = 0.2;  ///< that the match may be away from the map, before and after
  double most_deg = 2.0;
  OpenRevisitOptions revisits;  ///< which pairs are offered late, as no mask offered them
};

struct LoopClosureOptions {
  CandidateOptions candidates;
  MatcherOptions matcher;
  /// Whether matches are refined against submaps. Not where wheels alone lay out the submaps.
  bool refine = true;
  SubmapOptions submaps;
  AmbiguityOptions ambiguity;
  ValidatorOptions validator;
  UpdateOptions optimizer;
  PolishOptions polish;
  AuditOptions audit;
};

class LoopCloser {
 public:
  /// What a node is matched against, in its frame.
  using ReferencePoints = std::function<ScanPoints::ConstPtr(NodeId)>;

  /// `map` outlives this; closures that are in it already stay known by their attempts.
  /// Without `reference`, nodes are matched by their scans.
  LoopCloser(const LoopClosureOptions& options, MappingResult& map, ReferencePoints reference = {});

  /// Offers a node to its candidates. What is validated by it becomes edges, and the graph is
  /// solved. Returns how many.
  std::size_t Close(NodeId new_node, const std::vector<Candidate>& candidates);

  /// Writes the votes of so far into the attempts.
  void NoteVotes();

  /// Ends the map's graph: late closures enter, those that disagree go. Only of a map that hangs
  /// together where late closures are to be believed.
  void Finish();

  /// The state, for a checkpoint (mapping/state_archive.hpp); after the map's attempts.
  template <class Archive>
  void Serialize(Archive& archive) {
    archive(validator_, optimizer_, attempt_of_hypothesis_, attempt_of_edge_);
    if constexpr (Archive::kReads) {
      if (!HoldsTogether()) archive.Refuse("closures that do not hold together");
    }
  }

 private:
  std::vector<Hypothesis> MatchScans(NodeId new_node, const std::vector<Candidate>& candidates);
  bool RefineMatch(ClosureAttempt& attempt);
  void AddValidated(const std::vector<HypothesisId>& validated);
  void Polish();
  void CloseOpenRevisits();
  bool CloseRevisit(NodeId a, NodeId b);
  bool CanBeOne(const ClosureAttempt& attempt) const;
  bool IsForbidden(NodeId one, NodeId other) const;
  bool FitsTheMap(const ClosureAttempt& attempt) const;
  Pose2 MapBetween(NodeId from, NodeId to) const;
  std::optional<UncertainPose2> SureWay(NodeId from, NodeId to) const;
  void EnterLate(std::size_t place, ClosureAttempt& attempt);
  void Audit();
  bool HoldsTogether() const;

  const LoopClosureOptions& options_;
  MappingResult& map_;
  ReferencePoints reference_;
  JointMatcher matcher_;
  JointMatcher late_matcher_;  ///< its references are other points of the same nodes
  Submaps submaps_;
  LoopValidator validator_;
  PoseGraphOptimizer optimizer_;
  std::vector<std::size_t> attempt_of_hypothesis_;
  std::map<EdgeId, std::size_t> attempt_of_edge_;  ///< of closures
};

}  // namespace masked_mapper
