// SPDX-License-Identifier: BSD-3-Clause
// Glass stops beams that meet it squarely, and lets those pass that meet it at a slant, as most do
// along a corridor: counted together they say that nothing is there. So beams are counted by their
// axis, and a cell that is a wall to those along one of them is one, where it lies in a straight
// line across that axis. People, who are hit and passed along one axis by turns, are no lines.
#pragma once

#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <vector>

#include "masked_mapper/rendering/occupancy_grid.hpp"

namespace masked_mapper {

/// Of beams, to and fro: along x, along the rising diagonal, along y, along the falling diagonal.
constexpr std::size_t kBeamAxes = 4;

inline std::size_t BeamAxisOf(std::int64_t along_x, std::int64_t along_y) {
  // tan(22.5 deg) = 0.4142, to a thousandth.
  const std::int64_t x = std::abs(along_x);
  const std::int64_t y = std::abs(along_y);
  if (1000 * y <= 414 * x) return 0;
  if (1000 * x < 414 * y) return 2;
  return (along_x < 0) == (along_y < 0) ? 1 : 3;
}

/// A cell that all beams together call free.
struct GlassCell {
  std::size_t index = 0;  ///< of the grid's cells
  std::uint8_t axes = 0;  ///< to which it is a wall, a bit each
  WallPoint point;
};

/// Those of `cells`, in order, that are glass become walls.
void KeepGlass(const std::vector<GlassCell>& cells, OccupancyGrid* grid);

}  // namespace masked_mapper
