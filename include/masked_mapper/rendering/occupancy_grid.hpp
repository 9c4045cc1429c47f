// SPDX-License-Identifier: BSD-3-Clause
// The occupancy grid of one floor, from scans at their final poses. Every beam votes: each cell
// that it crosses was visited, the cell in which it ends was hit. Near beams lie densely and so
// outvote far ones, whose ends are less certain; that keeps walls thin.
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "masked_mapper/sensor/laser_scan.hpp"

namespace masked_mapper {

enum class Cell : std::uint8_t { kUnknown = 0, kFree = 1, kOccupied = 2 };

/// A scan at its final place, as rendering wants it.
struct PosedScan {
  Pose2 T_world_robot;
  std::int32_t floor = 0;
  const LaserScan* scan = nullptr;  ///< outlives the rendering
  std::size_t drive = 0;            ///< later ones are newer
};

struct GridOptions {
  double resolution_m = 0.05;
  double max_usable_range_m = 30.0;  ///< beams are drawn up to here
  /// What a beam that met nothing clears. Nothing by default: indoors glass and black walls are the
  /// usual reason, and clearing would open windows onto free space that nobody saw.
  double free_range_without_return_m = 0.0;
  double occupied_ratio = 0.25;  ///< share of hits among visits from which a cell is a wall
  int min_hits = 2;  ///< hits a wall cell needs at the least; with fewer it stays unknown
  /// Where a newer drive saw enough of a cell to tell a wall, what older ones saw of it is
  /// forgotten: walls that were taken away, doors that are open now. Scans are in order of drives.
  bool forget = false;
  bool glass = true;  ///< walls that stop only beams that meet them squarely are walls
  int threads = 1;
};

/// Where the wall in an occupied cell stands: the mean of the cell's hits, m, in world.
struct WallPoint {
  float x = 0.0F;
  float y = 0.0F;
};

/// Row-major, row 0 at the smallest y. The cell (column, row) covers
/// [origin + (column, row) * resolution, + resolution); the origin is a multiple of the resolution.
struct OccupancyGrid {
  double resolution_m = 0.05;
  double origin_x = 0.0;  ///< m, in world
  double origin_y = 0.0;
  int width = 0;
  int height = 0;
  std::vector<Cell> cells;
  std::vector<WallPoint> walls;  ///< one per occupied cell, in the order of cells

  Cell at(int column, int row) const {
    return cells[static_cast<std::size_t>(row) * static_cast<std::size_t>(width) +
                 static_cast<std::size_t>(column)];
  }
};

/// The grid of the scans on `floor`; empty (0 x 0) when no beam of them tells anything. Same result
/// at any thread count. Throws InputError when the floor is too large for cells of this size.
OccupancyGrid RenderGrid(const std::vector<PosedScan>& scans, std::int32_t floor,
                         const GridOptions& options);

/// Area known to be free or occupied, m^2.
double KnownArea(const OccupancyGrid& grid);

// What people know better than the scans, drawn into a grid. Corners in world, metres.

/// Walls inside become free, and their wall points go.
void EraseWalls(const std::vector<Eigen::Vector2d>& corners, OccupancyGrid& grid);

/// What was free inside becomes unknown; walls stay, since a robot may localise by them.
void ForgetFree(const std::vector<Eigen::Vector2d>& corners, OccupancyGrid& grid);

}  // namespace masked_mapper
