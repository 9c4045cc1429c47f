// SPDX-License-Identifier: BSD-3-Clause
// Least squares over a pose graph on SE(2), all floors at once (Section III-B). Ceres stays behind
// this header.
#pragma once

#include <cstddef>
#include <vector>

#include "masked_mapper/pose_graph/pose_graph.hpp"

namespace masked_mapper {

struct OptimizerOptions {
  int max_iterations = 50;
  double function_tolerance = 1e-6;  ///< relative decrease of chi^2 at which the solve ends
};

struct OptimizationSummary {
  double initial_chi2 = 0.0;
  double final_chi2 = 0.0;
  int iterations = 0;
  bool converged = false;
};

/// Moves the optimised poses of `graph` to the least-squares solution, from where they stand (warm
/// start), or, where they fit very poorly, from the Dijkstra projection of each component's first
/// node, which is right about far more of a graph that was never solved. Node 0 stays, and with it
/// every component's first node. Single-threaded: same bytes.
OptimizationSummary Optimize(const OptimizerOptions& options, PoseGraph& graph);

struct UpdateOptions {
  OptimizerOptions solver;
  /// What is off by less is left for a later solve: neither a candidate nor the window of a match
  /// changes by so little.
  double settled_m = 0.05;
  double settled_deg = 0.5;
  double far_off = 20.0;  ///< new edges off by so many times that have everything solved at once
  int first_part_nodes = 50;  ///< nodes that move in the first, smallest solve
};

/// Keeps a growing graph near its least-squares solution while it is being mapped, at a cost that
/// does not grow with the map: solves only when a new edge pulls, and then frees only the nodes
/// near it, in steps of larger parts with all beyond held still, until a part moves by next to
/// nothing. For the solution itself call Optimize() at the end. Choices of ours.
class PoseGraphOptimizer {
 public:
  explicit PoseGraphOptimizer(const UpdateOptions& options);

  /// To be called after edges were added. After edges were removed, call Optimize() first. The
  /// summary tells of the last part that was solved; no iterations if nothing had to move.
  OptimizationSummary Update(PoseGraph& graph);

  /// The state, for a checkpoint (sensor/state_archive.hpp).
  template <class Archive>
  void Serialize(Archive& archive) {
    archive(known_edges_);
  }

 private:
  UpdateOptions options_;
  std::size_t known_edges_ = 0;  // of the graph, the last time
};

/// chi^2 of one edge at the optimised poses.
double EdgeChi2(const PoseGraph& graph, const Edge& edge);

/// The last audit before a map is written: closures that disagree with the optimised graph.
///
/// Votes are cast while the graph grows; at its end, with all closures in it, what was wrong stands
/// out against them all. Graduated non-convexity (Yang et al. 2020, truncated least squares) over
/// groups of closures, and over odometry, which may slip: starts from the plain solution and takes
/// weight from what disagrees, a little at a time, so that the wrong ones and not their neighbours
/// go.
struct AuditOptions {
  /// chi^2 (3 degrees of freedom) above which a closure disagrees: one in a thousand right ones
  /// would.
  double max_chi2 = 16.27;
  /// Added to a closure's own sigmas for this question: one that is off by as much is imprecise but
  /// not wrong.
  double tolerance_m = 0.15;
  double tolerance_deg = 1.5;
};

/// Closures that disagree, in order of ids; none when all fit, and none of `trusted`, which others
/// have to agree with. The graph keeps its edges, and its poses become the solution without those
/// closures: the caller removes the edges, the last first.
std::vector<EdgeId> AuditClosures(const AuditOptions& options, const OptimizerOptions& solver,
                                  PoseGraph& graph, const std::vector<EdgeId>& trusted = {});

}  // namespace masked_mapper
