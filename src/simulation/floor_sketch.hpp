// SPDX-License-Identifier: BSD-3-Clause
// Drawing a floor as free space: the union of convex spaces (rooms, corridors, door openings) that
// overlap where one can pass. Walls are what bounds the union, so they close by construction.
#pragma once

#include <Eigen/Core>
#include <optional>
#include <vector>

#include "masked_mapper/simulation/building.hpp"

namespace masked_mapper {

struct ConvexSpace {
  std::vector<Eigen::Vector2d> corners;          ///< counter-clockwise
  std::vector<std::optional<Surface>> surfaces;  ///< edge i, from corner i to i + 1; empty: open

  /// A rectangle in the frame of a pose: x from x0 to x1, y from y0 to y1, all four edges of walls.
  /// Edges in order: y0, x1, y1, x0.
  static ConvexSpace Rectangle(const Pose2& T_building_local, double x0, double y0, double x1,
                               double y1);
};

/// Whether two spaces overlap when each is grown by half of `gap` (m).
bool Overlap(const ConvexSpace& a, const ConvexSpace& b, double gap);

/// The parts of all edges that lie inside no other space. Spaces that only touch stay divided.
std::vector<Segment> Walls(const std::vector<ConvexSpace>& spaces);

}  // namespace masked_mapper
