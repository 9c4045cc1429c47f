// SPDX-License-Identifier: BSD-3-Clause
#include "floor_paths.hpp"

#include <algorithm>
#include <cmath>
#include <functional>
#include <queue>

#include "masked_mapper/text/check.hpp"

namespace masked_mapper {

template <typename Visit>
void FloorPaths::ForEachStep(const GridCell& cell, const Visit& visit) const {
  for (int up = -1; up <= 1; ++up) {
    for (int right = -1; right <= 1; ++right) {
      if (up == 0 && right == 0) continue;
      const GridCell next{cell.column + right, cell.row + up};
      if (!space_.IsPassable(next)) continue;
      // Not between two corners that touch (as FreeSpace::Sees has it).
      if (up != 0 && right != 0 && !space_.IsPassable({cell.column + right, cell.row}) &&
          !space_.IsPassable({cell.column, cell.row + up})) {
        continue;
      }
      visit(next);
    }
  }
}

float FloorPaths::Distance(const GridCell& a, const GridCell& b) const {
  return std::hypot(static_cast<float>(a.column - b.column), static_cast<float>(a.row - b.row));
}

FloorPaths::FloorPaths(const FreeSpace& space, const GridCell& start,
                       const std::vector<GridCell>& targets)
    : space_(space), start_(start) {
  Check(space.IsPassable(start), "a search starts where the robot can be");
  const auto cells =
      static_cast<std::size_t>(space.width()) * static_cast<std::size_t>(space.height());
  length_.assign(cells, std::numeric_limits<float>::infinity());
  parent_.assign(cells, 0);
  is_reached_.assign(cells, 0);
  std::size_t open_targets = 0;
  std::vector<std::uint8_t> is_target(cells);
  for (const GridCell& target : targets) {
    std::uint8_t& mark = is_target[space.IndexOf(target)];
    open_targets += mark == 0 ? 1 : 0;
    mark = 1;
  }
  std::priority_queue<Entry, std::vector<Entry>, std::greater<>> open;
  const auto first = static_cast<std::uint32_t>(space.IndexOf(start));
  length_[first] = 0.0F;
  parent_[first] = first;
  open.push({0.0F, first});
  while (!open.empty() && (open_targets > 0 || targets.empty())) {
    const Entry entry = open.top();
    open.pop();
    if (is_reached_[entry.cell] != 0 || entry.length > length_[entry.cell]) continue;
    const GridCell cell = space.CellOf(entry.cell);
    Settle(cell);
    if (is_target[entry.cell] != 0) --open_targets;
    const std::uint32_t turn = parent_[entry.cell];
    const GridCell turn_cell = space.CellOf(turn);
    ForEachStep(cell, [&](const GridCell& next) {
      const std::size_t index = space.IndexOf(next);
      if (is_reached_[index] != 0) return;
      const float length = length_[turn] + Distance(turn_cell, next);
      if (length >= length_[index]) return;
      length_[index] = length;
      parent_[index] = turn;
      open.push({length, static_cast<std::uint32_t>(index)});
    });
  }
}

// Whether the way's last turn sees this cell was taken for granted; where it does not, the way
// comes by a cell beside this one, or by the turn before that.
void FloorPaths::Settle(const GridCell& cell) {
  const std::size_t index = space_.IndexOf(cell);
  is_reached_[index] = 1;
  if (space_.Sees(space_.CellOf(parent_[index]), cell)) return;
  length_[index] = std::numeric_limits<float>::infinity();
  ForEachStep(cell, [&](const GridCell& beside) {
    const std::size_t from = space_.IndexOf(beside);
    if (is_reached_[from] == 0 || beside == cell) return;
    const GridCell turn = space_.CellOf(parent_[from]);
    const float past_turn = length_[parent_[from]] + Distance(turn, cell);
    if (past_turn < length_[index] && space_.Sees(turn, cell)) {
      length_[index] = past_turn;
      parent_[index] = parent_[from];
    }
    const float past_beside = length_[from] + Distance(beside, cell);
    if (past_beside < length_[index]) {
      length_[index] = past_beside;
      parent_[index] = static_cast<std::uint32_t>(from);
    }
  });
}

// Turns that are not needed go, and those that are move to where both ways are shortest.
void FloorPaths::PullTaut(std::vector<GridCell>& way) const {
  constexpr int kRounds = 200;  // a turn moves by a cell a round
  bool has_changed = true;
  for (int round = 0; round < kRounds && has_changed; ++round) {
    has_changed = false;
    for (std::size_t i = 1; i + 1 < way.size(); ++i) {
      if (space_.Sees(way[i - 1], way[i + 1])) {
        way.erase(way.begin() + static_cast<std::ptrdiff_t>(i));
        has_changed = true;
        --i;
        continue;
      }
      GridCell best = way[i];
      float shortest = Distance(way[i - 1], best) + Distance(best, way[i + 1]) - 1e-4F;
      ForEachStep(way[i], [&](const GridCell& beside) {
        const float length = Distance(way[i - 1], beside) + Distance(beside, way[i + 1]);
        if (length >= shortest || !space_.Sees(way[i - 1], beside) ||
            !space_.Sees(beside, way[i + 1])) {
          return;
        }
        shortest = length;
        best = beside;
      });
      if (best == way[i]) continue;
      way[i] = best;
      has_changed = true;
    }
  }
}

std::optional<std::vector<GridCell>> FloorPaths::WayTo(const GridCell& target) const {
  if (!Reaches(target)) return std::nullopt;
  std::vector<GridCell> way = {target};
  while (!(way.back() == start_)) {
    way.push_back(space_.CellOf(parent_[space_.IndexOf(way.back())]));
  }
  std::reverse(way.begin(), way.end());
  PullTaut(way);
  return way;
}

GridCell FloorPaths::NearestReached(const Eigen::Vector2d& point) const {
  GridCell nearest = start_;
  double smallest = (space_.CentreOf(start_) - point).squaredNorm();
  for (std::size_t index = 0; index < is_reached_.size(); ++index) {
    if (is_reached_[index] == 0) continue;
    const double off = (space_.CentreOf(space_.CellOf(index)) - point).squaredNorm();
    if (off >= smallest) continue;
    smallest = off;
    nearest = space_.CellOf(index);
  }
  return nearest;
}

double LengthOf(const std::vector<Eigen::Vector2d>& way) {
  double length = 0.0;
  for (std::size_t i = 1; i < way.size(); ++i) length += (way[i] - way[i - 1]).norm();
  return length;
}

}  // namespace masked_mapper
