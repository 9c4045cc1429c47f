// SPDX-License-Identifier: BSD-3-Clause
// A grid as one draws it: `#` wall, `.` free, anything else unknown; the last line is row 0.
#pragma once

#include <string>
#include <vector>

#include "masked_mapper/rendering/occupancy_grid.hpp"

namespace masked_mapper {

inline OccupancyGrid DrawnGrid(const std::vector<std::string>& lines, double resolution_m = 0.1) {
  OccupancyGrid grid;
  grid.resolution_m = resolution_m;
  grid.width = static_cast<int>(lines.front().size());
  grid.height = static_cast<int>(lines.size());
  for (std::size_t row = lines.size(); row-- > 0;) {
    for (std::size_t column = 0; column < lines[row].size(); ++column) {
      const char c = lines[row][column];
      grid.cells.push_back(c == '#' ? Cell::kOccupied : c == '.' ? Cell::kFree : Cell::kUnknown);
      if (c != '#') continue;
      const auto up = static_cast<double>(lines.size() - 1 - row);
      grid.walls.push_back({static_cast<float>((static_cast<double>(column) + 0.5) * resolution_m),
                            static_cast<float>((up + 0.5) * resolution_m)});
    }
  }
  return grid;
}

}  // namespace masked_mapper
