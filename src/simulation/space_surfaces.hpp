// SPDX-License-Identifier: BSD-3-Clause
// The surfaces of a simulated floor in space: the plan's segments get heights. Walls and glass
// reach the ceiling, doors a lintel, furniture is desks, cupboards and shelves; floors and ceilings
// are flat. Building frame in the plane, heights above the floor, m.
#pragma once

#include <cstddef>
#include <vector>

#include "masked_mapper/simulation/building.hpp"

namespace masked_mapper {

constexpr double kCabDoorHeight = 2.1;  ///< m

/// What stands upright between two heights.
struct Upright {
  Segment segment;
  double low = 0.0;
  double high = 0.0;
};

struct SpaceSurfaces {
  double ceiling = 0.0;
  std::vector<Upright> standing;   ///< people and the doors of cabs aside
  std::vector<Overhead> overhead;  ///< cut off at the ceiling; its sides are among `standing`
};
SpaceSurfaces SurfacesOf(const Building& building, std::size_t floor);

/// How far a point is from the nearest surface of a floor, closed doors of cabs among them; or
/// `limit` when none is nearer. For points that were measured there.
class TrueSurfaces {
 public:
  TrueSurfaces(const Building& building, std::size_t floor, double limit);
  /// In building, z above the floor.
  double Distance(const Eigen::Vector3d& point) const;

 private:
  const std::vector<std::size_t>* Near(const Eigen::Vector2d& point) const;

  SpaceSurfaces surfaces_;
  double limit_;
  Eigen::Vector2d low_ = Eigen::Vector2d::Zero();
  std::size_t columns_ = 0;
  std::vector<std::vector<std::size_t>> cells_;  ///< uprights within `limit` of a cell
};

}  // namespace masked_mapper
