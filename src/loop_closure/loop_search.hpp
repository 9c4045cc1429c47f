// SPDX-License-Identifier: BSD-3-Clause
// The search behind loop validation (Section III-E): the path of least error between two nodes over
// odometry, floor changes, validated and unvalidated closures, and its most redundant edge.
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "masked_mapper/geometry/uncertain_pose2.hpp"
#include "masked_mapper/map/closure.hpp"
#include "masked_mapper/pose_graph/pose_graph.hpp"

namespace masked_mapper {

/// One edge of a path, as walked.
struct PathStep {
  EdgeId edge = -1;        ///< of the graph, or
  ClosureId closure = -1;  ///< a closure that is not in the graph
  NodeId to = 0;           ///< where the step ends
  int ways = 0;            ///< how many nodes of the search led to `to` before it was settled
};

struct LeastErrorPath {
  std::vector<PathStep> steps;
  UncertainPose2 T_from_to;
  int unvalidated = 0;  ///< closures on the path without enough votes
};

/// Edges that a search may not take; few, so that looking through them is cheap.
class RemovedSteps {
 public:
  void Add(const PathStep& step);
  bool HoldsEdge(EdgeId id) const;
  bool HoldsClosure(ClosureId id) const;

 private:
  std::vector<EdgeId> edges_;
  std::vector<ClosureId> closures_;
};

/// Dijkstra over (number of unvalidated closures, trace of the covariance), in this order, so that
/// a validated way is always taken before an unvalidated one; this is our reading of "validated
/// always before unvalidated". As in the projection, a node is settled by the first composition to
/// reach it.
class LoopSearch {
 public:
  /// Makes a closure an edge of the search: one more unvalidated one, or a validated one that the
  /// graph does not hold yet. Ids are places in the list that is given to Find().
  void Add(ClosureId id, const Closure& closure);
  /// Takes it out for good, once the graph holds it.
  void Drop(ClosureId id, const Closure& closure);

  /// Empty when every way is removed.
  std::optional<LeastErrorPath> Find(const PoseGraph& graph, const std::vector<Closure>& closures,
                                     NodeId from, NodeId to, const RemovedSteps& removed);

  /// The state, for a checkpoint (sensor/state_archive.hpp); `closures` as given to Find().
  template <class Archive>
  void Serialize(Archive& archive, const std::vector<Closure>& closures) {
    archive(closures_of_);
    for (const std::vector<ClosureId>& ids : closures_of_) {
      for (const ClosureId id : ids) {
        if (id < 0 || static_cast<std::size_t>(id) >= closures.size()) {
          archive.Refuse("a search for closures that there are not");
        }
      }
    }
  }

 private:
  struct Reached {
    std::int64_t search = 0;  // the search that this entry belongs to; older ones count as empty
    double trace = 0.0;
    int unvalidated = 0;
    int ways = 0;
    EdgeId edge = -1;
    ClosureId closure = -1;
    NodeId parent = -1;
    bool settled = false;
    UncertainPose2 T_from_node;
  };

  Reached& At(NodeId node);

  std::vector<std::vector<ClosureId>> closures_of_;  // by node
  std::vector<Reached> reached_;                     // by node
  std::int64_t search_ = 0;
};

/// The step that is most redundant: whose end was reached from the most nodes of the search, so
/// that another way round probably exists. Ties go to the step nearest the middle of the path,
/// which leaves the surroundings of both ends whole (ours). `path` has at least one step.
const PathStep& MostRedundantStep(const LeastErrorPath& path);

}  // namespace masked_mapper
