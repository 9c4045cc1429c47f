// SPDX-License-Identifier: BSD-3-Clause
#include "masked_mapper/rendering/occupancy_grid.hpp"

#include <cstdint>

#include "masked_mapper/geometry/polygon.hpp"

namespace masked_mapper {
namespace {

template <typename Visit>
void ForEachInside(const std::vector<Eigen::Vector2d>& corners, const OccupancyGrid& grid,
                   const Visit& visit) {
  ForEachCellInside(corners, {grid.origin_x, grid.origin_y}, grid.resolution_m, grid.width,
                    grid.height, visit);
}

}  // namespace

void EraseWalls(const std::vector<Eigen::Vector2d>& corners, OccupancyGrid& grid) {
  std::vector<std::uint8_t> is_erased(grid.cells.size());
  ForEachInside(corners, grid, [&](std::size_t cell) {
    is_erased[cell] = grid.cells[cell] == Cell::kOccupied ? 1 : 0;
  });
  std::size_t kept = 0;
  std::size_t wall = 0;
  for (std::size_t cell = 0; cell < grid.cells.size(); ++cell) {
    if (grid.cells[cell] != Cell::kOccupied) continue;
    if (is_erased[cell] == 0) grid.walls[kept++] = grid.walls[wall];
    ++wall;
    if (is_erased[cell] != 0) grid.cells[cell] = Cell::kFree;
  }
  grid.walls.resize(kept);
}

void ForgetFree(const std::vector<Eigen::Vector2d>& corners, OccupancyGrid& grid) {
  ForEachInside(corners, grid, [&](std::size_t cell) {
    if (grid.cells[cell] == Cell::kFree) grid.cells[cell] = Cell::kUnknown;
  });
}

}  // namespace masked_mapper
