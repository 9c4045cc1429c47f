// SPDX-License-Identifier: BSD-3-Clause
// Walls as straight lines, fitted to the wall points of a grid.
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <optional>
#include <vector>

#include "masked_mapper/rendering/occupancy_grid.hpp"

namespace masked_mapper {

/// In world, metres.
struct WallLine {
  Eigen::Vector2d a = Eigen::Vector2d::Zero();
  Eigen::Vector2d b = Eigen::Vector2d::Zero();
};

struct WallLineOptions {
  double neighbourhood_m = 0.2;  ///< in which a wall point's direction is told
  double tolerance_m = 0.04;     ///< of a point from its line
  double absorbed_m = 0.08;      ///< points so near a line are of the same wall, seen with noise
  double largest_gap_m = 0.25;   ///< a wider one ends a line
  double shortest_m = 0.15;
  double corner_m = 0.2;  ///< ends so near the crossing of their lines meet there
};

/// The occupied cells of a grid alone: they are few of all.
struct WallCells {
  double resolution_m = 0.05;
  int width = 0;  ///< of the grid, in cells
  int height = 0;
  std::vector<std::size_t> cells;  ///< row by row, in order
  std::vector<WallPoint> points;   ///< one per cell
};

WallCells WallCellsOf(const OccupancyGrid& grid);

/// In a fixed order. What is no line of that length (legs of chairs, specks) is left out; what is
/// round becomes several.
std::vector<WallLine> FitWallLines(const WallCells& walls, const WallLineOptions& options = {});
std::vector<WallLine> FitWallLines(const OccupancyGrid& grid, const WallLineOptions& options = {});

/// The direction that most walls have or stand square to: the median of the walls about it, since
/// furniture stands a little askew.
struct WallDirection {
  double angle = 0.0;  ///< rad, above -pi/4 and up to pi/4
  double sigma = 0.0;  ///< rad, as walls differ about it; infinite: hardly more than two
};

/// Nothing when there is no wall.
std::optional<WallDirection> DirectionOf(const std::vector<WallLine>& lines);

/// The same of walls that have about this direction or stand square to it.
std::optional<WallDirection> DirectionNear(double angle, const std::vector<WallLine>& lines);

}  // namespace masked_mapper
