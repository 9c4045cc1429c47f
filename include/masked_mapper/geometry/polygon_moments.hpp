// SPDX-License-Identifier: BSD-3-Clause
// Exact area moments of a polygon (Section III-D, Eq. 8): area, centroid and covariance of a
// uniform density over it, by triangulation from the origin.
#pragma once

#include <Eigen/Core>
#include <optional>
#include <vector>

namespace masked_mapper {

struct PolygonMoments {
  double area = 0.0;                                     ///< m^2, positive
  Eigen::Vector2d centroid = Eigen::Vector2d::Zero();    ///< m
  Eigen::Matrix2d covariance = Eigen::Matrix2d::Zero();  ///< m^2, about the centroid
};

/// Moments of the closed polygon through `corners` (either orientation, last joined to first).
/// Empty with fewer than three corners or when the area vanishes.
std::optional<PolygonMoments> ComputePolygonMoments(const std::vector<Eigen::Vector2d>& corners);

}  // namespace masked_mapper
