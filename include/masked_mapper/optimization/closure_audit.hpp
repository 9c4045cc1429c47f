// SPDX-License-Identifier: BSD-3-Clause
// The last audit before a map is written: closures that disagree with the optimised graph.
//
// Votes are cast while the graph grows; at its end, with all closures in it, what was wrong stands
// out against them all. Graduated non-convexity (Yang et al. 2020, truncated least squares) over
// groups of closures, and over odometry, which may slip: starts from the plain solution and takes
// weight from what disagrees, a little at a time, so that the wrong ones and not their neighbours
// go.
#pragma once

#include <vector>

#include "masked_mapper/optimization/pose_graph_optimizer.hpp"
#include "masked_mapper/pose_graph/pose_graph.hpp"

namespace masked_mapper {

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
