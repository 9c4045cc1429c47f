// SPDX-License-Identifier: BSD-3-Clause
// Simple polygons as lists of corners, either way round; the last corner is joined to the first.
#pragma once

#include <Eigen/Core>
#include <functional>
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

}  // namespace masked_mapper
