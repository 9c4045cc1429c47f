// SPDX-License-Identifier: BSD-3-Clause
#include "glass_walls.hpp"

#include <algorithm>
#include <array>
#include <cmath>

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

class GlassSearch {
 public:
  GlassSearch(const std::vector<GlassCell>& cells, const OccupancyGrid& grid)
      : cells_(cells), grid_(grid) {}

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

  /// Of these cells and the walls beside them.
  std::vector<WallLine> LinesAcross(std::size_t axis, const std::vector<GlassCell>& open) const {
    const int tied = static_cast<int>(std::ceil(kTied / grid_.resolution_m));
    std::vector<std::uint8_t> is_taken(grid_.cells.size());
    for (const GlassCell& cell : open) {
      for (int up = -tied; up <= tied; ++up) {
        for (int right = -tied; right <= tied; ++right) {
          const int column = ColumnOf(cell.index) + right;
          const int row = RowOf(cell.index) + up;
          if (IsWall(column, row)) is_taken[Index(column, row)] = 1;
        }
      }
    }
    OccupancyGrid drawn = grid_;
    drawn.walls.clear();
    std::size_t wall = 0;
    std::size_t glass = 0;
    for (std::size_t index = 0; index < grid_.cells.size(); ++index) {
      const bool is_wall = grid_.cells[index] == Cell::kOccupied;
      const bool is_glass = glass < open.size() && open[glass].index == index;
      drawn.cells[index] = is_glass || is_taken[index] != 0 ? Cell::kOccupied : Cell::kUnknown;
      if (is_glass) drawn.walls.push_back(open[glass++].point);
      if (is_wall && is_taken[index] != 0) drawn.walls.push_back(grid_.walls[wall]);
      if (is_wall) ++wall;
    }
    std::vector<WallLine> lines = FitWallLines(drawn);
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
};

}  // namespace

void KeepGlass(const std::vector<GlassCell>& cells, OccupancyGrid* grid) {
  const std::vector<GlassCell> found = GlassSearch(cells, *grid).Found();
  if (found.empty()) return;
  std::vector<WallPoint> walls;
  std::size_t wall = 0;
  std::size_t glass = 0;
  for (std::size_t index = 0; index < grid->cells.size(); ++index) {
    if (glass < found.size() && found[glass].index == index) {
      grid->cells[index] = Cell::kOccupied;
      walls.push_back(found[glass++].point);
    } else if (grid->cells[index] == Cell::kOccupied) {
      walls.push_back(grid->walls[wall++]);
    }
  }
  grid->walls = std::move(walls);
}

}  // namespace masked_mapper
