// SPDX-License-Identifier: BSD-3-Clause
#include "masked_mapper/rendering/occupancy_grid.hpp"

#include <gtest/gtest.h>

namespace masked_mapper {
namespace {

OccupancyGrid Grid() {
  OccupancyGrid grid;
  grid.resolution_m = 1.0;
  grid.width = 4;
  grid.height = 2;
  grid.cells = {Cell::kOccupied, Cell::kFree,     Cell::kOccupied, Cell::kUnknown,
                Cell::kOccupied, Cell::kOccupied, Cell::kFree,     Cell::kFree};
  grid.walls = {{0.5F, 0.5F}, {2.5F, 0.5F}, {0.5F, 1.5F}, {1.5F, 1.5F}};
  return grid;
}

const std::vector<Eigen::Vector2d> kRight = {{1, 0}, {4, 0}, {4, 2}, {1, 2}};

TEST(DrawnAreas, ErasedWallsAreFreeAndTheirPointsGone) {
  OccupancyGrid grid = Grid();
  EraseWalls(kRight, grid);
  EXPECT_EQ(grid.cells,
            (std::vector<Cell>{Cell::kOccupied, Cell::kFree, Cell::kFree, Cell::kUnknown,
                               Cell::kOccupied, Cell::kFree, Cell::kFree, Cell::kFree}));
  ASSERT_EQ(grid.walls.size(), 2U);
  EXPECT_EQ(grid.walls[1].y, 1.5F);
  EXPECT_EQ(grid.walls[1].x, 0.5F);
}

TEST(DrawnAreas, WhatIsKeptOutOfIsFreeNoMore) {
  OccupancyGrid grid = Grid();
  ForgetFree(kRight, grid);
  EXPECT_EQ(grid.cells[1], Cell::kUnknown);
  EXPECT_EQ(grid.cells[2], Cell::kOccupied);
  EXPECT_EQ(grid.cells[7], Cell::kUnknown);
  EXPECT_EQ(grid.walls.size(), 4U);
}

}  // namespace
}  // namespace masked_mapper
