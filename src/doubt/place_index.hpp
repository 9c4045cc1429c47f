// SPDX-License-Identifier: BSD-3-Clause
// What lies near a place, without going through all that lies anywhere.
#pragma once

#include <Eigen/Core>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <unordered_map>
#include <vector>

#include "masked_mapper/pose_graph/pose_graph.hpp"

namespace masked_mapper {

/// Numbers of things, by square cells of the floors' planes.
class PlaceIndex {
 public:
  explicit PlaceIndex(double cell_m) : cell_m_(cell_m) {}

  /// Into all cells that reach to within `reach_m` of the point along both axes; into none twice in
  /// a row.
  void Add(FloorId floor, const Eigen::Vector2d& point, double reach_m, std::size_t item) {
    const Cell first = CellOf(floor, point.array() - reach_m);
    const Cell last = CellOf(floor, point.array() + reach_m);
    for (int column = first.column; column <= last.column; ++column) {
      for (int row = first.row; row <= last.row; ++row) {
        std::vector<std::size_t>& items = cells_[{floor, column, row}];
        if (items.empty() || items.back() != item) items.push_back(item);
      }
    }
  }

  /// All that reaches the point, in the order in which it was added, and some that ends just
  /// before.
  const std::vector<std::size_t>& Near(FloorId floor, const Eigen::Vector2d& point) const {
    static const std::vector<std::size_t> kNone;
    const auto cell = cells_.find(CellOf(floor, point));
    return cell == cells_.end() ? kNone : cell->second;
  }

 private:
  struct Cell {
    FloorId floor;
    int column, row;
    bool operator==(const Cell& other) const {
      return floor == other.floor && column == other.column && row == other.row;
    }
  };
  struct HashOfCell {
    std::size_t operator()(const Cell& cell) const {
      const auto column = static_cast<std::uint32_t>(cell.column);
      const auto row = static_cast<std::uint32_t>(cell.row);
      std::uint64_t mixed = (std::uint64_t{column} << 32U | row) +
                            0x9E3779B97F4A7C15U * static_cast<std::uint64_t>(cell.floor + 1);
      mixed = (mixed ^ (mixed >> 29U)) * 0xBF58476D1CE4E5B9U;
      return static_cast<std::size_t>(mixed ^ (mixed >> 32U));
    }
  };

  Cell CellOf(FloorId floor, const Eigen::Vector2d& point) const {
    return {floor, static_cast<int>(std::floor(point.x() / cell_m_)),
            static_cast<int>(std::floor(point.y() / cell_m_))};
  }

  double cell_m_;
  std::unordered_map<Cell, std::vector<std::size_t>, HashOfCell> cells_;
};

}  // namespace masked_mapper
