// SPDX-License-Identifier: BSD-3-Clause
#include "glass_walls.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "masked_mapper/rendering/wall_lines.hpp"

namespace masked_mapper {
namespace {

constexpr double kShortest = 0.5;  // m, of a pane; more than somebody is wide
constexpr double kOffLine = 0.06;  // m, of a cell's hits from their line
constexpr double kTied = 0.3;      // m, to a wall that a line may go on along

struct Step {
  int column = 0;
  int row = 0;
};
constexpr std::array<Step, kBeamAxes> kAlong = {{{1, 0}, {1, 1}, {0, 1}, {-1, 1}}};

/// Both in order of cells, which are never the same.
WallCells Merged(const WallCells& walls, const std::vector<GlassCell>& glass) {
  WallCells all{walls.resolution_m, walls.width, walls.height, {}, {}};
  std::size_t wall = 0;
  const auto add_walls_before = [&](std::size_t index) {
    for (; wall < walls.cells.size() && walls.cells[wall] < index; ++wall) {
      all.cells.push_back(walls.cells[wall]);
      all.points.push_back(walls.points[wall]);
    }
  };
  for (const GlassCell& cell : glass) {
    add_walls_before(cell.index);
    all.cells.push_back(cell.index);
    all.points.push_back(cell.point);
  }
  add_walls_before(std::numeric_limits<std::size_t>::max());
  return all;
}

class GlassSearch {
 public:
  GlassSearch(const std::vector<GlassCell>& cells, const OccupancyGrid& grid)
      : cells_(cells), grid_(grid), walls_(WallCellsOf(grid)) {}

  const WallCells& walls() const { return walls_; }

  /// In order of cells.
  std::vector<GlassCell> Found() const {
    std::vector<GlassCell> found;
    for (std::size_t axis = 0; axis < kBeamAxes; ++axis) {
      std::vector<GlassCell> open = OpenAlong(axis);
      if (open.empty()) continue;
      const std::vector<WallLine> lines = LinesAcross(axis, open);
      for (const GlassCell& cell : open) {
        if (IsOnOne(cell, lines)) found.push_back(cell);
      }
    }
    const auto by_index = [](const GlassCell& a, const GlassCell& b) { return a.index < b.index; };
    std::stable_sort(found.begin(), found.end(), by_index);
    const auto same = [](const GlassCell& a, const GlassCell& b) { return a.index == b.index; };
    found.erase(std::unique(found.begin(), found.end(), same), found.end());
    return found;
  }

 private:
  int ColumnOf(std::size_t index) const {
    return static_cast<int>(index % static_cast<std::size_t>(grid_.width));
  }
  int RowOf(std::size_t index) const {
    return static_cast<int>(index / static_cast<std::size_t>(grid_.width));
  }
  bool IsWall(int column, int row) const {
    return column >= 0 && row >= 0 && column < grid_.width && row < grid_.height &&
           grid_.at(column, row) == Cell::kOccupied;
  }

  /// Not what is seen of a wall with its noise: no wall stands right before or behind it.
  std::vector<GlassCell> OpenAlong(std::size_t axis) const {
    constexpr int kNoise = 2;  // cells
    std::vector<GlassCell> open;
    for (const GlassCell& cell : cells_) {
      if ((cell.axes >> axis & 1U) == 0) continue;
      bool is_open = true;
      for (int away = -kNoise; away <= kNoise; ++away) {
        is_open = is_open && !IsWall(ColumnOf(cell.index) + away * kAlong[axis].column,
                                     RowOf(cell.index) + away * kAlong[axis].row);
      }
      if (is_open) open.push_back(cell);
    }
    return open;
  }

  /// Walls within kTied of these cells.
  WallCells Beside(const std::vector<GlassCell>& open) const {
    const int tied = static_cast<int>(std::ceil(kTied / grid_.resolution_m));
    std::vector<std::uint8_t> is_taken(walls_.cells.size());
    for (const GlassCell& cell : open) {
      const int first = std::max(0, ColumnOf(cell.index) - tied);
      const int last = std::min(grid_.width - 1, ColumnOf(cell.index) + tied);
      for (int row = std::max(0, RowOf(cell.index) - tied);
           row <= std::min(grid_.height - 1, RowOf(cell.index) + tied); ++row) {
        auto wall = std::lower_bound(walls_.cells.begin(), walls_.cells.end(), Index(first, row));
        for (; wall != walls_.cells.end() && *wall <= Index(last, row); ++wall) {
          is_taken[static_cast<std::size_t>(wall - walls_.cells.begin())] = 1;
        }
      }
    }
    WallCells beside{walls_.resolution_m, walls_.width, walls_.height, {}, {}};
    for (std::size_t wall = 0; wall < is_taken.size(); ++wall) {
      if (is_taken[wall] == 0) continue;
      beside.cells.push_back(walls_.cells[wall]);
      beside.points.push_back(walls_.points[wall]);
    }
    return beside;
  }

  /// Of these cells and the walls beside them.
  std::vector<WallLine> LinesAcross(std::size_t axis, const std::vector<GlassCell>& open) const {
    std::vector<WallLine> lines = FitWallLines(Merged(Beside(open), open));
    const double angle = std::atan2(kAlong[axis].row, kAlong[axis].column);
    const auto is_no_pane = [&](const WallLine& line) {
      const Eigen::Vector2d way = line.b - line.a;
      const Eigen::Vector2d along(std::cos(angle), std::sin(angle));
      return way.norm() < kShortest || std::abs(way.dot(along)) > std::sqrt(0.5) * way.norm();
    };
    lines.erase(std::remove_if(lines.begin(), lines.end(), is_no_pane), lines.end());
    return lines;
  }

  std::size_t Index(int column, int row) const {
    return static_cast<std::size_t>(row) * static_cast<std::size_t>(grid_.width) +
           static_cast<std::size_t>(column);
  }

  static bool IsOnOne(const GlassCell& cell, const std::vector<WallLine>& lines) {
    const Eigen::Vector2d point(cell.point.x, cell.point.y);
    return std::any_of(lines.begin(), lines.end(), [&](const WallLine& line) {
      const Eigen::Vector2d way = line.b - line.a;
      const double at = std::clamp(way.dot(point - line.a) / way.squaredNorm(), 0.0, 1.0);
      return (line.a + at * way - point).norm() <= kOffLine;
    });
  }

  const std::vector<GlassCell>& cells_;
  const OccupancyGrid& grid_;
  WallCells walls_;
};

}  // namespace

void KeepGlass(const std::vector<GlassCell>& cells, OccupancyGrid* grid) {
  if (cells.empty()) return;
  const GlassSearch search(cells, *grid);
  const std::vector<GlassCell> found = search.Found();
  if (found.empty()) return;
  grid->walls = Merged(search.walls(), found).points;
  for (const GlassCell& cell : found) grid->cells[cell.index] = Cell::kOccupied;
}

}  // namespace masked_mapper
