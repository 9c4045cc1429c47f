// SPDX-License-Identifier: BSD-3-Clause
// Where on a floor the centre of a round robot may be: free cells of the grid that keep its radius
// from every wall. Unknown cells are no free space, but for specks between beams.
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <optional>
#include <vector>

#include "masked_mapper/map/building_map.hpp"
#include "masked_mapper/rendering/occupancy_grid.hpp"
#include "masked_mapper/routing/lanes.hpp"

namespace masked_mapper {

struct GridCell {
  int column = 0;
  int row = 0;
  bool operator==(const GridCell& other) const {
    return column == other.column && row == other.row;
  }
};

class FreeSpace {
 public:
  using Points = std::vector<Eigen::Vector2d>;

  /// `driven`: ways that were driven on this floor, in world. `kept_out`: polygons, in world, that
  /// count as walls, also where they were driven through.
  FreeSpace(const OccupancyGrid& grid, const std::vector<Points>& driven,
            const std::vector<Points>& kept_out, const ClearanceOptions& options);

  int width() const { return width_; }
  int height() const { return height_; }
  double resolution_m() const { return resolution_m_; }

  bool IsPassable(const GridCell& cell) const {
    return IsInside(cell) && room_[IndexOf(cell)] > 0.0F;
  }
  /// Whether the straight way between the centres of two cells leads through passable ones only.
  bool Sees(const GridCell& from, const GridCell& to) const;
  /// The passable cell nearest to a point in world; nothing when none is within `reach_m`.
  std::optional<GridCell> NearestPassable(const Eigen::Vector2d& point, double reach_m) const;

  GridCell CellAt(const Eigen::Vector2d& point) const;
  Eigen::Vector2d CentreOf(const GridCell& cell) const;
  std::size_t IndexOf(const GridCell& cell) const {
    return static_cast<std::size_t>(cell.row) * static_cast<std::size_t>(width_) +
           static_cast<std::size_t>(cell.column);
  }
  GridCell CellOf(std::size_t index) const {
    return {static_cast<int>(index % static_cast<std::size_t>(width_)),
            static_cast<int>(index / static_cast<std::size_t>(width_))};
  }

 private:
  bool IsInside(const GridCell& cell) const {
    return cell.column >= 0 && cell.row >= 0 && cell.column < width_ && cell.row < height_;
  }

  int width_ = 0;
  int height_ = 0;
  double resolution_m_ = 0.05;
  Eigen::Vector2d origin_ = Eigen::Vector2d::Zero();
  /// Cells from the centre of a cell to that of the nearest one that is not passable; 0: not
  /// passable itself.
  std::vector<float> room_;
};

/// Where the robot may be on a floor, with what was driven and what is kept out.
FreeSpace FreeSpaceOf(const BuildingMap& map, const OccupancyGrid& grid, FloorId floor,
                      const ClearanceOptions& clearance);

/// What was driven on a floor, visit by visit, in world.
std::vector<FreeSpace::Points> DrivenOn(const BuildingMap& map, FloorId floor);

}  // namespace masked_mapper
