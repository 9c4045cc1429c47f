// SPDX-License-Identifier: BSD-3-Clause
// Least squares over a pose graph on SE(2), all floors at once (Section III-B). Ceres stays behind
// this header.
#pragma once

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

/// chi^2 of one edge at the optimised poses.
double EdgeChi2(const PoseGraph& graph, const Edge& edge);

}  // namespace masked_mapper
