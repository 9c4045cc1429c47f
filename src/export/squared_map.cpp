// SPDX-License-Identifier: BSD-3-Clause
#include "squared_map.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>

#include "floor_label.hpp"
#include "masked_mapper/map/trajectory.hpp"
#include "masked_mapper/text/enum_names.hpp"
#include "masked_mapper/text/input_error.hpp"
#include "masked_mapper/text/number_text.hpp"
#include "output_file.hpp"

namespace masked_mapper {
namespace {

/// A grid's place on the raster on which all grids of its resolution lie.
struct CellBox {
  std::int64_t left = 0;
  std::int64_t bottom = 0;
  std::int64_t right = 0;
  std::int64_t top = 0;
};

CellBox BoxOf(const OccupancyGrid& grid) {
  const std::int64_t left = std::llround(grid.origin_x / grid.resolution_m);
  const std::int64_t bottom = std::llround(grid.origin_y / grid.resolution_m);
  return {left, bottom, left + grid.width, bottom + grid.height};
}

OccupancyGrid Padded(const OccupancyGrid& grid, const CellBox& box) {
  OccupancyGrid padded;
  padded.resolution_m = grid.resolution_m;
  padded.origin_x = static_cast<double>(box.left) * grid.resolution_m;
  padded.origin_y = static_cast<double>(box.bottom) * grid.resolution_m;
  padded.width = static_cast<int>(box.right - box.left);
  padded.height = static_cast<int>(box.top - box.bottom);
  padded.cells.resize(static_cast<std::size_t>(padded.width) *
                      static_cast<std::size_t>(padded.height));
  padded.walls = grid.walls;
  if (grid.cells.empty()) return padded;
  const CellBox own = BoxOf(grid);
  for (int row = 0; row < grid.height; ++row) {
    const auto from = grid.cells.begin() + static_cast<std::ptrdiff_t>(row) * grid.width;
    std::copy(from, from + grid.width,
              padded.cells.begin() +
                  (static_cast<std::ptrdiff_t>(own.bottom - box.bottom) + row) * padded.width +
                  static_cast<std::ptrdiff_t>(own.left - box.left));
  }
  return padded;
}

void PadAll(std::vector<OccupancyGrid>& grids) {
  constexpr double kMaxCells = 4e8;  // as of a single grid
  CellBox box;
  bool is_first = true;
  for (const OccupancyGrid& grid : grids) {
    if (grid.cells.empty()) continue;
    const CellBox own = BoxOf(grid);
    if (is_first) box = own;
    is_first = false;
    box = {std::min(box.left, own.left), std::min(box.bottom, own.bottom),
           std::max(box.right, own.right), std::max(box.top, own.top)};
  }
  if (is_first) box.right = box.top = 1;
  const double cells =
      static_cast<double>(box.right - box.left) * static_cast<double>(box.top - box.bottom);
  if (cells > kMaxCells) {
    throw InputError(
        "floors that lie so far apart are too large for grids of one size: use a"
        " coarser --resolution");
  }
  for (OccupancyGrid& grid : grids) grid = Padded(grid, box);
}

}  // namespace

SquaredMap Squared(const BuildingMap& map, const HandoverOptions& options) {
  CheckFloorLabels(map.graph.floors());
  SquaredMap squared;
  squared.map = map;
  if (!options.keep_frame) {
    std::vector<WallLine> all;
    for (const OccupancyGrid& grid : RenderFloors(map, options.drawing.grid)) {
      const std::vector<WallLine> lines = FitWallLines(grid);
      all.insert(all.end(), lines.begin(), lines.end());
    }
    squared.T_squared_world = {0.0, 0.0, -DirectionOf(all).value_or(WallDirection{}).angle};
    MoveMap(squared.T_squared_world, squared.map);
  }
  squared.grids = RenderFloors(squared.map, options.drawing.grid);
  PadAll(squared.grids);
  for (const OccupancyGrid& grid : squared.grids) squared.walls.push_back(FitWallLines(grid));
  squared.lanes = LanesOf(squared.map, squared.grids, options.clearance);
  return squared;
}

std::vector<std::string> CrossingNames(const std::vector<Crossing>& crossings) {
  std::array<int, 2> counts{};
  std::vector<std::string> names;
  for (const Crossing& crossing : crossings) {
    const int number = ++counts[static_cast<std::size_t>(crossing.kind)];
    names.push_back(std::string(Name(crossing.kind)) + "_" + std::to_string(number));
  }
  return names;
}

void WriteFrame(const SquaredMap& squared, const Eigen::Vector2d& shift,
                const std::filesystem::path& path) {
  const auto point = [&](const Eigen::Vector2d& at) {
    return "[" + FixedText(at.x() + shift.x(), 3) + ", " + FixedText(at.y() + shift.y(), 3) + "]";
  };
  std::string text =
      "# Coordinates here are those of the map, turned by yaw_deg about its origin and then\n"
      "# shifted: x = cos * map_x - sin * map_y + shift.\nyaw_deg: " +
      FixedText(RadToDeg(squared.T_squared_world.theta), 6) + "\nshift_m: [" +
      FixedText(shift.x(), 6) + ", " + FixedText(shift.y(), 6) + "]\nfloors:\n";
  const std::vector<Floor>& floors = squared.map.graph.floors();
  for (const Floor& floor : floors) {
    text += "  - {label: \"" + floor.label + "\", elevation_m: " + FixedText(floor.elevation, 3) +
            "}\n";
  }
  const std::vector<std::string> names = CrossingNames(squared.lanes.crossings);
  text += names.empty() ? "crossings: []\n" : "crossings:\n";
  for (std::size_t i = 0; i < names.size(); ++i) {
    text += "  - name: " + names[i] + "\n    stops:\n";
    for (const Stop& stop : squared.lanes.crossings[i].stops) {
      text += "      - {floor: \"" + squared.map.graph.floor(stop.floor).label +
              "\", at: " + point(stop.T_world_robot.Translation()) + "}\n";
    }
  }
  WriteFile(path, text);
}

}  // namespace masked_mapper
