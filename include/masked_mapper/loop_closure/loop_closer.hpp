// SPDX-License-Identifier: BSD-3-Clause
// From candidates to closures, as in the body of Algorithm 1: joint scan matching, refinement
// against submaps, votes, optimisation; and what is done once all are in: late closures, the last
// audit. Serves a drive that is being mapped and drives that are being joined alike.
#pragma once

#include <cstddef>
#include <functional>
#include <memory>
#include <vector>

#include "masked_mapper/loop_closure/loop_closure_options.hpp"
#include "masked_mapper/map/building_map.hpp"
#include "masked_mapper/pose_graph/dijkstra_projection.hpp"
#include "masked_mapper/pose_graph/pose_graph.hpp"
#include "masked_mapper/sensor/laser_scan.hpp"
#include "masked_mapper/sensor/state_archive.hpp"

namespace masked_mapper {

/// An earlier node that is worth matching with a new one.
struct Candidate {
  NodeId node = 0;
  double mahalanobis = 0.0;
  UncertainPose2 T_new_node;  ///< mean from the optimised map, covariance from the projection
};

/// Nodes with a scan on the floor of `new_node`, below MaxMaha, at most MaxMatches, nearest first;
/// ties: the older node (Algorithm 1; Section III-C, Eq. 7).
std::vector<Candidate> FindCandidates(const PoseGraph& graph, NodeId new_node,
                                      const std::vector<ProjectedNode>& projection,
                                      const CandidateOptions& options);

/// The same, of one new node after the other in a graph that grows, without projecting every node:
/// how unsure a node can be at most is known from where the last new node was, and what is too far
/// for that is not looked at.
class CandidateSearch {
 public:
  std::vector<Candidate> Of(const PoseGraph& graph, NodeId new_node,
                            const CandidateOptions& options);

 private:
  void GoTo(NodeId new_node, const PoseGraph& graph, ProjectionSearch& search);

  std::vector<double> most_cost_;  ///< by node: of its projection from `last_`, about
  NodeId last_ = -1;
};

class LoopCloser {
 public:
  /// What a node is matched against, in its frame.
  using ReferencePoints = std::function<ScanPoints::ConstPtr(NodeId)>;

  /// `options` and `map` outlive this. Without `reference`, nodes are matched by their scans.
  LoopCloser(const LoopClosureOptions& options, BuildingMap& map, ReferencePoints reference = {});
  ~LoopCloser();

  /// Offers a node to its candidates. What is validated by it becomes edges, and the graph is
  /// solved. Returns how many.
  std::size_t Close(NodeId new_node, const std::vector<Candidate>& candidates);

  /// Ends the map's graph: late closures enter, those that disagree go. Only of a map that hangs
  /// together where late closures are to be believed.
  void Finish();

  /// The state, for a checkpoint; after the map's closures.
  void Serialize(StateWriter& archive);
  void Serialize(StateReader& archive);

 private:
  class Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace masked_mapper
