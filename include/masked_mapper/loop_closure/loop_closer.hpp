// SPDX-License-Identifier: BSD-3-Clause
// From candidates to closures, as in the body of Algorithm 1: joint scan matching, refinement
// against submaps, votes, optimisation; and what is done once all are in: late closures, the last
// audit. Serves a drive that is being mapped and drives that are being joined alike.
#pragma once

#include <cstddef>
#include <functional>
#include <optional>
#include <set>
#include <utility>
#include <vector>

#include "masked_mapper/loop_closure/candidates.hpp"
#include "masked_mapper/loop_closure/closure_matcher.hpp"
#include "masked_mapper/loop_closure/open_revisits.hpp"
#include "masked_mapper/loop_closure/validator.hpp"
#include "masked_mapper/map/building_map.hpp"
#include "masked_mapper/optimization/closure_audit.hpp"
#include "masked_mapper/optimization/pose_graph_optimizer.hpp"

namespace masked_mapper {

/// Which pairs enter once the whole map is known, matched again from their optimised poses.
struct PolishOptions {
  double most_m = 0.2;  ///< that the match may be away from the map, before and after
  double most_deg = 2.0;
  OpenRevisitOptions revisits;  ///< which pairs are offered late, as no mask offered them
};

struct LoopClosureOptions {
  CandidateOptions candidates;
  MatcherOptions matcher;
  /// Whether scans laid out the motion; if not, wheels alone did, and the map is sure only about
  /// what is closed.
  bool laid_out_by_scans = true;
  /// Whether matches are refined against submaps, which the motion lays out well enough for that.
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

  /// `map` outlives this. Without `reference`, nodes are matched by their scans.
  LoopCloser(const LoopClosureOptions& options, BuildingMap& map, ReferencePoints reference = {});

  /// Offers a node to its candidates. What is validated by it becomes edges, and the graph is
  /// solved. Returns how many.
  std::size_t Close(NodeId new_node, const std::vector<Candidate>& candidates);

  /// Ends the map's graph: late closures enter, those that disagree go. Only of a map that hangs
  /// together where late closures are to be believed.
  void Finish();

  /// The state, for a checkpoint (sensor/state_archive.hpp); after the map's closures.
  template <class Archive>
  void Serialize(Archive& archive) {
    validator_.Serialize(archive, map_.closures);
    archive(optimizer_);
  }

 private:
  using NodePairs = std::set<std::pair<NodeId, NodeId>>;  ///< older, newer

  std::vector<ClosureId> MatchScans(NodeId new_node, const std::vector<Candidate>& candidates);
  void Solve();
  void CloseLate();
  void CloseOpenVotes();
  void CloseLateByWheels();
  /// Of pairs that are not among `tried`, which they become. Returns how many closed.
  std::size_t CloseOpenRevisits(NodePairs& tried);
  bool CloseRevisit(NodeId newer, NodeId older);
  bool CanBeOne(const Closure& closure) const;
  bool AgreesWith(const UncertainPose2& T_older_newer, const Closure& closure) const;
  bool FitsTheMap(const Closure& closure) const;
  Pose2 MapBetween(NodeId from, NodeId to) const;
  std::optional<UncertainPose2> SureWay(NodeId from, NodeId to) const;
  void EnterLate(ClosureId id);
  void Audit();

  const LoopClosureOptions& options_;
  BuildingMap& map_;
  ReferencePoints reference_;
  ClosureMatcher matcher_;
  ClosureMatcher late_matcher_;  ///< its references are other points of the same nodes
  LoopValidator validator_;
  PoseGraphOptimizer optimizer_;
  NodePairs forbidden_;  ///< by hand
};

}  // namespace masked_mapper
