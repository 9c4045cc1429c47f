// SPDX-License-Identifier: BSD-3-Clause
// Refinement of a match below the cell, and its covariance from the response surface around it
// (Olson 2009: the score as a likelihood of the pose). The score of a pose is the mean of the table
// at the points, over 255, read through a cubic B-spline: twice differentiable, so without the
// staircase of the cells. Newton's method climbs it; points far from the reference have no slope,
// so they neither pull nor need a gate.
#pragma once

#include <Eigen/Core>
#include <vector>

#include "lookup_table.hpp"
#include "masked_mapper/geometry/uncertain_pose2.hpp"
#include "masked_mapper/scan_matching/matcher_options.hpp"

namespace masked_mapper {

struct RefinedMatch {
  UncertainPose2 T_reference_query;
  double score = 0.0;      ///< 0-1, interpolated
  bool converged = false;  ///< false: stopped at a limit; the best pose seen is given
};

/// Climbs from `T_reference_query_initial` to the nearest maximum of the score. Never returns a
/// pose of less score than the initial one. The covariance is that of the Gaussian with the
/// curvature of the response surface at the maximum, sigma <= reach_m in any direction (angles
/// count by the points' rms distance from the query's origin), plus the floor: cheap, but blind to
/// a ridge with bumps on it, which ResponseCovariance sees. Without points: the initial pose, no
/// score.
RefinedMatch RefineMatch(const LookupTable& table,
                         const std::vector<Eigen::Vector2d>& points_in_query,
                         const Pose2& T_reference_query_initial, const RefineOptions& options);

/// Covariance of a match from the response surface at large: second moments of the likelihood about
/// `T_reference_query` along the principal axes of the surface, followed until it has fallen off or
/// reach_m is reached, plus the floor. A corridor gives an ellipse as long as the score is
/// indifferent along it. Without points: reach_m in all directions.
Eigen::Matrix3d ResponseCovariance(const LookupTable& table,
                                   const std::vector<Eigen::Vector2d>& points_in_query,
                                   const Pose2& T_reference_query, const RefineOptions& options);

}  // namespace masked_mapper
