// SPDX-License-Identifier: BSD-3-Clause
#include "map_changes.hpp"

#include <algorithm>
#include <cmath>

namespace masked_mapper {
namespace {

constexpr double kCell = 0.2;        // m
constexpr double kFarthest = 8.0;    // m; what is farther is not seen well enough to accuse a map
constexpr double kApart = 0.4;       // m between two places from which something counts twice
constexpr int kLeastVotes = 3;       // from places apart
constexpr double kLeastShare = 0.8;  // of the votes on a cell
constexpr double kLeastSize = 0.7;   // m; smaller things are moved every day
constexpr std::size_t kLeastCells = 4;
constexpr double kMargin = 0.5;  // m before the end of a beam that is not yet free
constexpr double kStep = 0.2;    // m along a beam

bool IsFreeAround(const OccupancyGrid& grid, const Eigen::Vector2d& point_in_world) {
  const int column =
      static_cast<int>(std::floor((point_in_world.x() - grid.origin_x) / grid.resolution_m));
  const int row =
      static_cast<int>(std::floor((point_in_world.y() - grid.origin_y) / grid.resolution_m));
  for (int y = row - 1; y <= row + 1; ++y) {
    for (int x = column - 1; x <= column + 1; ++x) {
      const bool is_inside = x >= 0 && y >= 0 && x < grid.width && y < grid.height;
      if (!is_inside || grid.at(x, y) != Cell::kFree) return false;
    }
  }
  return true;
}

bool IsOccupied(const OccupancyGrid& grid, const Eigen::Vector2d& point_in_world) {
  const double column = std::floor((point_in_world.x() - grid.origin_x) / grid.resolution_m);
  const double row = std::floor((point_in_world.y() - grid.origin_y) / grid.resolution_m);
  if (!(column >= 0.0 && row >= 0.0 && column < grid.width && row < grid.height)) return false;
  return grid.at(static_cast<int>(column), static_cast<int>(row)) == Cell::kOccupied;
}

}  // namespace

void ChangeFinder::Vote(ChangeKind kind, FloorId floor, const Eigen::Vector2d& point_in_world,
                        bool changed, const Pose2& T_world_robot) {
  const Cell cell{static_cast<std::int32_t>(std::floor(point_in_world.x() / kCell)),
                  static_cast<std::int32_t>(std::floor(point_in_world.y() / kCell))};
  Votings& votings = votes_[{floor, kind}];
  // What is as it was is counted only where something was held against it.
  const auto known = votings.find(cell);
  if (known == votings.end() && (!changed || asks_of_known_cells_)) return;
  Votes& votes = known == votings.end() ? votings[cell] : known->second;
  if (std::hypot(votes.last_x - T_world_robot.x, votes.last_y - T_world_robot.y) < kApart) return;
  votes.last_x = static_cast<float>(T_world_robot.x);
  votes.last_y = static_cast<float>(T_world_robot.y);
  constexpr std::uint16_t kMost = 60000;
  std::uint16_t& count = changed ? votes.changed : votes.as_it_was;
  count = std::min<std::uint16_t>(kMost, static_cast<std::uint16_t>(count + 1));
}

void ChangeFinder::Observe(const LaserScan& scan, const SearchableFloor& floor,
                           const Pose2& T_world_robot) {
  floors_[floor.floor()] = &floor;
  const OccupancyGrid& grid = floor.seen();
  const PointTransform to_world(T_world_robot * scan.T_robot_laser);
  for (std::size_t beam = 0; beam < scan.size(); ++beam) {
    if (!scan.IsHit(beam)) continue;
    const double range = scan.ranges[beam];
    const double angle = scan.Angle(beam);
    const Eigen::Vector2d direction(std::cos(angle), std::sin(angle));
    if (range <= kFarthest) {
      const Eigen::Vector2d end = to_world * Eigen::Vector2d(range * direction);
      Vote(ChangeKind::kNew, floor.floor(), end, IsFreeAround(grid, end), T_world_robot);
      if (IsOccupied(grid, end)) {
        Vote(ChangeKind::kGone, floor.floor(), end, false, T_world_robot);
      }
    }
    for (double at = kStep; at < std::min(range - kMargin, kFarthest); at += kStep) {
      const Eigen::Vector2d through = to_world * Eigen::Vector2d(at * direction);
      if (IsOccupied(grid, through)) {
        Vote(ChangeKind::kGone, floor.floor(), through, true, T_world_robot);
      }
      Vote(ChangeKind::kNew, floor.floor(), through, false, T_world_robot);
    }
  }
}

std::map<ChangeFinder::Where, std::set<ChangeFinder::Cell>> ChangeFinder::ChangedCells() const {
  std::map<Where, std::set<Cell>> changed;
  for (const auto& [where, votings] : votes_) {
    for (const auto& [cell, votes] : votings) {
      const int all = votes.changed + votes.as_it_was;
      if (votes.changed < kLeastVotes || votes.changed < kLeastShare * all) continue;
      changed[where].insert(cell);
    }
  }
  return changed;
}

// The map's own scans vote on the cells that are voted on.
void ChangeFinder::AskMap(const ScansOfFloor& scans) {
  for (const auto& [id, floor] : floors_) {
    std::vector<Eigen::Vector2d> asked;
    for (const auto& [where, votings] : votes_) {
      if (where.first != id) continue;
      for (const auto& [cell, votes] : votings) {
        asked.emplace_back(kCell * (cell.first + 0.5), kCell * (cell.second + 0.5));
      }
    }
    for (const PosedScan& own : scans(id)) {
      const Eigen::Vector2d at = own.T_world_robot.Translation();
      const bool is_near = std::any_of(asked.begin(), asked.end(), [&](const Eigen::Vector2d& one) {
        return (one - at).norm() < kFarthest + 1.0;
      });
      if (is_near) Observe(*own.scan, *floor, own.T_world_robot);
    }
  }
}

// What is as it was for most of what was seen of it.
void ChangeFinder::Forget(std::map<Where, std::set<Cell>>& changed) const {
  for (const auto& [where, votings] : votes_) {
    for (const auto& [cell, votes] : votings) {
      const int all = votes.changed + votes.as_it_was;
      if (votes.changed > (1.0 - kLeastShare) * all) changed[where].erase(cell);
    }
  }
}

std::vector<MapChange> ChangeFinder::Find(const ScansOfFloor& scans) const {
  std::map<Where, std::set<Cell>> all_changed = ChangedCells();
  ChangeFinder before;
  before.floors_ = floors_;
  before.asks_of_known_cells_ = true;
  for (const auto& [where, cells] : all_changed) {
    for (const Cell& cell : cells) before.votes_[where][cell];
  }
  before.AskMap(scans);
  before.Forget(all_changed);
  std::vector<MapChange> changes;
  for (auto& [where, changed] : all_changed) {
    while (!changed.empty()) {  // one region after the other, over gaps of a cell
      std::vector<Cell> region{*changed.begin()};
      changed.erase(changed.begin());
      for (std::size_t i = 0; i < region.size(); ++i) {
        for (std::int32_t y = -2; y <= 2; ++y) {
          for (std::int32_t x = -2; x <= 2; ++x) {
            const auto near = changed.find({region[i].first + x, region[i].second + y});
            if (near == changed.end()) continue;
            region.push_back(*near);
            changed.erase(near);
          }
        }
      }
      Eigen::Array2d low = Eigen::Array2d::Constant(1e9);
      Eigen::Array2d high = -low;
      for (const Cell& cell : region) {
        const Eigen::Array2d corner(kCell * cell.first, kCell * cell.second);
        low = low.min(corner);
        high = high.max(corner + kCell);
      }
      const double size = (high - low).maxCoeff();
      if (size < kLeastSize || region.size() < kLeastCells) continue;
      const Eigen::Array2d middle = 0.5 * (low + high);
      changes.push_back({where.second, where.first, middle.x(), middle.y(), size});
    }
  }
  std::stable_sort(changes.begin(), changes.end(), [](const MapChange& a, const MapChange& b) {
    return a.floor != b.floor ? a.floor < b.floor : a.size_m > b.size_m;
  });
  return changes;
}

}  // namespace masked_mapper
