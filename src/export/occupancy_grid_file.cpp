// SPDX-License-Identifier: BSD-3-Clause
#include "occupancy_grid_file.hpp"

#include <string>

#include "masked_mapper/text/number_text.hpp"
#include "output_file.hpp"

namespace masked_mapper {
namespace {

// As map_server's own saver has them; 205 lies between the thresholds below.
char Grey(Cell cell) {
  switch (cell) {
    case Cell::kFree:
      return static_cast<char>(254);
    case Cell::kOccupied:
      return static_cast<char>(0);
    default:
      return static_cast<char>(205);
  }
}

std::string Pgm(const OccupancyGrid& grid) {
  return "P5\n" + std::to_string(grid.width) + " " + std::to_string(grid.height) + "\n255\n" +
         GreyPixels(grid);
}

std::string Yaml(const OccupancyGrid& grid, const std::string& picture_name) {
  return "image: " + picture_name + "\nresolution: " + ExactText(grid.resolution_m) +
         "\norigin: [" + FixedText(grid.origin_x, 6) + ", " + FixedText(grid.origin_y, 6) +
         ", 0.0]\nnegate: 0\noccupied_thresh: 0.65\nfree_thresh: 0.196\nmode: trinary\n";
}

}  // namespace

std::string GreyPixels(const OccupancyGrid& grid) {
  std::string pixels;
  pixels.reserve(grid.cells.size());
  for (int row = grid.height - 1; row >= 0; --row) {
    for (int column = 0; column < grid.width; ++column) pixels += Grey(grid.at(column, row));
  }
  return pixels;
}

void WriteOccupancyGrid(const OccupancyGrid& grid, const std::filesystem::path& stem) {
  if (grid.cells.empty()) {
    OccupancyGrid unknown;
    unknown.resolution_m = grid.resolution_m;
    unknown.width = unknown.height = 1;
    unknown.cells = {Cell::kUnknown};
    WriteOccupancyGrid(unknown, stem);
    return;
  }
  // Not replace_extension: a label may hold dots.
  const std::filesystem::path picture = stem.string() + ".pgm";
  WriteFile(picture, Pgm(grid));
  WriteFile(stem.string() + ".yaml", Yaml(grid, picture.filename().string()));
}

}  // namespace masked_mapper
