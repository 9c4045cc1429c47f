// SPDX-License-Identifier: BSD-3-Clause
// Simple polygons as lists of corners, either way round; the last corner is joined to the first.
#pragma once

#include <Eigen/Core>
#include <functional>
#include <optional>
#include <vector>

namespace masked_mapper {

/// Whether the point lies inside, by the number of sides that a ray from it crosses. What lies on a
/// side is inside one of two polygons that share it.
bool IsInsidePolygon(const std::vector<Eigen::Vector2d>& corners, const Eigen::Vector2d& point);

/// Calls `visit` with the place, row by row, of every cell of a grid whose centre lies inside.
/// `origin` is the corner of the first cell, in the polygon's frame; metres.
void ForEachCellInside(const std::vector<Eigen::Vector2d>& corners, const Eigen::Vector2d& origin,
                       double resolution_m, int width, int height,
                       const std::function<void(std::size_t)>& visit);

/// Exact area moments of a polygon (Section III-D, Eq. 8): of a uniform density over it, by
/// triangulation from the origin.
struct PolygonMoments {
  double area = 0.0;                                     ///< m^2, positive
  Eigen::Vector2d centroid = Eigen::Vector2d::Zero();    ///< m
  Eigen::Matrix2d covariance = Eigen::Matrix2d::Zero();  ///< m^2, about the centroid
};

/// Moments of the closed polygon through `corners` (either orientation, last joined to first).
/// Empty with fewer than three corners or when the area vanishes.
std::optional<PolygonMoments> ComputePolygonMoments(const std::vector<Eigen::Vector2d>& corners);

}  // namespace masked_mapper
