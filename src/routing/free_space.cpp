// SPDX-License-Identifier: BSD-3-Clause
#include "free_space.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "distance_field.hpp"
#include "masked_mapper/geometry/polygon.hpp"
#include "masked_mapper/map/drives.hpp"

namespace masked_mapper {
namespace {

constexpr std::array<std::pair<int, int>, 4> kSides = {{{1, 0}, {-1, 0}, {0, 1}, {0, -1}}};

/// What was not seen between beams, in the middle of what is free and smaller than the robot, hides
/// nothing that it could not be seen around: counted as free.
void FillSpecks(const OccupancyGrid& grid, double radius_m, std::vector<std::uint8_t>& is_free) {
  const auto largest = static_cast<std::size_t>(M_PI * radius_m * radius_m /
                                                (grid.resolution_m * grid.resolution_m));
  std::vector<std::uint8_t> visited(grid.cells.size());
  const auto width = static_cast<std::size_t>(grid.width);
  std::vector<std::size_t> speck;
  for (std::size_t seed = 0; seed < grid.cells.size(); ++seed) {
    if (grid.cells[seed] != Cell::kUnknown || visited[seed] != 0) continue;
    speck.assign(1, seed);
    visited[seed] = 1;
    bool is_open = true;  // of free cells all round
    for (std::size_t i = 0; i < speck.size(); ++i) {
      const int column = static_cast<int>(speck[i] % width);
      const int row = static_cast<int>(speck[i] / width);
      for (const auto& [right, up] : kSides) {
        if (column + right < 0 || column + right >= grid.width || row + up < 0 ||
            row + up >= grid.height) {
          is_open = false;
          continue;
        }
        const std::size_t next =
            static_cast<std::size_t>(row + up) * width + static_cast<std::size_t>(column + right);
        if (grid.cells[next] == Cell::kOccupied) is_open = false;
        if (grid.cells[next] != Cell::kUnknown || visited[next] != 0) continue;
        visited[next] = 1;
        speck.push_back(next);
      }
    }
    if (!is_open || speck.size() > largest) continue;
    for (const std::size_t cell : speck) is_free[cell] = 1;
  }
}

/// Calls `visit(cell)` for the cells that a straight line passes, in order, from a point in cells
/// to another; `visit` says how many cells the line may leap over safely, or less than 0 to stop.
constexpr double kSameEdge = 1e-9;
template <typename Visit>
bool Walk(const Eigen::Vector2d& from, const Eigen::Vector2d& to, const Visit& visit) {
  const Eigen::Vector2d way = to - from;
  const double length = way.norm();
  GridCell cell{static_cast<int>(std::floor(from.x())), static_cast<int>(std::floor(from.y()))};
  const GridCell last{static_cast<int>(std::floor(to.x())), static_cast<int>(std::floor(to.y()))};
  const double never = length + 1.0;
  const int step_x = way.x() > 0.0 ? 1 : -1;
  const int step_y = way.y() > 0.0 ? 1 : -1;
  const auto per_cell = [&](double part) { return part == 0.0 ? never : length / std::abs(part); };
  const double each_x = per_cell(way.x());
  const double each_y = per_cell(way.y());
  const auto next_edge = [&](double at, int cell_at, int step, double each) {
    return each >= never ? never : std::abs(cell_at + (step > 0 ? 1 : 0) - at) * each;
  };
  double at = 0.0;  // along the way, in cells
  double edge_x = next_edge(from.x(), cell.column, step_x, each_x);
  double edge_y = next_edge(from.y(), cell.row, step_y, each_y);
  for (;;) {
    const double leap = visit(cell);
    if (leap < 0.0) return false;
    if (cell == last) return true;
    if (leap > 2.0) {
      at += leap;
      if (at >= length) return true;
      const Eigen::Vector2d here = from + way * (at / length);
      cell = {static_cast<int>(std::floor(here.x())), static_cast<int>(std::floor(here.y()))};
      edge_x = at + next_edge(here.x(), cell.column, step_x, each_x);
      edge_y = at + next_edge(here.y(), cell.row, step_y, each_y);
    } else if (std::abs(edge_x - edge_y) < kSameEdge && edge_x < never && edge_y < never) {
      // Through a corner, past either of the two cells beside it.
      if (visit({cell.column + step_x, cell.row}) < 0.0 &&
          visit({cell.column, cell.row + step_y}) < 0.0) {
        return false;
      }
      cell = {cell.column + step_x, cell.row + step_y};
      at = edge_x;
      edge_x += each_x;
      edge_y += each_y;
    } else if (edge_x < edge_y) {
      cell.column += step_x;
      at = edge_x;
      edge_x += each_x;
    } else {
      cell.row += step_y;
      at = edge_y;
      edge_y += each_y;
    }
    if (at > length) return true;  // the last cell's edge, missed by rounding
  }
}

}  // namespace

FreeSpace::FreeSpace(const OccupancyGrid& grid, const std::vector<Points>& driven,
                     const std::vector<Points>& kept_out, const ClearanceOptions& options)
    : width_(grid.width),
      height_(grid.height),
      resolution_m_(grid.resolution_m),
      origin_(grid.origin_x, grid.origin_y) {
  std::vector<std::uint8_t> is_kept_out(grid.cells.size());
  for (const Points& area : kept_out) {
    ForEachCellInside(area, origin_, resolution_m_, width_, height_,
                      [&](std::size_t cell) { is_kept_out[cell] = 1; });
  }
  std::vector<std::uint8_t> is_free(grid.cells.size());
  std::vector<std::uint8_t> is_wall(grid.cells.size());
  for (std::size_t i = 0; i < grid.cells.size(); ++i) {
    is_free[i] = grid.cells[i] == Cell::kFree ? 1 : 0;
    is_wall[i] = grid.cells[i] == Cell::kOccupied || is_kept_out[i] != 0 ? 1 : 0;
  }
  FillSpecks(grid, options.radius_m, is_free);
  const std::vector<float> clearance = DistanceField(is_wall, width_);
  const auto radius = static_cast<float>(options.radius_m / resolution_m_);
  std::vector<std::uint8_t> is_blocked(grid.cells.size());
  for (std::size_t i = 0; i < grid.cells.size(); ++i) {
    is_blocked[i] = is_free[i] != 0 && clearance[i] >= radius ? 0 : 1;
  }
  if (options.radius_m <= options.driven_radius_m) {
    for (const Points& way : driven) {
      for (std::size_t i = 1; i < way.size(); ++i) {
        if (!IsInside(CellAt(way[i - 1])) || !IsInside(CellAt(way[i]))) continue;
        Walk((way[i - 1] - origin_) / resolution_m_, (way[i] - origin_) / resolution_m_,
             [&](const GridCell& cell) {
               if (IsInside(cell) && is_kept_out[IndexOf(cell)] == 0) is_blocked[IndexOf(cell)] = 0;
               return 0.0;
             });
      }
    }
  }
  room_ = DistanceField(is_blocked, width_);
  for (int row = 0; row < height_; ++row) {
    for (int column = 0; column < width_; ++column) {
      const int to_border = std::min({column + 1, row + 1, width_ - column, height_ - row});
      float& room = room_[IndexOf({column, row})];
      room = std::min(room, static_cast<float>(to_border));
    }
  }
}

bool FreeSpace::Sees(const GridCell& from, const GridCell& to) const {
  const Eigen::Vector2d half(0.5, 0.5);
  return Walk(Eigen::Vector2d(from.column, from.row) + half,
              Eigen::Vector2d(to.column, to.row) + half, [&](const GridCell& cell) {
                if (!IsPassable(cell)) return -1.0;
                // What is nearer than this to anywhere in the cell is passable, too.
                return std::max(0.0, static_cast<double>(room_[IndexOf(cell)]) - M_SQRT2);
              });
}

std::optional<GridCell> FreeSpace::NearestPassable(const Eigen::Vector2d& point,
                                                   double reach_m) const {
  if (room_.empty()) return std::nullopt;
  const GridCell middle = CellAt(point);
  if (IsPassable(middle)) return middle;
  const double reach = reach_m / resolution_m_;
  const auto clamped = [&](double value, int size) {
    return static_cast<int>(std::clamp(value, -1.0, static_cast<double>(size)));
  };
  std::optional<GridCell> nearest;
  double smallest = reach_m;
  const int top = clamped(middle.row + reach + 1.0, height_);
  const int right = clamped(middle.column + reach + 1.0, width_);
  for (int row = clamped(middle.row - reach - 1.0, height_); row <= top; ++row) {
    for (int column = clamped(middle.column - reach - 1.0, width_); column <= right; ++column) {
      if (!IsPassable({column, row})) continue;
      const double off = (CentreOf({column, row}) - point).norm();
      if (off > smallest || (nearest && off == smallest)) continue;
      smallest = off;
      nearest = GridCell{column, row};
    }
  }
  return nearest;
}

GridCell FreeSpace::CellAt(const Eigen::Vector2d& point) const {
  const Eigen::Vector2d cell = (point - origin_) / resolution_m_;
  const auto bounded = [](double value) {
    return static_cast<int>(std::clamp(std::floor(value), -1e9, 1e9));
  };
  return {bounded(cell.x()), bounded(cell.y())};
}

Eigen::Vector2d FreeSpace::CentreOf(const GridCell& cell) const {
  return origin_ + resolution_m_ * Eigen::Vector2d(cell.column + 0.5, cell.row + 0.5);
}

std::vector<FreeSpace::Points> DrivenOn(const BuildingMap& map, FloorId floor) {
  std::vector<FreeSpace::Points> ways;
  for (std::size_t drive = 0; drive < map.drives.size(); ++drive) {
    const IndexRange range = PosesOfDrive(map, drive);
    bool goes_on = false;
    for (std::size_t i = range.begin; i < range.end; ++i) {
      const TrajectoryPose& pose = map.trajectory[i];
      const bool is_here = !pose.in_transit && pose.floor == floor;
      if (is_here && !goes_on) ways.emplace_back();
      if (is_here) ways.back().push_back(pose.T_world_robot.Translation());
      goes_on = is_here;
    }
  }
  return ways;
}

FreeSpace FreeSpaceOf(const BuildingMap& map, const OccupancyGrid& grid, FloorId floor,
                      const ClearanceOptions& clearance) {
  std::vector<FreeSpace::Points> kept_out;
  for (const Area& area : map.areas) {
    if (area.kind == AreaKind::kKeepOut && area.floor == floor) {
      kept_out.push_back(area.corners_in_world);
    }
  }
  return FreeSpace(grid, DrivenOn(map, floor), kept_out, clearance);
}

}  // namespace masked_mapper
