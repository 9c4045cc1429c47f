// SPDX-License-Identifier: BSD-3-Clause
// A grid as ROS' map_server has it: a grey picture (.pgm) and its place in the world (.yaml).
#pragma once

#include <filesystem>
#include <string>

#include "masked_mapper/rendering/occupancy_grid.hpp"

namespace masked_mapper {

/// Free 254, occupied 0, unknown 205, row by row from the largest y.
std::string GreyPixels(const OccupancyGrid& grid);

/// Writes `stem`.pgm and `stem`.yaml: free 254, occupied 0, unknown 205; row 0 of the picture is
/// the largest y. An empty grid becomes one unknown cell, since a picture without pixels opens
/// nowhere. Throws std::runtime_error when a file cannot be written.
void WriteOccupancyGrid(const OccupancyGrid& grid, const std::filesystem::path& stem);

}  // namespace masked_mapper
