// SPDX-License-Identifier: BSD-3-Clause
#include "report_floors.hpp"

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <string>

#include "point_cloud_file.hpp"
#include "report_columns.hpp"

namespace masked_mapper {
namespace {

using Json = nlohmann::ordered_json;

// These and those of report_motion.cpp stay below 12 MB of page; a laptop draws them without
// effort.
constexpr std::size_t kMaxWallPoints = 1000000;
constexpr std::size_t kMaxFreeCells = 8000000;
// What every WebGL 2 can hold in one direction of a texture.
constexpr int kMaxTextureSide = 2048;

// Every `factor` x `factor` block of cells that holds a wall gives its first wall point.
std::vector<WallPoint> ThinnedWalls(const OccupancyGrid& grid, int factor) {
  if (factor == 1) return grid.walls;
  const int columns = (grid.width + factor - 1) / factor;
  std::vector<WallPoint> thinned;
  std::vector<bool> taken;
  std::size_t wall = 0;
  for (int row = 0; row < grid.height; ++row) {
    if (row % factor == 0) taken.assign(static_cast<std::size_t>(columns), false);
    for (int column = 0; column < grid.width; ++column) {
      if (grid.at(column, row) != Cell::kOccupied) continue;
      const WallPoint& point = grid.walls[wall++];
      const auto block = static_cast<std::size_t>(column / factor);
      if (!taken[block]) thinned.push_back(point);
      taken[block] = true;
    }
  }
  return thinned;
}

// The walls of all floors, thinned alike and no more than they must be.
std::vector<std::vector<WallPoint>> WallsWithinLimit(const std::vector<OccupancyGrid>& grids,
                                                     int* factor) {
  for (*factor = 1;; ++*factor) {
    std::vector<std::vector<WallPoint>> walls;
    std::size_t count = 0;
    for (const OccupancyGrid& grid : grids) {
      walls.push_back(ThinnedWalls(grid, *factor));
      count += walls.back().size();
    }
    if (count <= kMaxWallPoints) return walls;
  }
}

Json WallsJson(const OccupancyGrid& grid, const std::vector<WallPoint>& walls, int factor) {
  const double extent = grid.resolution_m * std::max(grid.width, grid.height);
  const double step = std::max(extent / 65535.0, 0.001);
  std::vector<std::uint16_t> xy;
  xy.reserve(2 * walls.size());
  for (const WallPoint& wall : walls) {
    xy.push_back(Quantised(static_cast<double>(wall.x) - grid.origin_x, step));
    xy.push_back(Quantised(static_cast<double>(wall.y) - grid.origin_y, step));
  }
  return {{"count", walls.size()},
          {"origin", {grid.origin_x, grid.origin_y}},
          {"step_m", step},
          {"spacing_m", grid.resolution_m * factor},
          {"xy_u16", Base64(xy)}};
}

// One bit per block of cells, the lowest bit of a byte first; rows start at a byte.
Json FreeSpaceJson(const OccupancyGrid& grid, std::size_t limit) {
  int factor = 1;
  const auto side = [&factor](int cells) { return (cells + factor - 1) / factor; };
  while (static_cast<std::size_t>(side(grid.width)) * static_cast<std::size_t>(side(grid.height)) >
             limit ||
         std::max(side(grid.width), side(grid.height)) > kMaxTextureSide) {
    ++factor;
  }
  const auto bytes_per_row = static_cast<std::size_t>((side(grid.width) + 7) / 8);
  std::vector<std::uint8_t> bits(bytes_per_row * static_cast<std::size_t>(side(grid.height)));
  for (int row = 0; row < grid.height; ++row) {
    for (int column = 0; column < grid.width; ++column) {
      if (grid.at(column, row) != Cell::kFree) continue;
      const int block = column / factor;
      std::uint8_t& byte = bits[static_cast<std::size_t>(row / factor) * bytes_per_row +
                                static_cast<std::size_t>(block / 8)];
      byte = static_cast<std::uint8_t>(byte | 1U << static_cast<unsigned>(block % 8));
    }
  }
  return {{"width", side(grid.width)},
          {"height", side(grid.height)},
          {"origin", {grid.origin_x, grid.origin_y}},
          {"cell_m", grid.resolution_m * factor},
          {"bits", Base64(bits)}};
}

}  // namespace

Json FloorsJson(const PoseGraph& graph, const std::vector<OccupancyGrid>& grids) {
  const std::vector<Colour> colours = FloorColours(graph.floors());
  int factor = 1;
  const std::vector<std::vector<WallPoint>> walls = WallsWithinLimit(grids, &factor);
  Json json = Json::array();
  for (std::size_t i = 0; i < grids.size(); ++i) {
    char colour[8];
    std::snprintf(colour, sizeof(colour), "#%02x%02x%02x", colours[i].red, colours[i].green,
                  colours[i].blue);
    json.push_back({{"label", graph.floors()[i].label},
                    {"elevation_m", graph.floors()[i].elevation},
                    {"colour", colour},
                    {"walls", WallsJson(grids[i], walls[i], factor)},
                    {"free", FreeSpaceJson(grids[i], kMaxFreeCells / grids.size())}});
  }
  return json;
}

}  // namespace masked_mapper
