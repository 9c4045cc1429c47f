// SPDX-License-Identifier: BSD-3-Clause
// Shortest ways on one floor, from one place to several, straight where nothing stands in between:
// Lazy Theta* (Nash, Koenig and Tovey 2010) over the cells, then drawn taut. Steps from cell to
// cell alone would be up to 8 % too long.
#pragma once

#include <cstdint>
#include <limits>
#include <optional>
#include <vector>

#include "free_space.hpp"

namespace masked_mapper {

class FloorPaths {
 public:
  /// Searches from `start`, which is passable, until all of `targets` are reached that can
  /// be; of none, until all is reached that can be.
  FloorPaths(const FreeSpace& space, const GridCell& start, const std::vector<GridCell>& targets);

  bool Reaches(const GridCell& cell) const { return is_reached_[space_.IndexOf(cell)] != 0; }
  /// The cells where the way turns, its ends included; nothing when there is none.
  std::optional<std::vector<GridCell>> WayTo(const GridCell& target) const;
  /// The reached cell nearest to a point in world; every reachable one was reached only when some
  /// target could not be.
  GridCell NearestReached(const Eigen::Vector2d& point) const;

 private:
  struct Entry {
    float length = 0.0F;
    std::uint32_t cell = 0;
    bool operator>(const Entry& other) const {
      return length != other.length ? length > other.length : cell > other.cell;
    }
  };

  void Settle(const GridCell& cell);
  template <typename Visit>
  void ForEachStep(const GridCell& cell, const Visit& visit) const;
  float Distance(const GridCell& a, const GridCell& b) const;
  void PullTaut(std::vector<GridCell>& way) const;

  const FreeSpace& space_;
  GridCell start_;
  std::vector<float> length_;          ///< from the start, in cells
  std::vector<std::uint32_t> parent_;  ///< the cell where the way to this one turns last
  std::vector<std::uint8_t> is_reached_;
};

/// Metres along the way.
double LengthOf(const std::vector<Eigen::Vector2d>& way);

}  // namespace masked_mapper
