// SPDX-License-Identifier: BSD-3-Clause
// Exact search for the best pose of a query scan on the look-up table of a reference (M3RSM, Olson
// 2015; Section III-D). Many problems share one best-first queue of blocks of grid poses, keyed by
// an upper bound of their objective. A coarse level of the table bounds a block's score, and the
// smallest chi^2 over the block's box bounds its prior, so the answer is that of exhaustive search.
//
// Grid: angles guess + k * angle_step, translations guess + (x, y) * resolution in the reference
// frame, for integers -half <= k, x, y <= half. Score of a grid pose, 0 to 1: the mean of the table
// over the query points, each rounded down to its cell before (x, y) is added; over 255. Objective:
// score - prior_weight * chi^2 of the pose under the guess.
//
// Answer: the largest objective among the grid poses whose score reaches min_score; of several, the
// lexicographically smallest (k, x, y). A block is expanded as long as its bound is not below the
// best pose found, also when equal.
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <vector>

#include "block_sums.hpp"
#include "lookup_table.hpp"
#include "masked_mapper/geometry/pose2.hpp"
#include "masked_mapper/geometry/uncertain_pose2.hpp"
#include "masked_mapper/scan_matching/matcher_options.hpp"

namespace masked_mapper {

/// The window of a match: window_sigmas deviations of the guess to either side, within the options'
/// limits, along the axes of the reference frame.
SearchGrid SearchGridFor(const UncertainPose2& T_reference_query_guess,
                         const MatcherOptions& options);

/// One grid pose, in steps from the guess.
struct GridPose {
  std::int32_t angle = 0;
  std::int32_t x = 0;
  std::int32_t y = 0;
};

/// T_reference_query of a grid pose.
Pose2 PoseOf(const SearchGrid& grid, const GridPose& pose);

/// Grid poses near another, in all three directions; none as it comes.
struct GridBox {
  GridPose centre;
  std::int32_t half_angle = -1;
  std::int32_t half_x = -1;
  std::int32_t half_y = -1;
};

struct SearchProblem {
  const LookupTable* table = nullptr;
  const std::vector<Eigen::Vector2d>* points_in_query = nullptr;  ///< finite; within 10^6 cells
  SearchGrid grid;
  /// Upper triangular U with chi^2 = |U (dx, dy, dtheta)|^2. Zero for no prior.
  Eigen::Matrix3d prior_root = Eigen::Matrix3d::Zero();
  double prior_weight = 0.0;
  double min_score = 0.0;
  GridBox left_out;  ///< no answer from here
};

struct SearchResult {
  bool found = false;
  GridPose best;
  double score = 0.0;  ///< of `best`; when nothing was found, no grid pose scores more than this
  double objective = 0.0;
};

/// Results in the order of the problems; each is independent of the other problems.
std::vector<SearchResult> SearchJointly(const std::vector<SearchProblem>& problems);

/// The same by looking at every grid pose: what SearchJointly is held against.
SearchResult SearchExhaustively(const SearchProblem& problem);

/// U of SearchProblem for a guess's covariance, never sharper than the grid itself: the variance of
/// a uniform distribution over one grid step is added. A covariance that is not finite gives no
/// prior.
Eigen::Matrix3d PriorRoot(const Eigen::Matrix3d& covariance, const SearchGrid& grid);

}  // namespace masked_mapper
